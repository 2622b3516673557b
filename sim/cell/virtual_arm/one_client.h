#pragma once
// When a cell that was asked to serve one client has done so: the client came, it went, and the arm
// has rested for a second since. Time is an argument; one thread.

#include <algorithm>
#include <cstdint>

namespace tenon::sim {

class OneClient {
 public:
  /// Once a wake-up of the cell, at least every few milliseconds. Where that stalls, only what the
  /// cell has lived through counts: its drives have had no time to miss their master.
  [[nodiscard]] bool finished(bool connected, bool standstill, std::int64_t now_ns) {
    constexpr std::int64_t kSettled_ns = 1'000'000'000;
    constexpr std::int64_t kWake_ns = 5'000'000;
    seen_ = seen_ || connected;
    const std::int64_t passed_ns = std::clamp<std::int64_t>(now_ns - last_ns_, 0, kWake_ns);
    last_ns_ = now_ns;
    rested_ns_ = connected || !standstill || !seen_ ? 0 : rested_ns_ + passed_ns;
    return rested_ns_ > kSettled_ns;
  }

 private:
  bool seen_ = false;
  std::int64_t last_ns_ = 0;
  std::int64_t rested_ns_ = 0;
};

}  // namespace tenon::sim

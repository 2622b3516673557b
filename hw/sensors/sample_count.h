#pragma once
// Numbers the samples of a sensor that does not do so itself, so that a half is never joined with
// another sample's: a second half has the number of the first that came right before it, if that
// was not long ago, and else a number that nothing else has. Real-time, no clock; one thread.

#include <cstdint>

namespace tenon::hw {

class SampleCount {
 public:
  /// @param apart_max_ns the second half comes that soon after the first, or is another sample's
  explicit SampleCount(std::int64_t apart_max_ns) : apart_max_ns_(apart_max_ns) {}

  /// What has come of a sample so far is all.
  void close() noexcept { open_ = false; }
  /// A first half has come.
  [[nodiscard]] std::uint16_t first(std::int64_t time_ns) noexcept {
    open_ = true;
    first_ns_ = time_ns;
    return ++counter_;
  }
  /// A second half has come.
  [[nodiscard]] std::uint16_t second(std::int64_t time_ns) noexcept {
    const bool joins = open_ && time_ns - first_ns_ <= apart_max_ns_;
    open_ = false;
    if (!joins) ++counter_;
    return counter_;
  }

 private:
  std::int64_t apart_max_ns_;
  std::int64_t first_ns_ = 0;
  std::uint16_t counter_ = 0;
  bool open_ = false;  ///< a first half waits
};

}  // namespace tenon::hw

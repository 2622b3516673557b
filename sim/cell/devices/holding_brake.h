#pragma once
// A holding brake behind its output: it opens and closes some time after the output says so. A
// drive knows that time by its settings alone, and waits for no other.

#include <cstdint>

namespace tenon::sim {

class HoldingBrake {
 public:
  HoldingBrake(std::int64_t release_ns, std::int64_t engage_ns)
      : release_ns_(release_ns), engage_ns_(engage_ns) {}

  void set(bool engaged) {
    if (engaged == engaged_) return;
    engaged_ = engaged;
    since_ns_ = 0;
  }
  /// @param late_ns to hold, beyond what the drive knows
  void advance(std::int64_t step_ns, std::int64_t late_ns = 0) {
    since_ns_ += step_ns;
    if (since_ns_ >= (engaged_ ? engage_ns_ + late_ns : release_ns_)) holds_ = engaged_;
  }

  [[nodiscard]] bool engaged() const { return engaged_; }  ///< the output
  [[nodiscard]] bool holds() const { return holds_; }      ///< the axis
  /// The time that the drive knows of has passed since the output closed.
  [[nodiscard]] bool should_hold() const { return engaged_ && since_ns_ >= engage_ns_; }
  [[nodiscard]] std::int64_t engage_ns() const { return engage_ns_; }

 private:
  std::int64_t release_ns_;
  std::int64_t engage_ns_;
  std::int64_t since_ns_ = 0;
  bool engaged_ = true;
  bool holds_ = true;
};

}  // namespace tenon::sim

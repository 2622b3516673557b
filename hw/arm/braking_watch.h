#pragma once
// Whether an axis comes to rest as its drive was told. The drive ramps down by itself, and is
// looked at meanwhile: an axis that gets faster than it was, or that still moves when its ramp must
// be over, is not braked by its drive, and only its brake can stop it. Real-time, no clock; one
// thread; owns its memory.

#include <cstdint>
#include <optional>

#include "shared/cell/robot.h"

namespace tenon::hw {

class BrakingWatch {
 public:
  /// In a row: one position that jumps is no motion.
  static constexpr int kCyclesMost = 2;
  /// In the axis's full speed: what it may gain until its drive brakes, and what is left of it once
  /// its ramp is over.
  static constexpr double kGain = 0.25;
  static constexpr double kAtRest = 0.05;
  /// Until the drive has heard of it, and of its lag.
  static constexpr double kMargin_s = 0.1;
  /// For a ramp where how hard a drive brakes cannot be set (6085h).
  static constexpr double kUnknownRamp_s = 1.0;

  BrakingWatch() = default;
  /// @param cycle_us from one update() to the next
  BrakingWatch(const Joint& joint, std::uint32_t cycle_us);

  /// It need not stop, or its motor has no power.
  void restart();
  /// Once a cycle in which it is to stop, its motor under power.
  /// @param position_counts of its last answer  @param answered in this cycle
  void update(std::int32_t position_counts, bool answered);
  /// It does not brake; until restart().
  [[nodiscard]] bool runs_on() const { return fast_cycles_ > kCyclesMost; }

 private:
  double full_speed_ = 0.0;  ///< counts a cycle
  int ramp_cycles_ = 0;

  int cycles_ = 0;               ///< since it is to stop
  int fast_cycles_ = 0;          ///< in a row
  std::optional<double> first_;  ///< speed, counts a cycle
  std::optional<std::int32_t> before_counts_;
};

}  // namespace tenon::hw

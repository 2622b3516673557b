#pragma once
// What a drive demands of its servo, and its brake: targets interpolated from one SYNC to the next,
// ramps down, standing under power, and the way into and out of the brake.
//
//   Off ── power_on ──> Releasing ── brake open ──> Following <── resume ── Holding
//    ^                                               │   ramp_down           ^
//    └── brake closed ── Engaging <── standstill ── Ramping ── standstill ───┘
//   power_off: Off from anywhere, at once
//
// Counts. One thread; the caller passes time by demand() and advance().

#include <cstdint>

#include "sim/cell/devices/holding_brake.h"

namespace tenon::sim {

class DriveMotion {
 public:
  enum class Phase : std::uint8_t {
    kOff,
    kReleasing,
    kFollowing,
    kRamping,
    kHolding,
    kEngaging,
  };

  DriveMotion(std::int64_t brake_release_ns, std::int64_t brake_engage_ns)
      : brake_(brake_release_ns, brake_engage_ns) {}

  /// Holds the axis where it is and opens the brake.
  void power_on(double at_counts);
  void power_off();
  /// Follows targets from the demand as it stands.
  void resume();
  /// Where the axis goes within the next period; ignored unless following.
  void set_target(double counts, std::int64_t period_ns);
  /// @param brake close the brake at standstill, and then switch the power off
  void ramp_down(double deceleration_countsps2, bool brake);
  /// Before a ramp: it starts from where the axis is and not from the demand.
  void start_from(double position_counts, double velocity_countsps);

  /// Moves the demand on by `step_ns`.
  void demand(std::int64_t step_ns);
  /// After the plant's step. @return what power_on or ramp_down began is done
  /// @param brake_s how long the brake really takes to hold; less than the drive knows: as it knows
  [[nodiscard]] bool advance(std::int64_t step_ns, double brake_s = 0.0);

  [[nodiscard]] Phase phase() const { return phase_; }
  /// The axis is under power and not in the brake.
  [[nodiscard]] bool moving_freely() const;
  [[nodiscard]] bool powered() const { return phase_ != Phase::kOff; }
  [[nodiscard]] const HoldingBrake& brake() const { return brake_; }
  [[nodiscard]] double position_counts() const { return position_counts_; }
  [[nodiscard]] double velocity_countsps() const { return velocity_countsps_; }
  /// The target's period is over.
  [[nodiscard]] bool target_reached() const { return segment_elapsed_ns_ >= segment_period_ns_; }

 private:
  void follow(std::int64_t step_ns);

  HoldingBrake brake_;
  Phase phase_ = Phase::kOff;
  double position_counts_ = 0.0;
  double velocity_countsps_ = 0.0;
  double deceleration_countsps2_ = 0.0;
  bool brake_at_standstill_ = false;
  // The demand runs along a segment from one target to the next, one period long.
  double segment_start_counts_ = 0.0;
  double segment_end_counts_ = 0.0;
  std::int64_t segment_elapsed_ns_ = 0;
  std::int64_t segment_period_ns_ = 0;
};

}  // namespace tenon::sim

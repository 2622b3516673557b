#include "sim/cell/devices/drive_motion.h"

#include <algorithm>
#include <cmath>

#include "shared/base/time_units.h"

namespace tenon::sim {
namespace {

/// A late or lost SYNC finds the axis still moving on; this many periods after the last one it
/// stops.
constexpr std::int64_t kExtrapolationPeriods = 2;

}  // namespace

void DriveMotion::power_on(double at_counts) {
  if (phase_ != Phase::kOff) return;
  start_from(at_counts, 0.0);
  brake_.set(false);
  phase_ = Phase::kReleasing;
}

void DriveMotion::power_off() {
  brake_.set(true);
  velocity_countsps_ = 0.0;
  phase_ = Phase::kOff;
}

void DriveMotion::resume() {
  brake_.set(false);
  velocity_countsps_ = 0.0;
  segment_start_counts_ = segment_end_counts_ = position_counts_;
  segment_period_ns_ = segment_elapsed_ns_ = 0;
  phase_ = Phase::kFollowing;
}

void DriveMotion::set_target(double counts, std::int64_t period_ns) {
  if (phase_ != Phase::kFollowing) return;
  segment_start_counts_ = position_counts_;
  segment_end_counts_ = counts;
  segment_elapsed_ns_ = 0;
  segment_period_ns_ = period_ns;
}

void DriveMotion::ramp_down(double deceleration_countsps2, bool brake) {
  if (!moving_freely()) return;
  deceleration_countsps2_ = deceleration_countsps2;
  brake_at_standstill_ = brake;
  phase_ = Phase::kRamping;
}

void DriveMotion::start_from(double position_counts, double velocity_countsps) {
  position_counts_ = position_counts;
  velocity_countsps_ = velocity_countsps;
}

bool DriveMotion::moving_freely() const {
  return phase_ == Phase::kFollowing || phase_ == Phase::kRamping || phase_ == Phase::kHolding;
}

void DriveMotion::demand(std::int64_t step_ns) {
  const double step_s = static_cast<double>(step_ns) / kNanosecondsPerSecond;
  switch (phase_) {
    case Phase::kOff:
      return;
    case Phase::kReleasing:
    case Phase::kHolding:
    case Phase::kEngaging:
      velocity_countsps_ = 0.0;
      return;
    case Phase::kRamping: {
      const double speed = std::abs(velocity_countsps_) - deceleration_countsps2_ * step_s;
      velocity_countsps_ = speed > 0.0 ? std::copysign(speed, velocity_countsps_) : 0.0;
      position_counts_ += velocity_countsps_ * step_s;
      return;
    }
    case Phase::kFollowing:
      return follow(step_ns);
  }
}

void DriveMotion::follow(std::int64_t step_ns) {
  const double before_counts = position_counts_;
  segment_elapsed_ns_ =
      std::min(segment_elapsed_ns_ + step_ns, kExtrapolationPeriods * segment_period_ns_);
  if (segment_period_ns_ > 0) {
    const double part =
        static_cast<double>(segment_elapsed_ns_) / static_cast<double>(segment_period_ns_);
    position_counts_ = segment_start_counts_ + part * (segment_end_counts_ - segment_start_counts_);
  }
  velocity_countsps_ =
      (position_counts_ - before_counts) * kNanosecondsPerSecond / static_cast<double>(step_ns);
}

bool DriveMotion::advance(std::int64_t step_ns, double brake_s) {
  const auto brake_ns = static_cast<std::int64_t>(brake_s * kNanosecondsPerSecond);
  brake_.advance(step_ns, std::max<std::int64_t>(0, brake_ns - brake_.engage_ns()));
  switch (phase_) {
    case Phase::kOff:
    case Phase::kFollowing:
    case Phase::kHolding:
      return false;
    case Phase::kReleasing:
      if (brake_.holds()) return false;
      resume();
      return true;
    case Phase::kRamping:
      if (velocity_countsps_ != 0.0) return false;
      phase_ = brake_at_standstill_ ? Phase::kEngaging : Phase::kHolding;
      if (brake_at_standstill_) brake_.set(true);
      return !brake_at_standstill_;
    case Phase::kEngaging:
      if (!brake_.should_hold()) return false;
      power_off();
      return true;
  }
  return false;
}

}  // namespace tenon::sim

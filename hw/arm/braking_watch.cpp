#include "hw/arm/braking_watch.h"

#include <algorithm>
#include <cmath>

#include "shared/canopen/robot_drives.h"

namespace tenon::hw {
namespace {

bool brakes_as_hard_as_told(const Joint& joint) {
  const auto& how = canopen_drive(joint).profile.object(DriveObject::kQuickStopDeceleration);
  return how.presence == Presence::kRequired &&
         (how.treatment == Treatment::kWrite || how.treatment == Treatment::kCheck);
}

double ramp_s(const Joint& joint) {
  const double told_s = joint.speed_max / joint.acceleration_max + BrakingWatch::kMargin_s;
  return brakes_as_hard_as_told(joint) ? told_s : std::max(told_s, BrakingWatch::kUnknownRamp_s);
}

}  // namespace

BrakingWatch::BrakingWatch(const Joint& joint, std::uint32_t cycle_us)
    : full_speed_(1e-6 * cycle_us * joint.speed_max * std::abs(joint.counts_per_unit)),
      ramp_cycles_(static_cast<int>(std::ceil(1e6 * ramp_s(joint) / cycle_us))) {}

void BrakingWatch::restart() {
  cycles_ = fast_cycles_ = 0;
  first_.reset();
  before_counts_.reset();
}

void BrakingWatch::update(std::int32_t position_counts, bool answered) {
  ++cycles_;
  if (runs_on()) return;
  if (!answered) return before_counts_.reset();
  if (before_counts_) {
    const double way = std::abs(static_cast<double>(position_counts) - *before_counts_);
    if (!first_) first_ = std::min(way, full_speed_);
    const double most =
        cycles_ <= ramp_cycles_ ? *first_ + kGain * full_speed_ : kAtRest * full_speed_;
    fast_cycles_ = way > most ? fast_cycles_ + 1 : 0;
  }
  before_counts_ = position_counts;
}

}  // namespace tenon::hw

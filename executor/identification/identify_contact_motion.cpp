#include "executor/identification/identify_contact_motion.h"

#include <algorithm>
#include <cmath>

namespace tenon::executor {
namespace {

constexpr double kRetreat_mps = 0.01;
// Longest half wave that is waited for, in planned half waves: forces that drift.
constexpr double kPatience = 8.0;

}  // namespace

IdentifyContactMotion::IdentifyContactMotion(const Cell& cell, const Parameters& parameters)
    : IdentificationMotion(cell), parameters_(parameters) {
  const double longest_s = kPatience * parameters.half_wave_s * parameters.half_waves;
  samples_.reserve(static_cast<std::size_t>(longest_s / cycle_s()) + 1);
}

void IdentifyContactMotion::begin() { first_ = kinematics().tool(joints().position()); }

double IdentifyContactMotion::force_N() const {
  return -parameters_.sign * supervision().wrench()[parameters_.axis];
}

std::optional<Ending> IdentifyContactMotion::advance(double speed_mps) {
  depth_m_ += speed_mps * cycle_s();
  Vector6 way = Vector6::Zero();
  way[parameters_.axis] = parameters_.sign * depth_m_;
  return joints().follow(displaced(first_, way));
}

ControlTask::Turn IdentifyContactMotion::run(const ArmFeedback& /*feedback*/) {
  switch (phase_) {
    case Phase::kApproaching:
      return approach_contact();
    case Phase::kPressing:
      return press();
    case Phase::kWaving:
      return wave();
    case Phase::kRetreating:
      return retreat();
  }
  return {};
}

ControlTask::Turn IdentifyContactMotion::approach_contact() {
  if (const auto refused = advance(parameters_.approach_mps)) return *refused;
  if (supervision().wrench_usable() && force_N() > parameters_.force_low_N) {
    met_ = true;
    phase_ = Phase::kPressing;
  } else if (depth_m_ > parameters_.reach_m) {
    start_retreat();
  }
  return {};
}

// Out until the force is low, then in until it is high: the way between the two is the first guess.
ControlTask::Turn IdentifyContactMotion::press() {
  if (low_m_ < 0.0) {
    if (const auto refused = advance(-parameters_.press_mps)) return *refused;
    if (force_N() < parameters_.force_low_N) low_m_ = depth_m_;
    return {};
  }
  if (const auto refused = advance(parameters_.press_mps)) return *refused;
  if (force_N() < parameters_.force_high_N) return {};
  wave_mps_ = std::max(depth_m_ - low_m_, 0.0) / parameters_.half_wave_s;
  direction_ = -1.0;
  phase_ = Phase::kWaving;
  return {};
}

ControlTask::Turn IdentifyContactMotion::wave() {
  const bool turn =
      direction_ > 0.0 ? force_N() > parameters_.force_high_N : force_N() < parameters_.force_low_N;
  if (turn) {
    direction_ = -direction_;
    ++half_waves_;
  }
  if (half_waves_ >= parameters_.half_waves || samples_.size() == samples_.capacity()) {
    start_retreat();
    return {};
  }
  if (const auto refused = advance(direction_ * wave_mps_)) return *refused;
  samples_.push_back({depth_m_, force_N(), supervision().wrench_usable()});
  return {};
}

void IdentifyContactMotion::start_retreat() {
  MotionProfile::Parameters p;
  p.length = std::max(0.0, depth_m_);
  p.fast_speed = p.slow_speed = kRetreat_mps;
  p.acceleration = 0.1;
  p.jerk = 2.0;
  back_ = MotionProfile(p);
  retreat_from_m_ = depth_m_;
  retreat_s_ = 0.0;
  phase_ = Phase::kRetreating;
}

ControlTask::Turn IdentifyContactMotion::retreat() {
  retreat_s_ += cycle_s();
  depth_m_ = retreat_from_m_ - back_.at(retreat_s_).position;
  if (const auto refused = advance(0.0)) return *refused;
  if (retreat_s_ < back_.duration_s()) return {};
  if (met_) return Ending{.reason = EndReason::kMeasured};
  return Ending{.reason = EndReason::kNothingMet,
                .index = parameters_.axis,
                .value = parameters_.sign * parameters_.reach_m};
}

}  // namespace tenon::executor

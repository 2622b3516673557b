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
    : IdentificationMotion(cell),
      parameters_(parameters),
      sensor_tare_(SensorTare::parameters_for(cell.robot.sensor, parameters.tare_samples)) {
  const double longest_s = kPatience * parameters.half_wave_s * parameters.half_waves;
  samples_.reserve(static_cast<std::size_t>(longest_s / cycle_s()) + 1);
}

void IdentifyContactMotion::begin() { first_ = kinematics().tool(commanded()); }

double IdentifyContactMotion::force_N() const {
  return -parameters_.sign * supervision().wrench()[parameters_.axis];
}

void IdentifyContactMotion::advance(double speed_mps) {
  depth_m_ += speed_mps * cycle_s();
  Vector6 way = Vector6::Zero();
  way[parameters_.axis] = parameters_.sign * depth_m_;
  follow(displaced(first_, way));
}

bool IdentifyContactMotion::act(const ArmFeedback& feedback) {
  switch (phase_) {
    case Phase::kTaring:
      tare(feedback);
      return false;
    case Phase::kApproaching:
      advance(parameters_.approach_mps);
      if (supervision().wrench_usable() && force_N() > parameters_.force_low_N) {
        met_ = true;
        phase_ = Phase::kPressing;
      } else if (depth_m_ > parameters_.reach_m) {
        start_retreat();
      }
      return false;
    case Phase::kPressing:
      press();
      return false;
    case Phase::kWaving:
      wave();
      return false;
    case Phase::kRetreating:
      retreat_s_ += cycle_s();
      depth_m_ = retreat_from_m_ - retreat_.at(retreat_s_).position;
      advance(0.0);
      return retreat_s_ >= retreat_.duration_s();
  }
  return true;
}

void IdentifyContactMotion::tare(const ArmFeedback& feedback) {
  if (!feedback.wrench_fresh) return;
  switch (sensor_tare_.add(feedback.wrench)) {
    case SensorTare::Status::kGathering:
      return;
    case SensorTare::Status::kDone:
      supervision().tare(sensor_tare_.mean());
      phase_ = Phase::kApproaching;
      return;
    case SensorTare::Status::kUnsteady: {
      const int axis = sensor_tare_.worst_axis();
      return end({.reason = EndReason::kTareUnsteady,
                  .index = axis,
                  .value = sensor_tare_.deviation(axis),
                  .bound = sensor_tare_.deviation_max(axis)});
    }
  }
}

// Out until the force is low, then in until it is high: the way between the two is the first guess.
void IdentifyContactMotion::press() {
  if (low_m_ < 0.0) {
    advance(-parameters_.press_mps);
    if (force_N() < parameters_.force_low_N) low_m_ = depth_m_;
    return;
  }
  advance(parameters_.press_mps);
  if (force_N() < parameters_.force_high_N) return;
  wave_mps_ = std::max(depth_m_ - low_m_, 0.0) / parameters_.half_wave_s;
  direction_ = -1.0;
  phase_ = Phase::kWaving;
}

void IdentifyContactMotion::wave() {
  const bool turn =
      direction_ > 0.0 ? force_N() > parameters_.force_high_N : force_N() < parameters_.force_low_N;
  if (turn) {
    direction_ = -direction_;
    ++half_waves_;
  }
  if (half_waves_ >= parameters_.half_waves || samples_.size() == samples_.capacity()) {
    return start_retreat();
  }
  advance(direction_ * wave_mps_);
  samples_.push_back({depth_m_, force_N(), supervision().wrench_usable()});
}

void IdentifyContactMotion::start_retreat() {
  MotionProfile::Parameters p;
  p.length = std::max(0.0, depth_m_);
  p.fast_speed = p.slow_speed = kRetreat_mps;
  p.acceleration = 0.1;
  p.jerk = 2.0;
  retreat_ = MotionProfile(p);
  retreat_from_m_ = depth_m_;
  retreat_s_ = 0.0;
  phase_ = Phase::kRetreating;
}

}  // namespace tenon::executor

#pragma once
// The compliance law in front of position-controlled drives:
//   M (x'' - xs'') + D (x' - xs') + K (x - xs) = f
// on the compliant axes; the others follow the setpoint rigidly. Backward Euler at velocity level,
// so it is stable for every M >= 0, D >= 0, K >= 0 and cycle. It knows nothing of joints or
// contacts. Real-time, one thread, no allocation.

#include "shared/math/pose.h"
#include "shared/motion/guarded_move.h"
#include "shared/motion/move_parameters.h"

namespace tenon::executor {

class Admittance {
 public:
  /// What is commanded: the tool in the task frame, and its velocity there (m/s, rad/s).
  struct State {
    Pose pose;
    Vector6 velocity = Vector6::Zero();
  };

  /// @param cycle_s > 0
  Admittance(const Compliance& compliance, double cycle_s)
      : compliance_(compliance), cycle_s_(cycle_s) {}

  /// At rest at a pose.
  void reset(const Pose& pose) { state_ = {pose, Vector6::Zero()}; }

  /// One cycle. @param wrench external, task axes at the tool tip, N and Nm
  const State& update(const GuardedMove::Setpoint& setpoint, const Vector6& wrench) {
    const Vector6 error = displacement_between(state_.pose, setpoint.pose);
    for (int axis = 0; axis < 6; ++axis) {
      state_.velocity[axis] = yields(axis)
                                  ? next_velocity(axis, error[axis], setpoint, wrench[axis])
                                  : error[axis] / cycle_s_;
    }
    state_.pose = displaced(state_.pose, state_.velocity * cycle_s_);
    return state_;
  }

  [[nodiscard]] const State& state() const { return state_; }
  [[nodiscard]] bool yields(int axis) const {
    return (compliance_.compliant_axes >> axis & 1U) != 0;
  }

 private:
  // The law with x'' = (v+ - v) / T and x = x + T v+, solved for v+.
  [[nodiscard]] double next_velocity(int axis, double error, const GuardedMove::Setpoint& setpoint,
                                     double push) const {
    const bool turn = axis >= 3;
    const double mass = turn ? compliance_.inertia_kgm2 : compliance_.mass_kg;
    const double damping = turn ? compliance_.damping_Nmspr : compliance_.damping_Nspm;
    const double stiffness = turn ? compliance_.stiffness_Nmpr : compliance_.stiffness_Npm;
    const double drive = mass * (state_.velocity[axis] / cycle_s_ + setpoint.acceleration[axis]) +
                         damping * setpoint.velocity[axis] + stiffness * error + push;
    return drive / (mass / cycle_s_ + damping + stiffness * cycle_s_);
  }

  Compliance compliance_;
  double cycle_s_;
  State state_;
};

}  // namespace tenon::executor

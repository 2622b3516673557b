#pragma once
// The admittance law:
//   M (x'' - xs'') + D (x' - xs') + K (x - xs) = f
// on the compliant axes; the others follow the setpoint rigidly. Backward Euler at velocity level,
// so it is stable for every M >= 0, D >= 0, K >= 0 and step. It knows nothing of joints or
// contacts. The executor has it in front of position-controlled drives; a guarded move knows by it
// where a tool runs on to that nothing touches. Real-time, one thread, no allocation.

#include "shared/math/pose.h"
#include "shared/motion/move_parameters.h"
#include "shared/motion/setpoint.h"

namespace tenon {

class Admittance {
 public:
  /// What is commanded: the tool in the task frame, and its velocity there (m/s, rad/s).
  struct State {
    Pose pose;
    Vector6 velocity = Vector6::Zero();
  };

  explicit Admittance(const Compliance& compliance) : compliance_(compliance) {}

  void reset(const State& state) { state_ = state; }

  /// One step. @param wrench external, task axes at the tool tip, N and Nm  @param step_s > 0
  const State& update(const Setpoint& setpoint, const Vector6& wrench, double step_s) {
    state_.velocity = next_velocity(setpoint, wrench, step_s);
    state_.pose = displaced(state_.pose, state_.velocity * step_s);
    return state_;
  }

  [[nodiscard]] const State& state() const { return state_; }
  /// That update() would leave it with.
  [[nodiscard]] Vector6 next_velocity(const Setpoint& setpoint, const Vector6& wrench,
                                      double step_s) const {
    const Vector6 error = displacement_between(state_.pose, setpoint.pose);
    Vector6 velocity = error / step_s;
    for (int axis = 0; axis < 6; ++axis) {
      if (!yields(axis)) continue;
      velocity[axis] = next_velocity(axis, error[axis], setpoint, wrench[axis], step_s);
    }
    return velocity;
  }
  /// Where the tool comes to rest by its damping alone: M / D times its velocity from here.
  [[nodiscard]] Pose run_out() const {
    Vector6 way = Vector6::Zero();
    for (int axis = 0; axis < 6; ++axis) {
      if (yields(axis)) way[axis] = mass(axis) / damping(axis) * state_.velocity[axis];
    }
    return displaced(state_.pose, way);
  }
  [[nodiscard]] bool yields(int axis) const {
    return (compliance_.compliant_axes >> axis & 1U) != 0;
  }

 private:
  // The law with x'' = (v+ - v) / T and x = x + T v+, solved for v+.
  [[nodiscard]] double next_velocity(int axis, double error, const Setpoint& setpoint, double push,
                                     double step_s) const {
    const double drive =
        mass(axis) * (state_.velocity[axis] / step_s + setpoint.acceleration[axis]) +
        damping(axis) * setpoint.velocity[axis] + stiffness(axis) * error + push;
    return drive / (mass(axis) / step_s + damping(axis) + stiffness(axis) * step_s);
  }

  [[nodiscard]] double mass(int axis) const {
    return axis < 3 ? compliance_.mass_kg : compliance_.inertia_kgm2;
  }
  [[nodiscard]] double damping(int axis) const {
    return axis < 3 ? compliance_.damping_Nspm : compliance_.damping_Nmspr;
  }
  [[nodiscard]] double stiffness(int axis) const {
    return axis < 3 ? compliance_.stiffness_Npm : compliance_.stiffness_Nmpr;
  }

  Compliance compliance_;
  State state_;
};

}  // namespace tenon

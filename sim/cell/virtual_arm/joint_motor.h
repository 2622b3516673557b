#pragma once
// What servo or brake does at a joint in one step. Private to sim.

namespace tenon::sim {

/// A pull of impedance (velocity - actual), the actual one being that at the end of the step.
struct JointMotor {
  double velocity = 0.0;
  double impedance = 0.0;   ///< N s/m or Nm s/rad; 0: none
  double effort_max = 0.0;  ///< N or Nm

  [[nodiscard]] double effort_at(double actual) const { return impedance * (velocity - actual); }
};

}  // namespace tenon::sim

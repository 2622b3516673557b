#include "executor/dry_run/movable_axes.h"

#include <Eigen/QR>

#include "shared/base/text.h"

namespace tenon::executor {
namespace {

// A tool motion that the joints reproduce this well is one that they can make.
constexpr double kAxisError = 1e-6;

// Axes of the task frame along which the tool can move by itself.
std::uint8_t movable_axes(const ToolKinematics& kinematics, const JointVector& joints) {
  const SerialChain::Jacobian J = kinematics.jacobian(joints);
  const Eigen::CompleteOrthogonalDecomposition<SerialChain::Jacobian> solver(J);
  std::uint8_t axes = 0;
  for (int axis = 0; axis < 6; ++axis) {
    const Vector6 unit = Vector6::Unit(axis);
    const Vector6 made = J * solver.solve(unit);
    if ((made - unit).norm() < kAxisError) axes |= static_cast<std::uint8_t>(1U << axis);
  }
  return axes;
}

}  // namespace

std::vector<std::string> check_axes(const Plan& plan, const ToolKinematics& kinematics,
                                    const JointVector& joints) {
  const std::uint8_t movable = movable_axes(kinematics, joints);
  std::vector<std::string> refusals;
  const auto check = [&](const char* what, std::uint8_t axes) {
    if ((axes & ~movable) == 0) return;
    refusals.push_back(format("%s axes %s: the robot can move the tool along %s only", what,
                              axis_list(axes).c_str(), axis_list(movable).c_str()));
  };
  check("compliant", plan.compliance.compliant_axes);
  check("moved", plan.coordinates);
  return refusals;
}

}  // namespace tenon::executor

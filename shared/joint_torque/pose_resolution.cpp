#include "shared/joint_torque/pose_resolution.h"

#include "shared/base/random.h"
#include "shared/joint_torque/torque_map.h"
#include "shared/kinematics/serial_chain.h"

namespace tenon {
namespace {

constexpr int kSeeds = 200;
constexpr double kTolerance = 1e-6;

JointVector drawn(const Robot& robot, Random& source) {
  JointVector joints{};
  for (std::size_t i = 0; i < robot.joints.size(); ++i) {
    const Joint& joint = robot.joints[i];
    joints[i] = source.uniform(joint.lower, joint.upper);
  }
  return joints;
}

}  // namespace

std::optional<Vector6> resolution_at(const Cell& cell, const Pose& tool) {
  const SerialChain chain(cell.robot);
  const TorqueMap map(cell);
  const Pose X_BF = compose(compose(cell.X_BT, tool), inverse(cell.X_FP));
  SerialChain::InverseParameters parameters;
  parameters.tolerance = kTolerance;
  Random source(1);
  for (int i = 0; i < kSeeds; ++i) {
    const JointVector seed = drawn(cell.robot, source);
    parameters.axes = chain.free_axes(seed);
    const SerialChain::Inverse found = chain.inverse(X_BF, seed, parameters);
    if (found.status != SerialChain::InverseStatus::kSolved) continue;
    return TorqueMap::resolution(map.at(found.position), effort_uncertainty(cell));
  }
  return std::nullopt;
}

}  // namespace tenon

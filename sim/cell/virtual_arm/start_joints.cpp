#include "sim/cell/virtual_arm/start_joints.h"

#include <Eigen/SVD>
#include <algorithm>
#include <sstream>

#include "shared/base/error.h"
#include "shared/kinematics/serial_chain.h"

namespace tenon::sim {
namespace {

constexpr int kIterationsMax = 100;
constexpr double kBetter = 1e-6;  // of the worth; less is rounding

/// Every joint a third of its range below or above its middle, and the middle itself.
JointVector seed_of(const Robot& robot, unsigned pattern) {
  JointVector seed{};
  for (std::size_t i = 0; i < robot.joints.size(); ++i) {
    const Joint& joint = robot.joints[i];
    const double third = (joint.upper - joint.lower) / 3.0;
    seed[i] = 0.5 * (joint.lower + joint.upper);
    if (pattern != 0) seed[i] += (pattern >> i & 1U) != 0 ? 0.5 * third : -0.5 * third;
  }
  return seed;
}

/// How far a configuration keeps from joint limits (1 in the middle of every joint, 0 at one end)
/// and from singularity (the smallest singular value of the Jacobian).
double worth(const Robot& robot, const SerialChain& chain, const JointVector& position) {
  double room = 1.0;
  for (std::size_t i = 0; i < robot.joints.size(); ++i) {
    const Joint& joint = robot.joints[i];
    const double nearest = std::min(position[i] - joint.lower, joint.upper - position[i]);
    room = std::min(room, 2.0 * nearest / (joint.upper - joint.lower));
  }
  const Eigen::MatrixXd columns =
      chain.jacobian(position).leftCols(static_cast<Eigen::Index>(robot.joints.size()));
  const Eigen::VectorXd values = Eigen::JacobiSVD<Eigen::MatrixXd>(columns).singularValues();
  return room * values[values.size() - 1];
}

[[noreturn]] void refuse(const Cell& cell, const SerialChain::Inverse& nearest) {
  std::ostringstream text;
  text << "cell " << cell.name << ": the arm cannot bring the tool to the start (";
  if (nearest.joint >= 0) {
    const Joint& joint = cell.robot.joints[static_cast<std::size_t>(nearest.joint)];
    text << "joint " << joint.name << " must stay in [" << joint.lower << ", " << joint.upper
         << "], ";
  }
  text << to_string(nearest.status) << ", " << nearest.error
       << " m or rad short); check task_in_base and tool_in_flange";
  throw InputError(text.str());
}

}  // namespace

JointVector start_joints(const Cell& cell, const Pose& X_TP) {
  const Robot& robot = cell.robot;
  const SerialChain chain(robot);
  SerialChain::InverseParameters parameters;
  parameters.iterations_max = kIterationsMax;
  const Pose X_BF = compose(compose(cell.X_BT, X_TP), inverse(cell.X_FP));

  SerialChain::Inverse best;
  double best_worth = -1.0;
  for (unsigned pattern = 0; pattern < 1U << robot.joints.size(); ++pattern) {
    const SerialChain::Inverse found = chain.inverse(X_BF, seed_of(robot, pattern), parameters);
    if (found.status == SerialChain::InverseStatus::kSolved) {
      const double its_worth = worth(robot, chain, found.position);
      if (its_worth <= best_worth + kBetter) continue;
      best_worth = its_worth;
      best = found;
    } else if (best_worth < 0.0 && (pattern == 0 || found.error < best.error)) {
      best = found;
    }
  }
  if (best_worth < 0.0) refuse(cell, best);
  return best.position;
}

}  // namespace tenon::sim

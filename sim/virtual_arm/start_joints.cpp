#include "sim/virtual_arm/start_joints.h"

#include <sstream>

#include "shared/base/error.h"
#include "shared/kinematics/serial_chain.h"

namespace tenon::sim {

JointVector start_joints(const Cell& cell, const Pose& X_TP) {
  const SerialChain chain(cell.robot);
  JointVector middle{};
  for (std::size_t i = 0; i < cell.robot.joints.size(); ++i) {
    middle[i] = 0.5 * (cell.robot.joints[i].lower + cell.robot.joints[i].upper);
  }
  const Pose X_BF = compose(compose(cell.X_BT, X_TP), inverse(cell.X_FP));
  const SerialChain::Inverse found = chain.inverse(X_BF, middle, {});
  if (found.status == SerialChain::InverseStatus::kSolved) return found.position;

  std::ostringstream text;
  text << "cell " << cell.name << ": the arm cannot bring the tool to the start (";
  if (found.joint >= 0) {
    const Joint& joint = cell.robot.joints[static_cast<std::size_t>(found.joint)];
    text << "joint " << joint.name << " must stay in [" << joint.lower << ", " << joint.upper
         << "], ";
  }
  text << to_string(found.status) << ", " << found.error
       << " m or rad short); check task_in_base and tool_in_flange";
  throw InputError(text.str());
}

}  // namespace tenon::sim

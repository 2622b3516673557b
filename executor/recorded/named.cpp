#include "executor/recorded/named.h"

#include <algorithm>
#include <cmath>

#include "executor/faults/fault_table.h"
#include "lcmtypes/tenon/run_setup_t.hpp"
#include "shared/base/error.h"
#include "shared/base/printable.h"

namespace tenon::executor {

void check_named(const std::string& file, const std::string& task, const std::string& start,
                 const Plan& plan) {
  if (task.empty()) {
    throw InputError(file + ": is of an identification, which no plan belongs to");
  }
  if (task == plan.task_name && start == plan.start_name) return;
  throw InputError(file + ": is of a plan of '" + task + "' from start '" + start +
                   "', the plan given is of '" + plan.task_name + "' from start '" +
                   plan.start_name + "'; give the plan that was executed");
}

bool is_pose(const Vector3& position_m, const Eigen::Quaterniond& orientation) {
  constexpr double kFarthest_m = 1e6;
  const double length = orientation.norm();
  return (position_m.array().abs() <= kFarthest_m).all() && std::isfinite(length) && length > 0.5;
}

bool is_fault(EndReason reason) {
  return reason != EndReason::kNone && reason != EndReason::kPlanDone &&
         reason != EndReason::kStopRequested && reason != EndReason::kMeasured;
}

std::string named(EndReason reason, int arm_fault) {
  const FaultRow* row = fault_row(reason, static_cast<ArmFaultKind>(arm_fault));
  std::string text = row == nullptr ? to_string(reason) : full_name(*row);
  std::replace(text.begin(), text.end(), '_', ' ');
  return text;
}

std::vector<RecordedJoint> joints_of(const tenon::run_setup_t& m) {
  std::vector<RecordedJoint> joints;
  std::size_t begin = 0;
  const int count = std::min<int>(m.joint_count, static_cast<int>(kMaxJoints));
  for (int i = 0; i < count; ++i) {
    const std::size_t end = std::min(m.joint_names.find('\n', begin), m.joint_names.size());
    const auto at = static_cast<std::size_t>(i);
    joints.push_back({printable(m.joint_names.substr(begin, end - begin)), m.joint_linear[at] != 0,
                      m.joint_lower[at], m.joint_upper[at]});
    begin = std::min(end + 1, m.joint_names.size());
  }
  return joints;
}

}  // namespace tenon::executor

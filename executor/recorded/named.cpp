#include "executor/recorded/named.h"

#include <algorithm>

#include "executor/faults/fault_table.h"
#include "shared/base/error.h"

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

}  // namespace tenon::executor

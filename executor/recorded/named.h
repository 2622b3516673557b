#pragma once
// What the readers of logs and of results have in common: of which plan a record is, and what its
// joints and its end are called. Pure; offline.

#include <string>
#include <vector>

#include "executor/faults/end_reason.h"
#include "shared/math/pose.h"
#include "shared/plan/plan.h"
#include "shared/run/recorded_run.h"

namespace tenon {
class run_setup_t;
}  // namespace tenon

namespace tenon::executor {

/// @param file that is read, for the message
/// @throws InputError unless task and start are the plan's
void check_named(const std::string& file, const std::string& task, const std::string& start,
                 const Plan& plan);

/// Whether a tool can have been there: numbers within a thousand kilometres, and an orientation
/// that has a length. Reckoning with such poses stays within what floats hold.
[[nodiscard]] bool is_pose(const Vector3& position_m, const Eigen::Quaterniond& orientation);

/// Whether a run that ends so went wrong: it was neither done nor stopped by the user.
[[nodiscard]] bool is_fault(EndReason reason);

/// "force fault", "arm fault: heartbeat lost". @param arm_fault a number of ArmFaultKind
[[nodiscard]] std::string named(EndReason reason, int arm_fault);

/// Names may be anything that fits a line.
[[nodiscard]] std::vector<RecordedJoint> joints_of(const tenon::run_setup_t& message);

}  // namespace tenon::executor

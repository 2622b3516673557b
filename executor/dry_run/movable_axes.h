#pragma once
// Whether an arm can move its tool along the axes that a plan moves along at all. Set-up code.

#include <string>
#include <vector>

#include "executor/motion/tool_kinematics.h"
#include "shared/plan/plan.h"

namespace tenon::executor {

/// A line for the compliant axes, one for the moved ones, where some of them are none along which
/// the tool can move by itself. @param joints where the arm holds the plan's start
[[nodiscard]] std::vector<std::string> check_axes(const Plan& plan,
                                                  const ToolKinematics& kinematics,
                                                  const JointVector& joints);

}  // namespace tenon::executor

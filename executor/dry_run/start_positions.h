#pragma once
// All the joint positions in which an arm can hold a plan's start: one of every branch. Set-up
// code; allocates.

#include <string>
#include <vector>

#include "executor/motion/tool_kinematics.h"
#include "shared/cell/cell.h"

namespace tenon::executor {

/// Joints keep at least this distance to their limits, m or rad.
inline constexpr double kJointMargin = 5e-3;

struct StartPositions {
  /// Inside the limits. The arm that stands highest above its base comes first, since what it works
  /// on lies below; among equals the one that is nearest to the middle of its joints' ranges.
  std::vector<JointVector> found;
  std::string refusal;  ///< why there is none
};

/// Tries the middle of the ranges and many other seeds, always the same.
[[nodiscard]] StartPositions start_positions(const Pose& start, const Cell& cell,
                                             const ToolKinematics& kinematics);

}  // namespace tenon::executor

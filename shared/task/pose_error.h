#pragma once
// How wrong the said pose of the environment is. The one function that planner, judges, evaluation
// and virtual arm go by. Pure; any thread.

#include "shared/math/pose.h"

namespace tenon {

/// Where the task frame really stands, X_TE in the task frame as it was said to be.
/// @param error of the environment, task axes: translation (m), then rotation vector (rad)
/// @param about_m the point that the rotation leaves where it is, task frame (Task::error_about_m)
[[nodiscard]] Pose environment_pose(const Vector6& error, const Vector3& about_m);

/// The tool as the environment sees it. Where the environment is not turned or moved at all, the
/// tool's pose to the last bit.
[[nodiscard]] Pose seen_from(const Pose& environment, const Pose& tool);
/// The tool's pose that seen_from() makes `seen` of.
[[nodiscard]] Pose seen_as(const Pose& environment, const Pose& seen);

}  // namespace tenon

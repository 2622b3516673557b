#pragma once
// Where the joints stand when the tool stands somewhere. Offline.

#include "shared/cell/cell.h"
#include "shared/math/pose.h"
#include "shared/ports/arm.h"

namespace tenon::sim {

/// The joints that bring the tool to a pose in the nominal task frame. Of several solutions the one
/// furthest from joint limits and singularity, so that the motion that follows has room; the same
/// one every time.
/// @throws InputError where the arm cannot, with the joint or the distance that is missing
[[nodiscard]] JointVector start_joints(const Cell& cell, const Pose& X_TP);

}  // namespace tenon::sim

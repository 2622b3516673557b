#pragma once
// What a cell's joints resolve of a wrench where the tool stands, before anything moves. Offline.

#include <optional>

#include "shared/cell/cell.h"
#include "shared/math/pose.h"

namespace tenon {

/// N and Nm, task axes at the tool tip; infinite where an axis is not resolved. Of the first way
/// found in which the arm holds the tool there. @param tool in the task frame
/// @return nothing where it is out of reach
[[nodiscard]] std::optional<Vector6> resolution_at(const Cell& cell, const Pose& tool);

}  // namespace tenon

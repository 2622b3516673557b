#pragma once
// Starts in which several errors are at their largest at once. Pure; any thread.

#include "planner/belief/belief.h"
#include "shared/task/task.h"

namespace tenon::planner {

/// Corners of the uncertain coordinates' bounds (of normal errors: as far out as the particles):
/// all of at most four coordinates; of more, sixteen in which every two coordinates meet in all
/// four ways. Friction is low and high in turns, and the sensor in turn wherever it may be. Nothing
/// touches; one particle where nothing is uncertain.
[[nodiscard]] Belief corner_belief(const Task& task, const Start& start);

}  // namespace tenon::planner

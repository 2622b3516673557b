#pragma once
// What the part touches, by the names that people know. Pure; allocates.

#include <set>
#include <string>
#include <vector>

#include "shared/task/task.h"

namespace tenon {

/// A section seen from above is cut this far over the tip.
inline constexpr double kAboveFloor_m = 1e-3;

/// What the part stands on rather than bumps into.
[[nodiscard]] bool is_floor(const Shape& shape, const Pose& goal);

/// Names of the environment's shapes, of a ring's or a mesh's pieces that of the whole. In a plane
/// the floor is left out: it is always there. @param pairs "HELD-ENVIRONMENT", as physics has them
[[nodiscard]] std::set<std::string> touched_pieces(const Task& task,
                                                   const std::vector<std::string>& pairs);

}  // namespace tenon

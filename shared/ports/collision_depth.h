#pragma once
// From which depth on shapes that stand in one another are in collision.

namespace tenon {

/// Less is contact: shapes that touch are drawn to about a micrometre, and a contact yields. What
/// Rollout::in_collision() goes by, and whoever takes a measure with it.
inline constexpr double kCollisionDepth_m = 1e-4;

}  // namespace tenon

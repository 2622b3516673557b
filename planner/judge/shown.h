#pragma once
// The units in which the planner's texts show displacements. Offline; any thread.

#include <numbers>

namespace tenon::planner {

/// Millimetres of m on axes 0..2, degrees of rad on the others: what people measure in.
[[nodiscard]] inline double shown(double value, int axis) {
  return axis < 3 ? 1e3 * value : 180.0 / std::numbers::pi * value;
}

}  // namespace tenon::planner

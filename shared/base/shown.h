#pragma once
// The units in which texts for people show lengths and angles. Pure; any thread.

#include <numbers>

namespace tenon {

[[nodiscard]] constexpr double degrees(double angle_rad) {
  return 180.0 / std::numbers::pi * angle_rad;
}

/// Millimetres of m on axes 0..2, degrees of rad on the others: what people measure in.
[[nodiscard]] constexpr double shown(double value, int axis) {
  return axis < 3 ? 1e3 * value : degrees(value);
}

}  // namespace tenon

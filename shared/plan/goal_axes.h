#pragma once
// How far off its goal a tool may end where axes differ: some have a tolerance of their own, along
// some any end will do (a round peg's yaw). Pure; any thread.

#include <string>

#include "shared/math/pose.h"
#include "shared/plan/axes.h"

namespace tenon {

/// The goal's axes that do not count in its one tolerance, in the task frame's axes, rotations as
/// rotation vectors.
struct GoalAxes {
  Vector6 tolerance = Vector6::Zero();  ///< m or rad; 0 where an axis has none of its own
  CoordinateMask free = 0;              ///< any end will do; none of these has a tolerance

  friend bool operator==(const GoalAxes&, const GoalAxes&) = default;

  [[nodiscard]] bool any() const { return free != 0 || !tolerance.isZero(0.0); }
  /// Counts in the goal's one tolerance.
  [[nodiscard]] bool together(int axis) const { return !has(free, axis) && tolerance[axis] == 0.0; }
};

/// What is left of a way off the goal once every axis of its own has been given what it may be off
/// by: 0 along free axes, all of it along those that count together.
[[nodiscard]] Vector6 beyond_own(const Vector6& off, const GoalAxes& axes);

/// How far off a goal, in tolerances: the most that an axis of its own is, or what the others are
/// together, |position| + orientation_weight |rotation|, whichever is more. Within where at most 1.
/// @param off m, rad
/// @param together_m the goal's one tolerance
/// @param orientation_weight m per rad
[[nodiscard]] double tolerances_off(const Vector6& off, double together_m, const GoalAxes& axes,
                                    double orientation_weight);

/// What the goal allows, for people: "2 mm", "2 mm together, z 5 mm, rz any".
[[nodiscard]] std::string tolerance_text(double together_m, const GoalAxes& axes);

}  // namespace tenon

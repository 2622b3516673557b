#pragma once
// Which directions have something to touch: what a plan can learn from. One thread at a time.

#include <optional>
#include <string>
#include <vector>

#include "planner/check/probe.h"
#include "shared/task/task.h"

namespace tenon::planner {

/// A push along an axis that ends at something, wherever in its start's spread the part may be.
struct Touch {
  int axis = 0;
  int sign = 1;               ///< of the push
  std::string shape;          ///< of the environment
  Pose tool;                  ///< where it touches
  double from_start_m = 0.0;  ///< that far from the start
  /// Whether legs along the coordinates, each of them once, lead there from the start. Else only a
  /// way around something does, or none.
  bool in_legs = false;
  std::string legs;  ///< their axes in order, "z, x"; of those alone that are any way
};

/// The touch nearest to a start in each direction along an uncertain translation, of those that
/// legs lead to where there are any: at most one for each axis and sign, none where nothing is in
/// reach. Looked for on lines along the axis through
/// the start, through the goal, and through the middle of each shape, as far as a move at contact
/// speed gets within its time limit. It counts where the corners of the start's spread across it
/// touch at places that lie within `attractor_ratio` of the spread along it; along axes that have
/// been touched before, there is no spread left.
[[nodiscard]] std::vector<Touch> touchable(const Task& task, const Start& start, Probe& probe);

/// How far a push along a translation of this task gets, m: what the task says, or what its speed
/// and time limit allow.
[[nodiscard]] double push_reach_m(const Task& task);

}  // namespace tenon::planner

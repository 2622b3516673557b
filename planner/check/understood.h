#pragma once
// What a check has understood, in the words that its text and its page share. Pure; any thread.

#include <cstddef>
#include <string>
#include <vector>

#include "planner/check/task_check.h"
#include "shared/task/task.h"

namespace tenon::planner {

/// What people call one shape: the pieces of a ring or a mesh are one part.
struct Part {
  std::string name;
  std::size_t pieces = 1;
  Vector3 size_m = Vector3::Zero();    ///< of each piece
  Vector3 middle_m = Vector3::Zero();  ///< of all pieces
};

/// In the order of the shapes.
[[nodiscard]] std::vector<Part> parts_of(const std::vector<Shape>& shapes);

/// "60 x 60 x 160" in mm, or "of 16 pieces, each 44 x 29.84 x 120".
[[nodiscard]] std::string size_text(const Part& part);

/// Room at the goal in mm, "9.96": it is measured to a hundredth, less is "below 0.01".
[[nodiscard]] std::string way_mm_text(double way_m);

/// "x +-90 mm, ry +-2 degrees": how far out the particles of a start are.
[[nodiscard]] std::string spread_text(const Start& start, const Task& task);

/// A direction that a start is uncertain along, and what there is to touch.
struct Direction {
  int axis = 0;
  int sign = 1;
  const Touch* touch = nullptr;  ///< of the check; none where nothing is in reach
};

/// How the tool gets to a touch that is not straight ahead: ", by way of legs along z, x" where it
/// lies behind the start, ", which no straight legs lead to" where only a way around does.
[[nodiscard]] std::string way_text(const Touch& touch, const Start& start);

/// Both ways along each uncertain translation. None where the start or a particle is not free.
[[nodiscard]] std::vector<Direction> directions_of(const Task& task, const Start& start,
                                                   const StartCheck& checked);

}  // namespace tenon::planner

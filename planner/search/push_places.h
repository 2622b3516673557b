#pragma once
// Where a push against a side of a shape may begin: geometry alone. Pure; any thread.

#include <Eigen/Geometry>
#include <vector>

#include "planner/belief/belief_summary.h"
#include "planner/search/touch_places.h"
#include "shared/task/task.h"

namespace tenon::planner {

/// What is pushed, and which way.
struct PartBefore {
  Eigen::AlignedBox3d part;    ///< around the held part, tool frame
  const BeliefSummary& start;  ///< whose spread the part keeps
  int axis = 0;                ///< 0..2
  int sign = 1;
  int over_rim = -1;  ///< along this axis one of its ends is over the side's rim, and no more of it
};

/// The tool's poses off a side from which all of the spread would meet it: with the part's middle
/// over the place, or one of its ends along each other coordinate, so far over it as the spread is.
/// Sorted by their way from the start.
[[nodiscard]] std::vector<Pose> places_before(const TouchPlace& side, const PartBefore& before,
                                              const Task& task);
/// With the middle over it.
[[nodiscard]] Pose middle_before(const TouchPlace& side, const PartBefore& before,
                                 const Task& task);

}  // namespace tenon::planner

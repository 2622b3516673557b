#include "planner/search/push_places.h"

#include <algorithm>
#include <array>

namespace tenon::planner {
namespace {

// How far off a face the nearest particle begins to push.
constexpr double kOffFace_m = 5e-3;

/// Along each axis: 0 for the part's middle, -1 or 1 for its lower or upper end.
using Ends = std::array<int, 3>;

Pose place_before(const TouchPlace& side, const PartBefore& before, const Task& task,
                  const Ends& ends) {
  Pose place = before.start.mean;
  for (int axis = 0; axis < 3; ++axis) {
    if (!has(task.coordinates, axis)) continue;
    const double half_m = 0.5 * before.part.sizes()[axis];
    const double to_end_m = std::max(0.0, half_m - before.start.spread[axis] - kOffFace_m);
    const int end = ends[static_cast<std::size_t>(axis)];
    double at_m = side.at_m[axis];
    if (axis == before.over_rim) at_m = end < 0 ? side.side_m.max()[axis] : side.side_m.min()[axis];
    place.position_m[axis] = at_m - before.part.center()[axis] - end * to_end_m;
  }
  const double off_m =
      0.5 * before.part.sizes()[before.axis] + before.start.spread[before.axis] + kOffFace_m;
  place.position_m[before.axis] -= before.sign * off_m;
  return place;
}

}  // namespace

std::vector<Pose> places_before(const TouchPlace& side, const PartBefore& before,
                                const Task& task) {
  std::array<std::vector<int>, 3> ends;
  for (int axis = 0; axis < 3; ++axis) {
    auto& of_axis = ends[static_cast<std::size_t>(axis)];
    of_axis = {0};
    if (axis != before.axis && has(task.coordinates, axis)) of_axis = {0, -1, 1};
    if (axis == before.over_rim) of_axis = {-1, 1};
  }
  std::vector<Pose> places;
  for (const int x : ends[0]) {
    for (const int y : ends[1]) {
      for (const int z : ends[2]) places.push_back(place_before(side, before, task, {x, y, z}));
    }
  }
  const auto way_m = [&](const Pose& place) {
    return (place.position_m - before.start.mean.position_m).norm();
  };
  std::stable_sort(places.begin(), places.end(),
                   [&](const Pose& a, const Pose& b) { return way_m(a) < way_m(b); });
  return places;
}

Pose middle_before(const TouchPlace& side, const PartBefore& before, const Task& task) {
  return place_before(side, before, task, {0, 0, 0});
}

}  // namespace tenon::planner

#include "planner/search/tilt_offset.h"

#include <cmath>

namespace tenon::planner {
namespace {

// Of what may be left at the goal, which other errors want, too.
constexpr double kSmallShare = 0.25;

}  // namespace

double tilt_offset_m(const Task& task, int axis, const Pose& contact, const Pose& mouth) {
  if (axis >= 3) return 0.0;
  const Vector3 way_m = mouth.position_m - contact.position_m;
  double lever_m2 = 0.0;
  for (int across = 0; across < 3; ++across) {
    const int about = 6 - axis - across;
    if (across == axis || has(task.coordinates, about)) continue;
    lever_m2 += way_m[across] * way_m[across];
  }
  const double off_m = task.tilt_rad * std::sqrt(lever_m2);
  return off_m > kSmallShare * std::sqrt(task.goal_uncertainty_m2) ? off_m : 0.0;
}

}  // namespace tenon::planner

#include "sim/evaluation/corner.h"

#include <algorithm>

#include "shared/base/error.h"

namespace tenon::sim {

const std::vector<std::string>& corner_names() {
  static const std::vector<std::string> names = {"low,drawn", "low,largest", "high,drawn",
                                                 "high,largest"};
  return names;
}

WorldRanges at_corner(WorldRanges ranges, const std::string& corner, const Task& task) {
  const auto& names = corner_names();
  const auto name = std::find(names.begin(), names.end(), corner);
  if (name == names.end()) {
    throw InputError("--corner " + corner +
                     ": give friction and size, as low,drawn low,largest high,drawn high,largest");
  }
  const auto index = name - names.begin();
  const bool largest = index % 2 == 1;
  if (largest && task.oversize_m == 0.0) {
    throw InputError("--corner " + corner + ": task '" + task.name +
                     "' has no physics.oversize_m: its largest part is the drawn one");
  }
  const double friction = index < 2 ? task.friction.low : task.friction.high;
  const double smaller_m = largest ? -task.oversize_m : 0.0;
  ranges.friction = Spread{.low = friction, .high = friction};
  ranges.clearance_m = {.low = smaller_m, .high = smaller_m};
  ranges.name += (ranges.name.empty() ? "" : " at ") + corner;
  return ranges;
}

}  // namespace tenon::sim

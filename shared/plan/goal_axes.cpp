#include "shared/plan/goal_axes.h"

#include <algorithm>
#include <cmath>

#include "shared/base/shown.h"
#include "shared/base/text.h"

namespace tenon {

Vector6 beyond_own(const Vector6& off, const GoalAxes& axes) {
  Vector6 beyond = off;
  for (int axis = 0; axis < 6; ++axis) {
    const double allowed = std::min(axes.tolerance[axis], std::abs(off[axis]));
    beyond[axis] = has(axes.free, axis) ? 0.0 : off[axis] - std::copysign(allowed, off[axis]);
  }
  return beyond;
}

double tolerances_off(const Vector6& off, double together_m, const GoalAxes& axes,
                      double orientation_weight) {
  Vector6 together = off;
  double most = 0.0;
  for (int axis = 0; axis < 6; ++axis) {
    if (axes.together(axis)) continue;
    together[axis] = 0.0;
    if (has(axes.free, axis)) continue;
    most = std::max(most, std::abs(off[axis]) / axes.tolerance[axis]);
  }
  const double all = together.head<3>().norm() + orientation_weight * together.tail<3>().norm();
  return std::max(most, all / together_m);
}

std::string tolerance_text(double together_m, const GoalAxes& axes) {
  std::string text = format("%.3g mm", 1e3 * together_m);
  for (int axis = 0; axis < 6; ++axis) {
    if (axes.together(axis)) continue;
    text += std::string(", ") + axis_name(axis);
    if (has(axes.free, axis)) {
      text += " any";
    } else if (axis < 3) {
      text += format(" %.3g mm", 1e3 * axes.tolerance[axis]);
    } else {
      text += format(" %.3g degrees", degrees(axes.tolerance[axis]));
    }
  }
  return text;
}

}  // namespace tenon

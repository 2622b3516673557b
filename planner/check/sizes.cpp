#include "planner/check/sizes.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "shared/base/text.h"
#include "shared/geometry/solid.h"
#include "shared/task/ring.h"

namespace tenon::planner {
namespace {

// Speeds and spreads of a task are at most 1 m/s and 1 m: what an arm holds is no larger.
constexpr double kPartMax_m = 1.0;
// A floor or a wall of the cell is; beyond this no arm gets.
constexpr double kEnvironmentMax_m = 10.0;
// Below what a threshold of force can tell apart.
constexpr double kPartMin_m = 1e-4;

std::string key_of(const char* list, const Shape& shape, std::size_t index) {
  const char* key = ".box_m";
  if (shape.kind == Shape::Kind::kCylinder) key = ".cylinder";
  if (shape.kind == Shape::Kind::kSolid) key = " (mesh or extrusion)";
  return format("%s[%zu]%s of '%s'", list, index, key, shape.name.c_str());
}

/// In which units the numbers would make a part.
std::string units_meant(double largest_m) {
  std::string text;
  const auto would_be = [&](const char* unit, double factor) {
    const double meant_m = largest_m / factor;
    if (meant_m > kPartMax_m || meant_m < kPartMin_m) return;
    text += std::string(text.empty() ? "" : " or ") + format("%s (%.4g m)", unit, meant_m);
  };
  would_be("mm", 1e3);
  would_be("cm", 1e2);
  would_be("inches", 1.0 / 0.0254);
  return text.empty() ? "" : ": did you mean " + text + "? sizes are in m";
}

/// Of a part that is too small: what made metres of its file.
std::string scale_meant(const Shape& shape) {
  const double meant_m = 1e3 * shape.size_m.maxCoeff();
  if (shape.kind != Shape::Kind::kSolid || meant_m > kPartMax_m || meant_m < kPartMin_m) return "";
  return format(
      ": did you mean 1000 times that (%.4g m)? a mesh's scale is 0.001 where its file "
      "is in mm, 1 where it is in m",
      meant_m);
}

/// Whether a shape's middle stands in another.
bool stands_in(const Shape& shape, const Shape& other) {
  const Vector3 at_m = compose(inverse(other.pose), shape.pose).position_m;
  switch (other.kind) {
    case Shape::Kind::kBox:
      return (at_m.cwiseAbs() - 0.5 * other.size_m).maxCoeff() < 0.0;
    case Shape::Kind::kCylinder:
      return at_m.head<2>().norm() < 0.5 * other.size_m.x() &&
             std::abs(at_m.z()) < 0.5 * other.size_m.z();
    case Shape::Kind::kSolid:
      break;
  }
  // The middle of the box around a body may be outside of it.
  return shape.kind != Shape::Kind::kSolid && other.solid->place(at_m).distance_m < 0.0;
}

/// Two of the environment that cannot both be where they are said to be.
void find_doubled(const Task& task, std::vector<Finding>& findings) {
  for (std::size_t i = 0; i < task.environment.size(); ++i) {
    const Shape& one = task.environment[i];
    for (std::size_t j = 0; j < i; ++j) {
      const Shape& other = task.environment[j];
      if (piece_of(one.name) == piece_of(other.name)) continue;
      if (!stands_in(one, other) || !stands_in(other, one)) continue;
      findings.push_back(
          {Finding::Weight::kDoubt,
           format("environment[%zu] '%s' and environment[%zu] '%s' stand in each other, their "
                  "middles %.3g mm apart: is a sign wrong in one's pose?",
                  j, other.name.c_str(), i, one.name.c_str(),
                  1e3 * (one.pose.position_m - other.pose.position_m).norm())});
      return;
    }
  }
}

void find_other_doubts(const Task& task, std::vector<Finding>& findings) {
  // A tool that gives way farther than any part is long holds nothing.
  const double yields_m = task.motion.thresholds.force_on_N / task.compliance.stiffness_Npm;
  if (yields_m > kPartMax_m) {
    findings.push_back(
        {Finding::Weight::kDoubt,
         format("compliance.stiffness_Npm = %g: force_on = %g N moves the tool by %.3g m; is it in "
                "N/mm? then write %g N/m",
                task.compliance.stiffness_Npm, task.motion.thresholds.force_on_N, yields_m,
                1e3 * task.compliance.stiffness_Npm)});
  }
  double thinnest_m = std::numeric_limits<double>::infinity();
  for (const Shape& shape : task.held) {
    thinnest_m = std::min(thinnest_m, shape.size_m.maxCoeff());
  }
  constexpr double kToleranceMin_m = 1e-5;
  if (task.goal_tolerance_m >= thinnest_m) {
    findings.push_back({Finding::Weight::kDoubt,
                        format("goal.tolerance_m = %g is as much as the held part measures, %.3g "
                               "m: it may end anywhere near the goal",
                               task.goal_tolerance_m, thinnest_m)});
  } else if (task.goal_tolerance_m < kToleranceMin_m) {
    findings.push_back({Finding::Weight::kDoubt,
                        format("goal.tolerance_m = %g is less than an arm is good for: nothing "
                               "ends within less than some 10 um of the goal",
                               task.goal_tolerance_m)});
  }
}

/// From the tool frame's origin to the box around a shape, m.
double beyond(const Shape& shape) {
  const Vector3 inside_m = compose(inverse(shape.pose), {}).position_m;
  return (inside_m.cwiseAbs() - 0.5 * shape.size_m).cwiseMax(0.0).norm();
}

}  // namespace

std::vector<Finding> doubtful_sizes(const Task& task) {
  std::vector<Finding> findings;
  const auto doubt = [&](const char* list, std::size_t i, const Shape& shape, const char* why) {
    findings.push_back(
        {Finding::Weight::kDoubt, key_of(list, shape, i) +
                                      format(" measures %g x %g x %g m, %s", shape.size_m.x(),
                                             shape.size_m.y(), shape.size_m.z(), why) +
                                      units_meant(shape.size_m.maxCoeff()) + scale_meant(shape)});
  };
  double nearest_m = std::numeric_limits<double>::infinity();
  double largest_m = 0.0;
  for (std::size_t i = 0; i < task.held.size(); ++i) {
    const Shape& shape = task.held[i];
    nearest_m = std::min(nearest_m, beyond(shape));
    largest_m = std::max(largest_m, shape.size_m.maxCoeff());
    const double size_m = shape.size_m.maxCoeff();
    if (size_m <= kPartMax_m && size_m >= kPartMin_m) continue;
    doubt("held", i, shape, "which no arm holds");
  }
  for (std::size_t i = 0; i < task.environment.size(); ++i) {
    const Shape& shape = task.environment[i];
    if (shape.size_m.maxCoeff() <= kEnvironmentMax_m) continue;
    doubt("environment", i, shape, "which no arm reaches around");
  }
  if (nearest_m > 0.5 * largest_m) {
    findings.push_back(
        {Finding::Weight::kDoubt,
         format("the held part is %.4g m away from the tool: `held` is in the tool frame, whose "
                "origin is the part's tip, not in the task frame",
                nearest_m)});
  }
  find_doubled(task, findings);
  find_other_doubts(task, findings);
  return findings;
}

}  // namespace tenon::planner

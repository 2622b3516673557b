#include "planner/check/sizes.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "shared/base/text.h"

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
  return findings;
}

}  // namespace tenon::planner

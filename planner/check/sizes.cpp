#include "planner/check/sizes.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "shared/base/text.h"
#include "shared/geometry/solid.h"
#include "shared/motion/rules.h"
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
std::string units_meant(const Shape& shape) {
  const double largest_m = shape.size_m.maxCoeff();
  std::string text;
  const auto would_be = [&](const char* unit, double factor) {
    const double meant_m = largest_m / factor;
    if (meant_m > kPartMax_m || meant_m < kPartMin_m) return;
    text += std::string(text.empty() ? "" : " or ") + format("%s (%.4g m)", unit, meant_m);
  };
  would_be("mm", 1e3);
  would_be("cm", 1e2);
  would_be("inches", 1.0 / 0.0254);
  if (text.empty()) return "";
  text = ": did you mean " + text + "? ";
  return text + (shape.kind == Shape::Kind::kSolid
                     ? "a mesh's scale is 0.001 where its file is in mm, 1 where it is in m"
                     : "sizes are in m");
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

// Boxes of a ring, whose neighbours may reach into each other; walls that are numbered by hand are
// fewer.
constexpr std::ptrdiff_t kRingSegmentsMin = 8;

bool of_one_ring(const Task& task, const Shape& one, const Shape& other) {
  const std::string name = piece_of(one.name);
  if (name != piece_of(other.name)) return false;
  return std::count_if(task.environment.begin(), task.environment.end(), [&](const Shape& shape) {
           return piece_of(shape.name) == name;
         }) >= kRingSegmentsMin;
}

/// Two of the environment that cannot both be where they are said to be.
void find_doubled(const Task& task, std::vector<Finding>& findings) {
  for (std::size_t i = 0; i < task.environment.size(); ++i) {
    const Shape& one = task.environment[i];
    for (std::size_t j = 0; j < i; ++j) {
      const Shape& other = task.environment[j];
      if (!stands_in(one, other) || !stands_in(other, one)) continue;
      if (of_one_ring(task, one, other)) continue;
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

/// How far the tool gives way to the force that is a contact, and presses on until it knows of it.
void find_doubtful_stiffness(const Task& task, std::vector<Finding>& findings) {
  const double stiffness_Npm = task.compliance.stiffness_Npm;
  // A tool that gives way farther than any part is long holds nothing.
  const double yields_m = task.motion.thresholds.force_on_N / stiffness_Npm;
  if (yields_m > kPartMax_m) {
    findings.push_back(
        {Finding::Weight::kDoubt,
         format("compliance.stiffness_Npm = %g: force_on = %g N moves the tool by %.3g m; is it in "
                "N/mm? then write %g N/m",
                stiffness_Npm, task.motion.thresholds.force_on_N, yields_m, 1e3 * stiffness_Npm)});
  }
  const double debounce_s = 1e-6 * task.motion.thresholds.debounce_us;
  const double on_m = task.motion.speeds.contact_mps * debounce_s;
  if (stiffness_Npm * on_m > task.force_limit_N) {
    findings.push_back(
        {Finding::Weight::kDoubt,
         format(
             "compliance.stiffness_Npm = %g: before it knows of a contact the tool runs on by "
             "%.3g mm (contact_mps times debounce_s), which presses with %.3g N, the limit is %g "
             "N: a softer tool, or a slower one",
             stiffness_Npm, 1e3 * on_m, stiffness_Npm * on_m, task.force_limit_N)});
  }
}

void find_doubtful_goal(const Task& task, std::vector<Finding>& findings) {
  const double certain_m = std::sqrt(task.goal_uncertainty_m2);
  constexpr double kCertainMin_m = 1e-5;
  if (task.goal_uncertainty_m2 > 0.0 && certain_m < kCertainMin_m) {
    findings.push_back(
        {Finding::Weight::kDoubt,
         format("goal.uncertainty_m2 = %g asks for a place that is certain to %.2g mm, which no "
                "arm is good for: it is a variance in m^2, and may be left out",
                task.goal_uncertainty_m2, 1e3 * certain_m)});
  }
}

void find_other_doubts(const Task& task, std::vector<Finding>& findings) {
  const double force_on_N = task.motion.thresholds.force_on_N;
  if (force_on_N < kForceOnMin_N) {
    findings.push_back(
        {Finding::Weight::kDoubt,
         format(
             "contact.force_on_N = %g is within the noise of most force sensors: a plan takes it "
             "for a contact wherever it comes; write some newtons, in N",
             force_on_N) +
             kilonewtons_hint(force_on_N)});
  }
  double longest_m = 0.0;
  for (const Shape& shape : task.held) longest_m = std::max(longest_m, shape.size_m.maxCoeff());
  constexpr double kToleranceMin_m = 1e-5;
  if (task.goal_tolerance_m >= longest_m) {
    findings.push_back({Finding::Weight::kDoubt,
                        format("goal.tolerance_m = %g is as much as the longest held shape "
                               "measures, %.3g m: it may end anywhere near the goal",
                               task.goal_tolerance_m, longest_m)});
  } else if (task.goal_tolerance_m < kToleranceMin_m) {
    findings.push_back({Finding::Weight::kDoubt,
                        format("goal.tolerance_m = %g is less than an arm is good for: nothing "
                               "ends within less than some 10 um of the goal",
                               task.goal_tolerance_m)});
  }
}

/// A place that no arm gets to, the goal's or a start's.
void find_far_places(const Task& task, std::vector<Finding>& findings) {
  const auto far = [&](const std::string& what, const Vector3& p) {
    const double away_m = p.norm();
    if (away_m <= kEnvironmentMax_m) return false;
    const auto in = [&](const char* unit, double per_m) {
      const Vector3 meant_m = p / per_m;
      return format("%s (%.4g, %.4g, %.4g m)", unit, meant_m.x(), meant_m.y(), meant_m.z());
    };
    std::string text = what + format(
                                  " at (%.4g, %.4g, %.4g) m is %.4g m away from the task frame, "
                                  "where no arm gets: did you mean ",
                                  p.x(), p.y(), p.z(), away_m);
    text += in("mm", 1e3) + " or " + in("cm", 1e2) + "? places are in m";
    findings.push_back({Finding::Weight::kDoubt, std::move(text)});
    return true;
  };
  if (far("the goal", task.goal.position_m)) return;
  for (const Start& start : task.starts) {
    if (far("start '" + start.name + "'", start.pose.position_m)) return;
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
                                      units_meant(shape) + scale_meant(shape)});
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
  find_far_places(task, findings);
  find_doubled(task, findings);
  find_doubtful_stiffness(task, findings);
  find_other_doubts(task, findings);
  find_doubtful_goal(task, findings);
  return findings;
}

}  // namespace tenon::planner

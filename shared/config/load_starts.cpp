#include "shared/config/load_starts.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <set>
#include <string>
#include <vector>

#include "shared/base/text.h"
#include "shared/math/pose.h"

namespace tenon::config {
namespace {

constexpr std::size_t kStartsMax = 200;
constexpr double kSamePlace = 1e-9;                      // m or rad
constexpr double kBoundOverSigma = std::numbers::sqrt3;  // of a uniform distribution

/// One number for each search coordinate of a kind, in the order x y z or rx ry rz.
void read_errors(const Map& map, const char* key, int first_axis, CoordinateMask coordinates,
                 Vector6& error) {
  std::size_t count = 0;
  std::string names;
  for (int axis = first_axis; axis < first_axis + 3; ++axis) {
    if (!has(coordinates, axis)) continue;
    ++count;
    names.append(" ").append(kAxisNames[axis]);
  }
  if (count == 0) {
    if (const auto given = map.find(key)) {
      given->refuse("no search coordinate has this unit: must have none");
    }
    return;
  }
  if (!map.find(key)) {
    map.value().refuse(format("the required key %s is missing, a list of %zu, for", key, count) +
                       names);
  }
  const Value given = map.at(key);
  if (const std::size_t written = given.entries_written(); written != 0 && written != count) {
    given.refuse(Value::entries_text(written) + format(", must have %zu, for", count) + names);
  }
  const std::vector<Value> values = given.list(count, count);
  auto next = values.begin();
  for (int axis = first_axis; axis < first_axis + 3; ++axis) {
    if (!has(coordinates, axis)) continue;
    if (next->is_zero()) {
      next->refuse_value(std::string("in (0, 1]; where ") + kAxisNames[axis] +
                         " is known, leave it out of coordinates");
    }
    error[axis] = (next++)->number(positive_to(1.0));
  }
}

Map start_map(const Value& value) {
  return {value, {"name", "pose", "sigma_m", "sigma_rad", "uniform_m", "uniform_rad"}};
}

/// The first start's keys decide for all.
Distribution distribution_of(const Value& start) {
  const Map map = start_map(start);
  return map.find("uniform_m") || map.find("uniform_rad") ? Distribution::kUniform
                                                          : Distribution::kNormal;
}

Start read_start(const Value& value, const Task& task, std::set<std::string>& names) {
  const Map map = start_map(value);
  Start start;
  start.name = map.at("name").name();
  if (!names.insert(start.name).second) map.at("name").refuse_value("unique among the starts");
  start.pose = map.at("pose").pose();
  const bool uniform = task.errors == Distribution::kUniform;
  for (const char* other :
       {uniform ? "sigma_m" : "uniform_m", uniform ? "sigma_rad" : "uniform_rad"}) {
    if (const auto given = map.find(other)) {
      given->refuse(
          "normal errors (sigma_m, sigma_rad) and uniform ones (uniform_m, uniform_rad) do "
          "not mix in a task");
    }
  }
  read_errors(map, uniform ? "uniform_m" : "sigma_m", 0, task.coordinates, start.sigma);
  read_errors(map, uniform ? "uniform_rad" : "sigma_rad", 3, task.coordinates, start.sigma);
  if (uniform) start.sigma /= kBoundOverSigma;
  return start;
}

/// Nothing moves the tool along axes that are no search coordinates. Where all of several starts
/// agree, the goal is what is off.
/// @param goal its pose
void check_ways(const std::vector<Value>& starts, const Value& goal, const Task& task) {
  for (int axis = 0; axis < 6; ++axis) {
    if (has(task.coordinates, axis)) continue;
    std::vector<double> ways;
    ways.reserve(task.starts.size());
    for (const Start& start : task.starts) {
      ways.push_back(displacement_between(start.pose, task.goal)[axis]);
    }
    const auto off = std::find_if(ways.begin(), ways.end(),
                                  [](double way) { return std::abs(way) > kSamePlace; });
    if (off == ways.end()) continue;
    const double least = *std::min_element(ways.begin(), ways.end());
    const double most = *std::max_element(ways.begin(), ways.end());
    const auto refuse = [&](const Value& pose, const char* whom) {
      pose.refuse(
          format("is %f %s off %s along %s, which is not a search coordinate; add %s "
                 "to coordinates, or let start and goal agree along it",
                 std::abs(*off), axis_unit(axis), whom, axis_name(axis), axis_name(axis)));
    };
    if (starts.size() > 1 && most - least <= kSamePlace) refuse(goal, "all starts");
    const auto index = static_cast<std::size_t>(off - ways.begin());
    refuse(start_map(starts[index]).at("pose"), "the goal");
  }
}

}  // namespace

CoordinateMask read_axes(const Value& value) {
  unsigned mask = 0;
  for (const Value& axis : value.list(1, 6)) {
    const unsigned bit = 1U << axis.choice({kAxisNames.begin(), kAxisNames.end()});
    if ((mask & bit) != 0) axis.refuse_value("listed once");
    mask |= bit;
  }
  return static_cast<CoordinateMask>(mask);
}

void read_starts(const Value& value, const Value& goal, Task& task) {
  std::set<std::string> names;
  const std::vector<Value> starts = value.list(1, kStartsMax);
  task.errors = distribution_of(starts.front());
  for (const Value& start : starts) task.starts.push_back(read_start(start, task, names));
  check_ways(starts, goal, task);
}

void read_reach(const Map& task_file, Task& task) {
  task_file.optional_number("particle_sigmas", positive_to(5.0), task.particle_sigmas);
  if (task.errors == Distribution::kNormal) return;
  if (const auto given = task_file.find("particle_sigmas")) {
    given->refuse(
        "counts standard deviations of normal errors (sigma_m, sigma_rad); a plan for "
        "uniform ones holds to their bounds");
  }
  task.particle_sigmas = kBoundOverSigma;
}

}  // namespace tenon::config

#include "planner/check/probe.h"

#include <algorithm>
#include <limits>
#include <utility>

#include "shared/ports/collision_depth.h"
#include "shared/task/ring.h"

namespace tenon::planner {
namespace {

// A part that stands in another is looked for outside of it in so many strides.
constexpr int kStrides = 64;

double thinnest(const std::vector<Shape>& shapes) {
  double least_m = std::numeric_limits<double>::infinity();
  for (const Shape& shape : shapes) least_m = std::min(least_m, shape.size_m.minCoeff());
  return least_m;
}

double largest(const std::vector<Shape>& shapes) {
  double most_m = 0.0;
  for (const Shape& shape : shapes) most_m = std::max(most_m, shape.size_m.norm());
  return most_m;
}

/// Between a way that is not yet so and one that is.
template <typename Is>
double bisected(double not_yet_m, double already_m, const Is& is) {
  while (already_m - not_yet_m > kWayKnownTo_m) {
    const double middle_m = 0.5 * (not_yet_m + already_m);
    (is(middle_m) ? already_m : not_yet_m) = middle_m;
  }
  return already_m;
}

}  // namespace

Pose moved(const Pose& pose, int axis, double way_m) {
  Pose there = pose;
  there.position_m[axis] += way_m;
  return there;
}

Probe::Probe(const Task& task, MakeRollout make)
    : task_(task),
      make_(std::move(make)),
      all_(make_(task_)),
      extent_m_(largest(task.held) + largest(task.environment)),
      stride_m_(0.5 * (thinnest(task.held) + thinnest(task.environment))) {}

void Probe::make_pairs() {
  if (!pairs_.empty()) return;
  for (const Shape& held : task_.held) {
    for (const Shape& environment : task_.environment) {
      Task pair = task_;
      pair.held = {held};
      pair.environment = {environment};
      pairs_.push_back({&held, &environment, make_(pair)});
    }
  }
}

std::optional<Overlap> Probe::deepest(const Pose& tool) {
  if (free(tool)) return std::nullopt;
  make_pairs();
  std::optional<Overlap> deepest;
  for (const Pair& pair : pairs_) {
    if (!pair.rollout->in_collision(tool)) continue;
    Overlap least{piece_of(pair.held->name), piece_of(pair.environment->name), extent_m_, 0, 1};
    for (int way = 0; way < 6; ++way) {
      const int axis = way / 2;
      const int sign = way % 2 == 0 ? 1 : -1;
      const auto parted = [&](double way_m) {
        return !pair.rollout->in_collision(moved(tool, axis, sign * way_m));
      };
      const double stride_m = extent_m_ / kStrides;
      double out_m = stride_m;
      while (out_m < least.depth_m && !parted(out_m)) out_m += stride_m;
      if (!parted(out_m)) continue;
      const double depth_m = bisected(out_m - stride_m, out_m, parted);
      if (depth_m < least.depth_m) {
        least = {least.held, least.environment, depth_m + kCollisionDepth_m, axis, sign};
      }
    }
    if (!deepest || least.depth_m > deepest->depth_m) deepest = least;
  }
  return deepest;
}

std::string Probe::met_at(const Pose& tool) {
  make_pairs();
  const auto met = std::find_if(pairs_.begin(), pairs_.end(),
                                [&](const Pair& pair) { return pair.rollout->in_collision(tool); });
  return met == pairs_.end() ? std::string() : piece_of(met->environment->name);
}

std::optional<double> Probe::way_to_touch(const Pose& from, int axis, int sign, double reach_m) {
  const auto touches = [&](double way_m) { return !free(moved(from, axis, sign * way_m)); };
  double before_m = 0.0;
  while (before_m < reach_m) {
    const double next_m = std::min(before_m + stride_m_, reach_m);
    if (touches(next_m)) {
      return std::max(bisected(before_m, next_m, touches) - kCollisionDepth_m, 0.0);
    }
    before_m = next_m;
  }
  return std::nullopt;
}

}  // namespace tenon::planner

#include "planner/search/free_legs.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <utility>

#include "planner/belief/primitives.h"

namespace tenon::planner {
namespace {

// Shorter legs change nothing that anybody could measure.
constexpr double kNoLeg = 1e-4;
constexpr double kStride_m = 1e-3;
constexpr double kStridesMax = 250.0;
// What is beside the way stays so far off, where there is room for it.
constexpr double kBeside_m = 0.5e-3;

void add(std::vector<Vector6>& legs, const Vector6& leg) {
  if (leg.cwiseAbs().maxCoeff() > kNoLeg) legs.push_back(leg);
}

double length(const std::vector<Vector6>& legs) {
  double sum = 0.0;
  for (const Vector6& leg : legs) sum += leg.head<3>().norm();
  return sum;
}

}  // namespace

std::optional<std::vector<Vector6>> FreeLegs::to(const BeliefSummary& belief, const Pose& place,
                                                 const ArmPlace* arm) {
  Vector6 way = displacement_between(belief.mean, place);
  for (int axis = 0; axis < 6; ++axis) {
    if (!has(moved_axes(task_), axis)) way[axis] = 0.0;
  }
  const std::vector<Legs> all = candidates(way, belief.mean);
  const Pose end = displaced(belief.mean, way);
  const Vector3 aside_m = turned_aside_m(belief.spread, part_);
  for (const double margin_m : {kBeside_m, 0.0}) {
    const Vector3 half_m = belief.spread.head<3>() + aside_m + Vector3::Constant(margin_m);
    if (!free_at(end, half_m)) continue;  // where all of them lead
    for (const Legs& legs : all) {
      if (free(belief, legs, half_m) && in_reach(belief, legs, arm)) return legs;
    }
  }
  return std::nullopt;
}

std::vector<FreeLegs::Legs> FreeLegs::candidates(const Vector6& way, const Pose& from) const {
  Vector6 turn = Vector6::Zero();
  turn.tail<3>() = way.tail<3>();
  const Vector6 shift = way - turn;
  std::vector<Legs> all;
  add(all.emplace_back(), shift);
  for (int axis = 0; axis < 3; ++axis) {
    const Vector6 along = shift[axis] * Vector6::Unit(axis);
    for (const bool first : {true, false}) {
      Legs& legs = all.emplace_back();
      add(legs, first ? along : shift - along);
      add(legs, first ? shift - along : along);
    }
  }
  std::array<int, 3> order = {0, 1, 2};
  do {
    Legs& legs = all.emplace_back();
    for (const int axis : order) add(legs, shift[axis] * Vector6::Unit(axis));
  } while (std::next_permutation(order.begin(), order.end()));
  const Vector6 clear = displacement_between(from, clear_);
  for (int axis = 0; axis < 3; ++axis) {
    if (!has(task_.coordinates, axis)) continue;
    Vector6 across = shift;
    across[axis] = 0.0;
    Legs& legs = all.emplace_back();
    add(legs, clear[axis] * Vector6::Unit(axis));
    add(legs, across);
    add(legs, (shift[axis] - clear[axis]) * Vector6::Unit(axis));
  }
  // Turned on the first leg, or before it, where it was free before.
  if (turn.norm() > kNoLeg) {
    const std::vector<Legs> straight = all;
    for (Legs& legs : all) legs.insert(legs.begin(), turn);
    for (Legs legs : straight) {
      if (legs.empty()) continue;
      legs.front() += turn;
      all.push_back(std::move(legs));
    }
  }
  std::stable_sort(all.begin(), all.end(), [](const Legs& a, const Legs& b) {
    return std::pair(a.size(), length(a)) < std::pair(b.size(), length(b));
  });
  return all;
}

bool FreeLegs::free(const BeliefSummary& belief, const Legs& legs, const Vector3& half_m) {
  Pose at = belief.mean;
  for (const Vector6& leg : legs) {
    const double length_m = leg.head<3>().norm();
    const double strides = std::ceil(std::clamp(length_m / kStride_m, 1.0, kStridesMax));
    for (double i = 1.0; i <= strides; i += 1.0) {
      if (!free_at(displaced(at, i / strides * leg), half_m)) return false;
    }
    at = displaced(at, leg);
  }
  return true;
}

/// A leg through free space is gone to its end.
bool FreeLegs::in_reach(const BeliefSummary& belief, const Legs& legs, const ArmPlace* arm) {
  if (reach_ == nullptr || arm == nullptr) return true;
  Pose at = belief.mean;
  std::shared_ptr<const ArmPlace> place;
  for (const Vector6& leg : legs) {
    const Vector6 told = in_move_axes(task_, at, leg);
    at = displaced(at, leg);
    const Vector6 end = reach_->place_at(at);
    const MoveReach::Travel travel{{told, told}, {end - belief.spread, end + belief.spread}};
    place = reach_->after(place ? *place : *arm, told, {}, travel, false);
    if (!place) return false;
  }
  return true;
}

bool FreeLegs::free_at(const Pose& mean, const Vector3& half_m) {
  if (rollout_.in_collision(mean)) return false;
  for (unsigned corner = 0; corner < 8; ++corner) {
    Pose at = mean;
    bool twice = false;
    for (int axis = 0; axis < 3; ++axis) {
      const bool up = (corner >> axis & 1U) != 0;
      if (has(task_.coordinates, axis)) {
        at.position_m[axis] += up ? half_m[axis] : -half_m[axis];
      } else {
        twice = twice || up;
      }
    }
    if (!twice && rollout_.in_collision(at)) return false;
  }
  return true;
}

}  // namespace tenon::planner

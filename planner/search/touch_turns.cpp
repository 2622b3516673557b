#include "planner/search/touch_turns.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <utility>

#include "planner/search/free_legs.h"
#include "planner/search/guide_moves.h"
#include "planner/search/guide_way.h"
#include "planner/search/placing.h"

namespace tenon::planner {
namespace {

// How far off a face the nearest particle begins to push.
constexpr double kFromFace_m = 5e-3;
// In steps of this it is looked for where the part meets a side.
constexpr double kStride_m = 0.5e-3;
// What the middle of the part keeps to a flat side's rim besides what is uncertain.
constexpr double kToRim_m = 1e-3;
constexpr std::size_t kTurnsMax = 7;
// How many beliefs go on from turn to turn.
constexpr std::size_t kKept = 2;
// Of what is left, a sum of logarithms: a touch takes at least as much as a third of one deviation.
constexpr double kWorth = 0.4;
// A part that a touch turns farther than this away from how it is to stand has not come to lie
// flat.
constexpr double kTurnedMax_rad = 0.035;
// Every so many particles go ahead: where they do not touch, the others need not try.
constexpr std::size_t kAhead = 4;

bool on_face(const Belief& belief, int axis, int sign) {
  return std::all_of(belief.particles.begin(), belief.particles.end(),
                     [&](const Particle& p) { return p.signature.sign(axis) == -sign; });
}

Belief some_of(const Belief& belief) {
  Belief some;
  for (std::size_t i = 0; i < belief.particles.size(); i += kAhead) {
    some.particles.push_back(belief.particles[i]);
  }
  return some;
}

bool same_touch(const ContactAttractor& a, const ContactAttractor& b) {
  return a.axis == b.axis && a.sign == b.sign;
}

}  // namespace

TouchTurns::TouchTurns(const Task& task, const Belief& start, const Pose& clear,
                       SuccessorEngine& succ, Rollout& rollout, const std::function<bool()>& stop)
    : task_(task),
      start_(start),
      clear_(clear),
      part_(around(task.held)),
      succ_(succ),
      rollout_(rollout),
      stop_(stop) {
  const int coordinates =
      std::popcount(static_cast<CoordinateMask>(task.coordinates & ~task.goal_axes.free));
  const double enough_m = std::sqrt(task.goal_uncertainty_m2 / std::max(1, coordinates));
  const Metric metric = metric_of(task);
  // Without bound along free axes.
  for (int axis = 0; axis < 6; ++axis) {
    if (has(task.coordinates, axis))
      enough_[axis] = enough_m / std::sqrt(metric.variance_weight(axis));
  }
}

/// What a touch tells of a place is worth as much as the angles leave of it there.
Belief TouchTurns::over_goal(const Belief& belief) const {
  return moved_to(task_.goal, belief, task_);
}

/// About the mean, at the goal; of each axis as many times what is enough there.
TouchTurns::Matrix6 TouchTurns::covariance(const Belief& belief) const {
  const Belief there = over_goal(belief);
  const Pose about = mean_pose(there);
  Matrix6 sum = Matrix6::Zero();
  for (const Particle& particle : there.particles) {
    const Vector6 off = displacement_between(about, particle.tool()).cwiseQuotient(enough_);
    sum += off * off.transpose();
  }
  return sum / static_cast<double>(there.particles.size());
}

/// Along the principal axes, as what is off together counts once: a touch of a part that is turned
/// anyhow tells how far it is off there, although at the goal, farther away, every coordinate by
/// itself is as uncertain as before.
double TouchTurns::left_of(const Belief& belief) const {
  const Eigen::SelfAdjointEigenSolver<Matrix6> principal(covariance(belief),
                                                         Eigen::EigenvaluesOnly);
  return principal.eigenvalues().array().max(0.0).sqrt().log1p().sum();
}

bool TouchTurns::certain(const Belief& belief) const {
  return covariance(belief).diagonal().maxCoeff() <= 1.0;
}

std::vector<Guide> TouchTurns::find() {
  std::vector<Turn> found;
  std::vector<Turn> kept(1);
  kept.front().belief = start_;
  kept.front().left = left_of(start_);
  for (std::size_t turn = 0; turn < kTurnsMax && !kept.empty() && !stopped(); ++turn) {
    std::vector<Turn> next;
    for (const Turn& from : kept) further(from, next);
    kept = best_of(std::move(next));
    found.insert(found.end(), kept.begin(), kept.end());
    if (!kept.empty() && certain(kept.front().belief)) break;
  }
  sort(found);
  std::vector<Guide> guides;
  guides.reserve(found.size());
  for (Turn& turn : found) guides.push_back({std::move(turn.contacts), {task_.goal}, 1.0});
  return guides;
}

/// Those that are certain by what was left on the way: a touch that turns a part which is askew is
/// less sure than one that finds it flat.
void TouchTurns::sort(std::vector<Turn>& turns) const {
  const auto key = [this](const Turn& turn) {
    const bool enough = certain(turn.belief);
    return std::pair(!enough, enough ? turn.passed : turn.left);
  };
  std::stable_sort(turns.begin(), turns.end(),
                   [&](const Turn& a, const Turn& b) { return key(a) < key(b); });
}

/// Along every axis whose push may still settle something.
void TouchTurns::further(const Turn& turn, std::vector<Turn>& next) {
  const Matrix6 left = covariance(turn.belief);
  const auto open = [&](int axis) { return left(axis, axis) > 1.0; };
  for (const Shape& shape : task_.environment) {
    for (int axis = 0; axis < 3; ++axis) {
      const bool turns = open(3 + (axis + 1) % 3) || open(3 + (axis + 2) % 3);
      if (!has(task_.coordinates, axis) || !(open(axis) || turns)) continue;
      for (const int sign : {1, -1}) {
        // A part that is pressed settles more, but slides or rolls off what is round or narrow.
        const bool held = touch_sides(turn, shape, {axis, sign, false}, next);
        if (!held && open(axis)) touch_sides(turn, shape, {axis, sign, true}, next);
      }
    }
  }
}

bool TouchTurns::touch_sides(const Turn& turn, const Shape& shape, const Push& push,
                             std::vector<Turn>& next) {
  const int axis = push.axis;
  const int sign = push.sign;
  const Eigen::AlignedBox3d box = around({shape});
  Pose before = {box.center(), task_.goal.orientation};
  before.position_m[axis] = sign > 0 ? box.min()[axis] : box.max()[axis];
  const Vector6 spread = spread_at(before, turn);
  double across_m = 0.0;
  for (int other = 0; other < 3; ++other) {
    if (other != axis) across_m = std::max(across_m, spread[other]);
  }
  // Sides that are narrower than what is uncertain come last: what is off across them need not be
  // off together, and each push shows whether any start misses.
  const double middle_m = across_m + 0.5 * part_.sizes().maxCoeff();
  std::vector<TouchPlace> narrow;
  std::vector<Vector3> tried;
  for (const double enough_m : {across_m + kToRim_m, middle_m}) {
    for (const TouchPlace& side : touch_places(shape, axis, sign, enough_m, clear_.position_m)) {
      const bool again = std::any_of(tried.begin(), tried.end(), [&](const Vector3& at_m) {
        return (at_m - side.at_m).norm() < task_.step_m;
      });
      if (again || stopped()) continue;
      tried.push_back(side.at_m);
      if (side.to_rim_m < across_m) {
        narrow.push_back(side);
      } else if (touch(turn, side, push, next)) {
        return true;
      }
    }
  }
  for (const TouchPlace& side : narrow) {
    if (stopped()) return false;
    if (touch(turn, side, push, next)) return true;
  }
  // What is off across a round side is off along it by less, and after the other axis by less
  // again.
  for (const TouchPlace& side : round_places(shape, axis, sign, clear_.position_m)) {
    if (stopped()) return false;
    if (touch(turn, side, push, next)) return true;
  }
  return false;
}

/// What is uncertain where a belief's mean has come through free space.
Vector6 TouchTurns::spread_at(const Pose& place, const Turn& turn) const {
  const Belief there = moved_to(place, turn.belief, task_);
  return summarise(there, task_).spread;
}

/// What of the part comes first need not be what meets the side: a flange may pass above it.
std::optional<Pose> TouchTurns::met_at(const TouchPlace& side, int axis, int sign) {
  const double ahead_m = sign > 0 ? part_.max()[axis] : -part_.min()[axis];
  Pose at{side.at_m, task_.goal.orientation};
  at.position_m[axis] -= sign * (ahead_m + kStride_m);
  if (rollout_.in_collision(at)) return std::nullopt;
  for (double gone_m = 0.0; gone_m < ahead_m + 2.0 * kStride_m; gone_m += kStride_m) {
    Pose further = at;
    further.position_m[axis] += sign * kStride_m;
    if (rollout_.in_collision(further)) return at;
    at = further;
  }
  return std::nullopt;
}

/// With the tool's origin over the place, from where all of the spread is off the side.
bool TouchTurns::touch(const Turn& turn, const TouchPlace& side, const Push& push,
                       std::vector<Turn>& next) {
  const auto [axis, sign, plain] = push;
  const BeliefSummary from = summarise(turn.belief, task_);
  const auto met = met_at(side, axis, sign);
  if (!met) return false;
  Pose via = *met;
  const Vector6 spread = spread_at(via, turn);
  const double spread_m = spread[axis] + turned_aside_m(spread, part_)[axis];
  via.position_m[axis] -= sign * (spread_m + kFromFace_m);
  const Belief before = moved_to(via, turn.belief, task_);
  const bool collides =
      std::any_of(before.particles.begin(), before.particles.end(),
                  [&](const Particle& particle) { return rollout_.in_collision(particle.tool()); });
  if (collides) return false;

  const double way_m = kFromFace_m + 2.0 * spread_m + task_.step_m;
  if (way_m > longest_move(task_, axis)) return false;
  const Primitive primitive{0, stored(sign * way_m * Vector6::Unit(axis)), plain};
  const auto ahead = succ_.successors(some_of(before), {&primitive, 1});
  if (!ahead.front() || !on_face(*ahead.front(), axis, sign)) return false;
  const auto ends = succ_.successors(before, {&primitive, 1});
  if (!ends.front() || !on_face(*ends.front(), axis, sign)) return false;

  const double left = left_of(*ends.front());
  Turn touched{*ends.front(), turn.contacts, left, turn.passed + left, spread};
  if (left > turn.left - kWorth) return false;
  const BeliefSummary end = summarise(touched.belief, task_);
  if (end.mean.orientation.angularDistance(task_.goal.orientation) > kTurnedMax_rad) return false;
  const double left_m2 = uncertainty(over_goal(touched.belief), metric_of(task_));
  ContactAttractor contact{axis, sign, end.mean, end.spread[axis], left_m2, true, via};
  contact.plain = plain;
  for (int turned = 3; turned < 6; ++turned) {
    if (turned != 3 + axis && from.spread[turned] > enough_[turned] &&
        end.spread[turned] < task_.attractor_ratio * from.spread[turned]) {
      contact.flat |= static_cast<CoordinateMask>(1U << turned);
    }
  }
  touched.contacts.push_back(contact);
  next.push_back(std::move(touched));
  return true;
}

/// The first of them that straight legs lead to and that are not the same touch: such as moves lead
/// to from every start before others, which may do from the tips.
std::vector<TouchTurns::Turn> TouchTurns::best_of(std::vector<Turn> turns) {
  sort(turns);
  std::vector<Turn> kept;
  for (const bool moves_lead : {true, false}) {
    for (Turn& turn : turns) {
      if (kept.size() == kKept || stopped()) break;
      if (turn.contacts.empty()) continue;  // kept
      const ContactAttractor& contact = turn.contacts.back();
      const bool known = std::any_of(kept.begin(), kept.end(), [&](const Turn& other) {
        return same_touch(contact, other.contacts.back());
      });
      if (!known && in_legs(turn) && (!moves_lead || in_moves(turn))) {
        kept.push_back(std::move(turn));
      }
    }
  }
  return kept;
}

/// Legs are asked for the mean and its spread; a touch may be worth much where not every start gets
/// to.
bool TouchTurns::in_moves(const Turn& turn) {
  return can_touch({turn.contacts, {}, 1.0}, task_, start_, clear_, succ_, rollout_);
}

bool TouchTurns::in_legs(const Turn& turn) {
  BeliefSummary clear;
  clear.mean = clear_;
  clear.spread = turn.before;
  return FreeLegs(task_, clear_, rollout_, succ_.reach())
      .to(clear, *turn.contacts.back().via, start_.arm.get())
      .has_value();
}

bool settles(const Guide& guide, const Task& task) {
  return !guide.contacts.empty() &&
         guide.contacts.back().uncertainty_m2 <= task.goal_uncertainty_m2;
}

}  // namespace tenon::planner

#include "planner/search/guide_way.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "planner/belief/belief_summary.h"
#include "planner/belief/primitives.h"
#include "planner/search/free_legs.h"
#include "planner/search/guide_moves.h"
#include "planner/search/heuristics.h"

namespace tenon::planner {
namespace {

// How far a part backs off a face that it has touched, besides its spread.
constexpr double kOff_m = 3e-3;
constexpr int kLabel = 0;

class Walk {
 public:
  Walk(const Task& task, const Belief& start, const Pose& clear, SuccessorEngine& succ,
       Rollout& rollout)
      : task_(task), clear_(clear), succ_(succ), legs_(task, clear, rollout), belief_(start) {}

  [[nodiscard]] BeliefSummary here() const { return summarise(belief_, task_); }

  /// Touches what the guide says.
  bool touch(const ContactAttractor& contact) {
    if (contact.via && !(back_off() && go(*contact.via))) return false;
    const BeliefSummary from = here();
    const double beyond =
        contact.sign * displacement_between(from.mean, contact.mean)[contact.axis];
    const double step = contact.axis < 3 ? task_.step_m : task_.step_rad;
    const double way = std::max(0.0, beyond) + from.spread[contact.axis] + step;
    if (way > longest_move(task_, contact.axis)) return false;
    return move(contact.sign * way * Vector6::Unit(contact.axis));
  }

  /// Over the goal, then along one axis into it.
  bool enter(int axis) {
    if (!back_off()) return false;
    Pose over = task_.goal;
    over.position_m[axis] = clear_.position_m[axis];
    if (!go(over)) return false;
    Pose in = here().mean;
    in.position_m[axis] = task_.goal.position_m[axis];
    return move_to(in) && at_goal(here(), task_);
  }

  /// For a second try.
  struct Mark {
    Belief belief;
    std::size_t moves = 0;
    std::vector<Pose> waypoints;
  };
  [[nodiscard]] Mark mark() const { return {belief_, moves_.size(), waypoints_}; }
  void return_to(const Mark& mark) {
    belief_ = mark.belief;
    moves_.resize(mark.moves);
    waypoints_ = mark.waypoints;
  }

  [[nodiscard]] std::vector<Vector6> take() { return std::move(moves_); }

 private:
  /// Away from what is touched.
  bool back_off() {
    Vector6 off = Vector6::Zero();
    const Vector6 spread = here().spread;
    for (int axis = 0; axis < 3; ++axis) {
      for (const Particle& particle : belief_.particles) {
        const int sign = particle.signature.sign(axis);
        if (sign != 0) off[axis] = sign * (kOff_m + spread[axis]);
      }
    }
    return off.isZero() || move(off);
  }

  /// Through free space; where nothing leads there from here, back on the way here until it does.
  bool go(const Pose& place) {
    auto legs = legs_.to(here(), place);
    while (!legs && !waypoints_.empty()) {
      const Pose before = waypoints_.back();
      waypoints_.pop_back();
      if (!move_to(before)) return false;
      legs = legs_.to(here(), place);
    }
    if (!legs) return false;
    waypoints_.push_back(here().mean);
    for (const Vector6& leg : *legs) {
      if (!move(in_move_axes(task_, here().mean, leg))) return false;
      waypoints_.push_back(here().mean);
    }
    return true;
  }

  bool move_to(const Pose& place) {
    const Pose mean = here().mean;
    return move(in_move_axes(task_, mean, displacement_between(mean, place)));
  }

  bool move(Vector6 way) {
    for (int axis = 0; axis < 6; ++axis) {
      if (!has(task_.coordinates, axis)) way[axis] = 0.0;
    }
    const Primitive primitive{kLabel, stored(way)};
    if (primitive.displacement.isZero()) return true;
    auto ends = succ_.successors(belief_, {&primitive, 1});
    if (!ends.front()) return false;
    belief_ = std::move(*ends.front());
    moves_.push_back(primitive.displacement);
    return true;
  }

  const Task& task_;
  Pose clear_;
  SuccessorEngine& succ_;
  FreeLegs legs_;
  Belief belief_;
  std::vector<Vector6> moves_;
  std::vector<Pose> waypoints_;  ///< of the mean, all free: where legs have begun and ended
};

/// Translations, the longest way from a place that is clear first.
std::array<int, 3> by_way(const Pose& clear, const Pose& goal) {
  const Vector3 way_m = (goal.position_m - clear.position_m).cwiseAbs();
  std::array<int, 3> axes = {2, 1, 0};
  std::stable_sort(axes.begin(), axes.end(), [&](int a, int b) { return way_m[a] > way_m[b]; });
  return axes;
}

}  // namespace

std::optional<std::vector<Vector6>> follow_guide(const Guide& guide, const Task& task,
                                                 const Belief& start, const Pose& clear,
                                                 SuccessorEngine& succ, Rollout& rollout) {
  Walk walk(task, start, clear, succ, rollout);
  for (const bool again : {false, true}) {
    for (const ContactAttractor& contact : guide.contacts) {
      if (!again && is_behind(walk.here(), contact, task)) continue;
      if (!walk.touch(contact)) return std::nullopt;
    }
    const Walk::Mark touched = walk.mark();
    for (const int axis : by_way(clear, task.goal)) {
      if (!has(task.coordinates, axis)) continue;
      if (walk.enter(axis)) return walk.take();
      walk.return_to(touched);
    }
  }
  return std::nullopt;
}

}  // namespace tenon::planner

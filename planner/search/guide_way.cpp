#include "planner/search/guide_way.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <string>

#include "planner/belief/belief_summary.h"
#include "planner/belief/primitives.h"
#include "planner/search/free_legs.h"
#include "planner/search/guide_moves.h"
#include "planner/search/heuristics.h"
#include "planner/search/placing.h"

namespace tenon::planner {
namespace {

// How far a part backs off a face that it has touched, besides its spread.
constexpr double kOff_m = 3e-3;
// What of a move along one axis nobody could measure, m or rad.
constexpr double kNothing = 1e-5;
constexpr int kLabel = 0;
// A turned part may meet the mouth's side on the way in, and slides on.
constexpr int kEnteringMax = 3;
// With more uncertainty than so many times the goal's it is not worth a try.
constexpr double kNearlyCertain = 4.0;

/// Translations, the longest way from a place that is clear first.
std::array<int, 3> by_way(const Pose& clear, const Pose& goal) {
  const Vector3 way_m = (goal.position_m - clear.position_m).cwiseAbs();
  std::array<int, 3> axes = {2, 1, 0};
  std::stable_sort(axes.begin(), axes.end(), [&](int a, int b) { return way_m[a] > way_m[b]; });
  return axes;
}

class Walk {
 public:
  Walk(const Task& task, const Belief& start, const Pose& clear, SuccessorEngine& succ,
       Rollout& rollout)
      : task_(task),
        part_(around(task.held)),
        clear_(clear),
        succ_(succ),
        legs_(task, clear, rollout, succ.reach()),
        belief_(start) {}

  [[nodiscard]] BeliefSummary here() const { return summarise(belief_, task_); }

  /// Touches what the guide says.
  bool touch(const ContactAttractor& contact) {
    if (contact.via && !(back_off() && go(*contact.via))) return false;
    const BeliefSummary from = here();
    const double beyond =
        contact.sign * displacement_between(from.mean, contact.mean)[contact.axis];
    const double step = contact.axis < 3 ? task_.step_m : task_.step_rad;
    const double way = std::max(0.0, beyond) + from.spread[contact.axis] + step;
    if (way > longest_move(task_, contact.axis)) return stuck("the push would last too long");
    return move(contact.sign * way * Vector6::Unit(contact.axis), contact.plain);
  }

  /// Over the goal, then along one axis into it.
  bool enter(int axis) {
    if (!back_off()) return false;
    Pose over = task_.goal;
    over.position_m[axis] = clear_.position_m[axis];
    if (!go(over)) return false;
    Pose in;
    for (int moves = 0; moves < (turned() ? kEnteringMax : 1); ++moves) {
      in = here().mean;
      in.position_m[axis] = task_.goal.position_m[axis];
      if (!move_to(in)) return false;
      if (at_goal(here(), task_)) return true;
    }
    return stuck("the part does not go in");
  }

  /// What would be uncertain at the goal.
  [[nodiscard]] double left_m2() const {
    return summarise(moved_to(task_.goal, belief_, task_), task_).uncertainty_m2;
  }

  /// Over the goal along the longest way there first. @return whether one of them leads in
  bool arrive() {
    if (turned() && left_m2() > kNearlyCertain * task_.goal_uncertainty_m2) {
      return stuck("more is uncertain than the goal takes");
    }
    const Mark touched = mark();
    for (const int axis : by_way(clear_, task_.goal)) {
      if (!has(task_.coordinates, axis)) continue;
      if (enter(axis)) return true;
      return_to(touched);
      if (turned()) return false;
    }
    return false;
  }

  /// Rotations are among what is uncertain: who touches the one face may turn off the other.
  [[nodiscard]] bool turned() const { return task_.motion.carried_axes; }

  /// For a second try.
  struct Mark {
    Belief belief;
    GuideWay way;
    std::vector<Pose> waypoints;
  };
  [[nodiscard]] Mark mark() const { return {belief_, way_, waypoints_}; }
  void return_to(const Mark& mark) {
    belief_ = mark.belief;
    way_ = mark.way;
    waypoints_ = mark.waypoints;
  }

  [[nodiscard]] GuideWay take() { return std::move(way_); }

  /// Of what failed last.
  [[nodiscard]] const std::string& why() const { return why_; }

 private:
  bool stuck(const char* why) {
    why_ = why;
    return false;
  }

  /// Away from what is touched.
  bool back_off() {
    Vector6 off = Vector6::Zero();
    const Vector6 spread = here().spread;
    const Vector3 aside_m = turned_aside_m(spread, part_);
    for (int axis = 0; axis < 3; ++axis) {
      for (const Particle& particle : belief_.particles) {
        const int sign = particle.signature.sign(axis);
        if (sign != 0) off[axis] = sign * (kOff_m + spread[axis] + aside_m[axis]);
      }
    }
    return off.isZero() || move(off);
  }

  /// Through free space; where nothing leads there from here, back on the way here until it does.
  bool go(const Pose& place) {
    auto legs = legs_.to(here(), place, belief_.arm.get());
    while (!legs && !waypoints_.empty()) {
      const Pose before = waypoints_.back();
      waypoints_.pop_back();
      if (!move_to(before)) return false;
      legs = legs_.to(here(), place, belief_.arm.get());
    }
    if (!legs) return stuck("no straight legs lead there");
    waypoints_.push_back(here().mean);
    for (const Vector6& leg : *legs) {
      const bool last = &leg == &legs->back();
      if (!(last ? move_to(place) : move(in_move_axes(task_, here().mean, leg)))) return false;
      waypoints_.push_back(here().mean);
    }
    return true;
  }

  bool move_to(const Pose& place) { return move(aimed(place, belief_, task_)); }

  bool move(Vector6 way, bool plain = false) {
    for (int axis = 0; axis < 6; ++axis) {
      const bool told = has(moved_axes(task_), axis) && std::abs(way[axis]) > kNothing;
      if (!told) way[axis] = 0.0;
    }
    const Primitive primitive{kLabel, stored(way), plain};
    if (primitive.displacement.isZero()) return true;
    auto ends = succ_.successors(belief_, {&primitive, 1});
    if (!ends.front()) return stuck("a start fails in a move, or rests at an edge");
    belief_ = std::move(*ends.front());
    if (plain) way_.plain.push_back(way_.moves.size());
    way_.moves.push_back(primitive.displacement);
    return true;
  }

  const Task& task_;
  Eigen::AlignedBox3d part_;
  Pose clear_;
  SuccessorEngine& succ_;
  FreeLegs legs_;
  Belief belief_;
  GuideWay way_;
  std::vector<Pose> waypoints_;  ///< of the mean, all free: where legs have begun and ended
  std::string why_;
};

/// What was met while another coordinate was uncertain tells more when it is met once more: of all
/// touches each time the one that leads to the goal, else the one that leaves the least uncertain.
bool touched_again(Walk& walk, const Guide& guide) {
  for (std::size_t round = 0; round < guide.contacts.size(); ++round) {
    const Walk::Mark before = walk.mark();
    std::optional<Walk::Mark> best;
    double least_m2 = walk.left_m2();
    for (const ContactAttractor& contact : guide.contacts) {
      walk.return_to(before);
      if (!walk.touch(contact)) continue;
      if (walk.left_m2() < least_m2) {
        least_m2 = walk.left_m2();
        best = walk.mark();
      }
      if (walk.arrive()) return true;
    }
    if (!best) return false;
    walk.return_to(*best);
  }
  return false;
}

}  // namespace

bool can_touch(const Guide& guide, const Task& task, const Belief& start, const Pose& clear,
               SuccessorEngine& succ, Rollout& rollout) {
  Walk walk(task, start, clear, succ, rollout);
  return std::all_of(guide.contacts.begin(), guide.contacts.end(),
                     [&](const ContactAttractor& contact) { return walk.touch(contact); });
}

std::optional<GuideWay> follow_guide(const Guide& guide, const Task& task, const Belief& start,
                                     const Pose& clear, SuccessorEngine& succ, Rollout& rollout,
                                     std::string* left) {
  Walk walk(task, start, clear, succ, rollout);
  const bool turned = walk.turned();
  const auto leave = [&](const std::string& where) {
    if (left != nullptr) *left = where + ": " + walk.why();
    return std::nullopt;
  };
  for (std::size_t i = 0; i < guide.contacts.size(); ++i) {
    if (!turned && is_behind(walk.here(), guide.contacts[i], task)) continue;
    if (!walk.touch(guide.contacts[i])) return leave("its touch " + std::to_string(i + 1));
  }
  if (walk.arrive()) return walk.take();
  if (turned) {
    if (touched_again(walk, guide)) return walk.take();
  } else {
    for (std::size_t i = 0; i < guide.contacts.size(); ++i) {
      if (!walk.touch(guide.contacts[i])) {
        return leave("its touch " + std::to_string(i + 1) + ", made again");
      }
    }
    if (walk.arrive()) return walk.take();
  }
  return leave("the goal");
}

}  // namespace tenon::planner

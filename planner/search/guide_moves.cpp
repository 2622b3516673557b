#include "planner/search/guide_moves.h"

#include <algorithm>
#include <cmath>

#include "planner/search/heuristics.h"
#include "shared/motion/path_limits.h"

namespace tenon::planner {
namespace {

// Shorter moves change nothing that anybody could measure.
constexpr double kNoMove = 1e-4;
// The ramps of a move and its settling take so much of its time limit.
constexpr double kOfTimeout = 0.8;

/// In path units.
double longest(const Task& task, const Vector6& displacement) {
  return kOfTimeout * 1e-6 * task.motion.timeout_us *
         path_limits(displacement, task.motion.speeds).contact_speed;
}

class Suggestions {
 public:
  Suggestions(const Task& task, const BeliefSummary& belief) : task_(task), belief_(belief) {}

  /// Along every axis alone to a place's coordinate; and at once along all but one of them.
  void to(const Pose& place, int left_out) {
    Vector6 way = in_move_axes(task_, belief_.mean, displacement_between(belief_.mean, place));
    for (int axis = 0; axis < 6; ++axis) {
      if (!has(moved_axes(task_), axis)) way[axis] = 0.0;
    }
    for (int axis = 0; axis < 6; ++axis) add(way[axis] * Vector6::Unit(axis));
    if (left_out >= 0) way[left_out] = 0.0;
    add(way);
  }

  void push(const ContactAttractor& contact) {
    const double beyond = displacement_between(belief_.mean, contact.mean)[contact.axis];
    // The mean meets the face there; who is last has the spread to go besides, and a step in hand.
    const double way = std::max(0.0, contact.sign * beyond) + belief_.spread[contact.axis] +
                       (contact.axis < 3 ? task_.step_m : task_.step_rad);
    add(contact.sign * way * Vector6::Unit(contact.axis));
  }

  [[nodiscard]] std::vector<Primitive> take() { return std::move(moves_); }

 private:
  void add(const Vector6& way) {
    const Vector6 displacement = stored(way);
    if (displacement.cwiseAbs().maxCoeff() < kNoMove) return;
    if (path_length(displacement) > longest(task_, displacement)) return;
    const auto same = [&](const Primitive& other) {
      return (other.displacement - displacement).cwiseAbs().maxCoeff() < kNoMove;
    };
    if (std::any_of(moves_.begin(), moves_.end(), same)) return;
    moves_.push_back({kGuideLabel + static_cast<int>(moves_.size()), displacement});
  }

  const Task& task_;
  const BeliefSummary& belief_;
  std::vector<Primitive> moves_;
};

}  // namespace

double longest_move(const Task& task, int axis) { return longest(task, Vector6::Unit(axis)); }

std::vector<Primitive> guide_moves(const Task& task, const BeliefSummary& belief,
                                   const std::vector<Guide>& guides) {
  Suggestions suggestions(task, belief);
  for (const Guide& guide : guides) {
    const auto next =
        std::find_if(guide.contacts.begin(), guide.contacts.end(),
                     [&](const ContactAttractor& c) { return !is_behind(belief, c, task); });
    if (next != guide.contacts.end()) {
      if (next->via) suggestions.to(*next->via, next->axis);
      suggestions.push(*next);
    } else {
      for (const Pose& goal : guide.goals) {
        for (int axis = 0; axis < 3; ++axis) suggestions.to(goal, axis);
      }
    }
  }
  return suggestions.take();
}

}  // namespace tenon::planner

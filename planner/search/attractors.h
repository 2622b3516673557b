#pragma once
// Where uncertainty shrinks: beliefs after long pushes, found with a few dozen rollouts, and the
// guides that lead from one to the next.

#include <functional>
#include <vector>

#include "planner/belief/successor.h"
#include "planner/search/heuristics.h"
#include "shared/task/task.h"

namespace tenon::planner {

inline constexpr std::size_t kCandidatesMax = 24;

struct Attractors {
  std::vector<Guide> guides;
  /// What they were chosen from, the most promising first and at most kCandidatesMax.
  std::vector<Guide> candidates;
  /// Goal attractors, which the search may move to straight: the goal, and the mouth of a hole.
  std::vector<Pose> goals;
  /// Uncertain coordinates along which no guide has a contact: nothing that was pushed against
  /// tells where the part is along them.
  CoordinateMask unsettled = 0;
  /// Faces touched one after the other, found so: to be followed to the letter. Those of them that
  /// lead to the goal's certainty are the guides.
  std::vector<Guide> turns;
};

/// Long pushes along one search axis after the other, from the start and with the start's spread
/// about the goal. A push is a contact attractor where the particles then stand within c_u times
/// their spread before it. Where these leave more than the goal's uncertainty, pushes from drawn
/// places near the environment (`attractor_samples` of them) are added; before those, where the
/// task has guide_moves, one against each side of each shape (touch_places.h); where
/// no straight legs lead to any along an axis, those once more with what is left of the spread when
/// the other axes are settled; and where the task's tilt would put off what they tell on the way to
/// the goal's mouth (tilt_offset.h), those once more with the part over a rim of the side. Guides
/// are the cheapest sequences of contacts that leave no more than the goal's uncertainty (or the
/// most certain ones, where none does), those first to which straight legs lead, faces before edges
/// and what a tilt puts off least first where the task has guide_moves; and the
/// cheapest of them once more by way of the mouth: outside of the place where a tool drawn straight
/// out of the goal along a contact loses it.
/// @param succ with moves at approach speed and time for long ones
/// @param rollout asked for collisions only
/// @param stop asked before every push where not empty; true leaves it at what has been found
/// @param in_turn where not empty: asked for guides (touch_turns.h) where rotations are uncertain
/// and pushes from the start and about the goal do not settle every axis; the others are looked for
/// where it has none
[[nodiscard]] Attractors find_attractors(const Task& task, const Belief& start,
                                         SuccessorEngine& succ, Rollout& rollout,
                                         const std::function<bool()>& stop = {},
                                         const std::function<std::vector<Guide>()>& in_turn = {});

}  // namespace tenon::planner

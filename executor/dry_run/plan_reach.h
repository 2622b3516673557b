#pragma once
// Where a plan's tool can be, as boxes of displacements from the plan's start: every step's box
// grows out of its predecessors' by the envelopes that validation saw, or is where validation saw
// it, in a plan that says so. Set-up code; allocates.

#include <cstdint>
#include <optional>
#include <vector>

#include "shared/plan/plan.h"

namespace tenon::executor {

/// Displacements from the plan's start, m and rad, task axes.
struct ReachBox {
  Vector6 low = Vector6::Zero();
  Vector6 high = Vector6::Zero();

  void include(const ReachBox& other) {
    low = low.cwiseMin(other.low);
    high = high.cwiseMax(other.high);
  }
  [[nodiscard]] ReachBox moved(const Vector6& least, const Vector6& most) const {
    return {low + least, high + most};
  }
  [[nodiscard]] Vector6 centre() const { return 0.5 * (low + high); }
  /// The corner that is high on the axes of a bit pattern and low on the others.
  [[nodiscard]] Vector6 corner(unsigned pattern) const {
    Vector6 corner = low;
    for (int axis = 0; axis < 6; ++axis) {
      if ((pattern >> axis & 1U) != 0) corner[axis] = high[axis];
    }
    return corner;
  }
  /// Axes along which the box has an extent.
  [[nodiscard]] unsigned extent() const {
    unsigned axes = 0;
    for (int axis = 0; axis < 6; ++axis) axes |= (high[axis] > low[axis] ? 1U : 0U) << axis;
    return axes;
  }
};

struct StepReach {
  ReachBox begin;
  struct End {
    Successor successor = kSuccessorFail;
    ReachBox box;
    ContactSignature contacts;  ///< that the tool may hold there
  };
  std::vector<End> ends;    ///< of every outcome that has a way on
  ReachBox swept;           ///< around begin and ends
  ContactSignature before;  ///< contacts that the tool may hold as the step begins
};

/// Of one step of a plan's kind. @param before contacts that the tool may hold as it begins
[[nodiscard]] StepReach reach_from(const ReachBox& begin, ContactSignature before, const Plan& plan,
                                   const Step& step);

/// By step; empty where no way leads there. A plan without envelopes can end anywhere along its
/// commands.
[[nodiscard]] std::vector<std::optional<StepReach>> reach_of(const Plan& plan);

/// Where the ways that the plan calls done can end; empty where it has none.
[[nodiscard]] std::optional<ReachBox> done_reach(const Plan& plan);

/// An axis on which the tool and the plan's goal are further apart than the plan's steps account
/// for.
struct GoalGap {
  int axis = 0;
  double tool = 0.0;   ///< task frame, m; of a rotation, rad from the plan's start
  double goal = 0.0;   ///< the same
  double bound = 0.0;  ///< that both would have to be within
};

/// Held against the goal by what encoders tell: how far off the environment is, they do not; but
/// goal and end must both lie where the plan's ways end.
/// @param reach done_reach(plan)  @param tool as it stands at the end, task frame
/// @param slack_m, slack_rad by which the tool may have stood beside the plan's start
/// @return the worst axis; beside the plan's coordinates goal and end are the start's. Empty where
/// all is well, or the plan has no goal tolerance, and so no goal
[[nodiscard]] std::optional<GoalGap> goal_gap(const Plan& plan, const ReachBox& reach,
                                              const Pose& tool, double slack_m, double slack_rad);

}  // namespace tenon::executor

#pragma once
// Ways through free space, for a tool of which only the spread about its mean is known. Asks for
// collisions, simulates nothing. One thread.

#include <Eigen/Geometry>
#include <optional>
#include <vector>

#include "planner/belief/belief_summary.h"
#include "planner/belief/move_reach.h"
#include "planner/search/placing.h"
#include "shared/ports/rollout.h"
#include "shared/task/task.h"

namespace tenon::planner {

class FreeLegs {
 public:
  /// @param clear a pose known to be free, above or beside everything: detours go by its
  /// coordinates  @param reach where not null: what the arm cannot do is no leg
  FreeLegs(const Task& task, const Pose& clear, Rollout& rollout, MoveReach* reach = nullptr)
      : task_(task), part_(around(task.held)), clear_(clear), rollout_(rollout), reach_(reach) {}

  /// At most four straight legs from the belief's mean to a place, task axes, m and rad, of which
  /// none brings any corner of the spread into a collision; as few as there are, then as short. All
  /// turning is done on the first. What turns may add to a corner counts as way to it. Empty: none
  /// lead there.
  /// @param arm where it may be with the belief; null: no arm is asked
  [[nodiscard]] std::optional<std::vector<Vector6>> to(const BeliefSummary& belief,
                                                       const Pose& place,
                                                       const ArmPlace* arm = nullptr);

 private:
  using Legs = std::vector<Vector6>;

  [[nodiscard]] std::vector<Legs> candidates(const Vector6& way, const Pose& from) const;
  [[nodiscard]] bool free(const BeliefSummary& belief, const Legs& legs, const Vector3& half_m);
  [[nodiscard]] bool in_reach(const BeliefSummary& belief, const Legs& legs, const ArmPlace* arm);
  [[nodiscard]] bool free_at(const Pose& mean, const Vector3& half_m);

  const Task& task_;
  Eigen::AlignedBox3d part_;
  Pose clear_;
  Rollout& rollout_;
  MoveReach* reach_;
};

}  // namespace tenon::planner

#pragma once
// One step of a plan walked through by an arm in mind: everywhere that the tool can come, with
// joints that move continuously. Set-up code; allocates.
//
// The grid: from the middle of the box in which the step begins to its corners, from there along
// the move to the corners of the box in which each outcome ends, and along all edges of the box
// around both, at PathFollower's spacing. At a corner that two ways lead to, both must give the
// same joints: else the box holds a singularity, whatever the grid saw.

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "executor/dry_run/path_follower.h"
#include "executor/dry_run/plan_reach.h"
#include "shared/cell/cell.h"
#include "shared/joint_torque/torque_map.h"
#include "shared/plan/plan.h"

namespace tenon::executor {

/// A joint and a number that says how near it is to its bound.
struct JointExtreme {
  int joint = 0;
  double value = 0.0;
};

/// What a step asks of the arm at its worst points.
struct StepDemand {
  std::size_t step = 0;
  int points = 0;               ///< tool poses that were solved
  JointExtreme limit{0, 1e9};   ///< distance to a joint limit where the joint has come to rest out
                                ///< of contact speed, m or rad
  double limit_position = 0.0;  ///< of that joint, before it stops
  JointExtreme speed;           ///< share of the joint's speed_max at the plan's own speeds
  JointExtreme acceleration;    ///< share of its acceleration_max
  double conditioning = 1.0;    ///< ToolKinematics::conditioning(), smallest
  /// Where the joints' efforts tell the force: what they resolve of it, N and Nm, task axes, at the
  /// worst point; else 0.
  Vector6 resolution = Vector6::Zero();
  /// What the plan's speeds are multiplied by (slow_down.h), so that no joint is asked for more
  /// than kShareMax of its own.
  double slow_down = 1.0;
};

/// "joint arm_5 is asked for 2.31 rad/s, its limit is 1.26": what makes the slow-down.
[[nodiscard]] std::string asked_for(const StepDemand& demand, const Cell& cell);

class StepWalk {
 public:
  /// What compliance moves on its own, and rounding, have the rest.
  static constexpr double kShareMax = 0.9;
  /// A step that would have to be slower than this is refused.
  static constexpr double kSlowDownMin = 0.2;
  /// Poses nearer to a singularity are refused.
  static constexpr double kConditioningMin = 0.01;

  /// All outlive this.
  StepWalk(const Plan& plan, std::size_t step, const StepReach& reach, const Cell& cell,
           const ToolKinematics& kinematics);

  /// @param middle joints at the centre of reach.begin
  /// @return why the arm cannot do this step: joint and numbers
  [[nodiscard]] std::optional<std::string> run(const JointVector& middle);

  [[nodiscard]] const StepDemand& demand() const { return demand_; }
  /// Joints at the centre of reach.ends[i].box.
  [[nodiscard]] const JointVector& end(std::size_t i) const { return ends_[i]; }

 private:
  // A way that the command can take: GuardedMove drops what would push into a held contact.
  struct Way {
    Vector6 along = Vector6::Zero();  ///< a unit of path
    double fast = 0.0;                ///< path units a second
    double slow = 0.0;
    double acceleration = 0.0;
  };
  struct Moving {
    JointVector position{};
    JointVector velocity{};  ///< at contact speed
  };

  void find_ways();
  void visit(const JointVector& joints);
  void look_at_rates(const JointVector& joints, const Way& way);
  void look_at_limits();
  [[nodiscard]] bool walk_moves(const JointVector& middle);
  [[nodiscard]] bool walk_edges(const JointVector& middle);
  bool follow(const Vector6& from, const Vector6& to, JointVector& joints);
  [[nodiscard]] std::optional<std::string> verdict(bool walked) const;
  [[nodiscard]] std::string lost_way() const;
  [[nodiscard]] std::string too_close() const;
  [[nodiscard]] std::string too_fast() const;
  [[nodiscard]] std::optional<std::string> too_coarse() const;
  [[nodiscard]] const Joint& joint(int index) const {
    return cell_.robot.joints[static_cast<std::size_t>(index)];
  }

  const Step& step_;
  const ParameterSet& set_;
  const StepReach& reach_;
  const Cell& cell_;
  const ToolKinematics& kinematics_;
  PathFollower follower_;
  std::optional<TorqueMap> torque_map_;  ///< where the joints' efforts tell the force
  PathFollower::Failure failure_;
  std::vector<Way> ways_;
  std::vector<Moving> visited_;
  std::vector<JointVector> ends_;
  std::uint8_t compliant_axes_;
  StepDemand demand_;
};

}  // namespace tenon::executor

#pragma once
// The task that runs a plan: approaching its start, running it, ramping down where it is stopped on
// the way. A stop on request ramps the tool down with bounded jerk and stays compliant; where the
// tool has no way on (reach, a joint's limit or speed) and on the way to the start the joints ramp
// down; a force fault or a fault of the arm leaves the ramp to the drives.
//
// Real-time but for the constructor: no allocation, no lock, no throw. One thread.

#include <atomic>
#include <cstdint>
#include <optional>

#include "executor/dry_run/dry_run.h"
#include "executor/dry_run/plan_reach.h"
#include "executor/loop/control_task.h"
#include "executor/motion/commanded_tool.h"
#include "executor/motion/joint_move.h"
#include "executor/motion/pace.h"
#include "executor/motion/plan_runner.h"
#include "executor/motion/stop_profile.h"
#include "executor/sensing/free_air_zero.h"
#include "executor/sensing/zero_watch.h"
#include "shared/cell/cell.h"
#include "shared/plan/plan.h"

namespace tenon::executor {

class Controller : public ControlTask {
 public:
  struct Parameters : ControlTask::Parameters {
    bool go_to_start = false;
    bool step_by_step = false;  ///< every step waits for allow_step()
    double start_tolerance_m = 2e-3;
    double start_tolerance_rad = 0.02;
    double start_tolerance_joint = 0.3;  ///< m or rad; more is another branch of the arm
  };

  /// Copies cell and plan, as the dry run slowed it; look at its refusals and at check_plan()
  /// first.
  /// @throws InputError for a robot without joints or a plan without steps.
  Controller(const Cell& cell, const DryRun& dry_run, const Parameters& parameters);
  /// The same after a dry run of its own.
  Controller(const Cell& cell, const Plan& plan, const Parameters& parameters)
      : Controller(cell, dry_run(plan, cell), parameters) {}

  /// The step that waits may begin; what is said while none waits is forgotten. Any thread.
  void allow_step() noexcept { allowed_.store(true, std::memory_order_relaxed); }

  /// The move under way comes to rest by its own speed, along its own way, and stays compliant and
  /// watched; or goes on. Its time stands meanwhile, so that no time limit passes. In other states
  /// than kRunning nothing is paused. Any thread.
  void pause(bool paused) noexcept { paused_.store(paused, std::memory_order_relaxed); }

  [[nodiscard]] const PlanRunner& runner() const noexcept { return runner_; }
  /// What is executed: the dry run's.
  [[nodiscard]] const Plan& plan() const noexcept { return plan_; }

 private:
  [[nodiscard]] Turn on_enter(State state) override;
  [[nodiscard]] Turn approach() override;
  [[nodiscard]] Turn run(const ArmFeedback& feedback) override;
  [[nodiscard]] Turn ramp_down() override;
  [[nodiscard]] Turn hold() override;
  [[nodiscard]] std::optional<Ending> seen_in_brakes() override;
  void on_ending(const Ending& ending) override;
  [[nodiscard]] std::optional<Ending> command_joints() override;
  [[nodiscard]] Vector6 complete_motion() override;
  void write_motion(CycleRecord& record) override;

  [[nodiscard]] Turn start_approach();
  [[nodiscard]] bool waits_for_the_user() noexcept;
  void pass_time();
  void follow_zero();
  [[nodiscard]] Turn wait_at_rest();
  void leave_the_tool();
  void yield_here();

  [[nodiscard]] const ParameterSet& parameters_of_step() const {
    return plan_.parameter_sets[plan_.steps[runner_.step()].parameter_set];
  }
  [[nodiscard]] std::optional<Ending> off_start() const;
  [[nodiscard]] Ending done() const;
  [[nodiscard]] std::optional<Ending> off_command(double share) const;
  [[nodiscard]] std::optional<Ending> watch_hold();
  [[nodiscard]] double on_threshold(int axis) const;
  [[nodiscard]] int touching_axis(std::uint8_t axes) const;

  Plan plan_;
  std::optional<JointVector> start_;  ///< joints, as the dry run found them
  std::optional<ReachBox> done_reach_;
  Parameters parameters_;
  CommandedTool tool_;
  PlanRunner runner_;

  std::atomic<bool> allowed_{false};
  std::atomic<bool> paused_{false};
  Pace pace_;
  std::int64_t move_ns_ = 0;  ///< the moves' own time
  bool waits_ = false;        ///< with the tool at rest, as compliant as ever, for allow_step()

  int touch_samples_ = 0;
  GuardedMove::Setpoint setpoint_;
  GuardedMove::Phase phase_ = GuardedMove::Phase::kDone;
  std::optional<Pose> seen_;  ///< by the guarded move in this cycle
  JointMove approach_;
  StopProfile stop_;
  ZeroWatch zero_watch_;  ///< at the plan's end
  FreeAirZero free_zero_;
  bool zero_told_ = false;
  int unheld_cycles_ = 0;  ///< in a row, at the plan's end
  bool unheld_told_ = false;
  bool tool_left_ = false;  ///< the joints ramp down or hold by themselves
  Pose commanded_;          ///< tool pose behind the commanded joints
};

}  // namespace tenon::executor

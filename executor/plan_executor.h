#pragma once
// The way in for a library user: a plan and feedback in, setpoints out.
//
//   PlanExecutor executor(plan, {.cycle_s = 0.002});
//   while (executor.update(input, output) == PlanExecutor::Result::kRunning) { ... }
//
// It walks the plan's guarded moves, ends each by what is measured, goes on by its outcome, and
// applies the plan's admittance law. It is the core that tenon-exec runs (motion/plan_runner.h,
// motion/commanded_tool.h), without what makes an arm of it: it knows neither joints nor cell, so
// bounds on force, speed and reach, the taring and the payload of the sensor, the way to the start
// and every stop are the caller's. For a whole arm behind the arm port take loop/controller.h; to
// hold a plan against a cell beforehand, dry_run/dry_run.h and dry_run/plan_check.h.
//
// No thread, no clock, no bus: one cycle is one update(). One thread at a time.

#include <cstddef>
#include <cstdint>

#include "executor/motion/commanded_tool.h"
#include "executor/motion/plan_runner.h"
#include "shared/math/pose.h"
#include "shared/motion/setpoint.h"
#include "shared/plan/plan.h"

namespace tenon::executor {

class PlanExecutor {
 public:
  struct Parameters {
    double cycle_s = 0.002;  ///< from one update() to the next, > 0; a plan names its latency_max_s
  };

  /// What is measured in this cycle.
  struct Input {
    Pose tool;                         ///< tip of the held part, in the task frame
    Vector6 wrench = Vector6::Zero();  ///< of the environment on the tool alone (tared, without the
                                       ///< payload), task axes at the tip, N and Nm
    bool wrench_fresh = true;          ///< a new sample; else `wrench` is the last one again
  };

  /// What to command in this cycle. Poses are in the task frame.
  struct Output {
    Pose tool;                           ///< for position-controlled drives: the law applied
    Vector6 velocity = Vector6::Zero();  ///< of that pose, task axes, m/s and rad/s
    Setpoint setpoint;                   ///< for an arm that realises the plan's compliance itself
    std::size_t step = 0;                ///< of the plan
    const StepReport* finished = nullptr;  ///< the step that ended in this cycle; else null
  };

  /// kRunning: go on. kDone: the plan says done. kFailed: it has no way on, or a step ended where
  /// validation never did; the last report's transition says which.
  using Result = PlanRunner::Status;

  /// Copies the plan; allocates. @param plan as decode_plan() or load_plan() give it
  /// @throws InputError for a plan without steps
  PlanExecutor(const Plan& plan, const Parameters& parameters);
  PlanExecutor(const PlanExecutor&) = delete;
  PlanExecutor& operator=(const PlanExecutor&) = delete;

  /// One cycle. Real-time: no allocation, no lock, no throw; bounded work. Before the first call
  /// the tool rests at plan().start and touches nothing; that is not checked. Once it is over, goes
  /// on to hold the last setpoint, compliant.
  [[nodiscard]] Result update(const Input& input, Output& output) noexcept;

  [[nodiscard]] const Plan& plan() const noexcept { return plan_; }
  /// All steps that have ended, in their order: report_count(), report(i).
  [[nodiscard]] const PlanRunner& runner() const noexcept { return runner_; }

 private:
  Plan plan_;
  double cycle_s_;
  std::int64_t cycle_ns_;
  std::int64_t time_ns_ = 0;
  PlanRunner runner_;
  CommandedTool tool_;
};

}  // namespace tenon::executor

#include "sim/main_evaluate_chain.h"

#include <cstdint>
#include <cstdio>
#include <optional>
#include <utility>
#include <vector>

#include "executor/controller.h"
#include "executor/cycle_runner.h"
#include "executor/dry_run/dry_run.h"
#include "executor/plan_check.h"
#include "executor/telemetry/run_result.h"
#include "hw/canopen_arm.h"
#include "hw/describe_fault.h"
#include "shared/base/error.h"
#include "shared/base/text.h"
#include "shared/task/inserted.h"
#include "sim/lockstep/lockstep.h"
#include "sim/lockstep/virtual_link.h"
#include "sim/virtual_arm/start_joints.h"
#include "sim/virtual_arm/virtual_cell.h"

namespace tenon {

struct PreparedPlan {
  const Cell& cell;
  const Task& task;
  const sim::Candidate& candidate;
  executor::DryRun dry_run;
  JointVector joints{};  ///< where the arm stands at first
};

namespace {

/// What is kept of the cycles of a run that is told.
constexpr double kToldCycles_s = 60.0;

sim::VirtualCell::Options world_of(const sim::Candidate& candidate, const JointVector& joints,
                                   const sim::Trial& trial) {
  sim::VirtualCell::Options options;
  options.start = candidate.start.name;
  options.seed = trial.seed;
  options.offset = trial.offset;
  options.world = trial.world;
  options.joints = joints;
  return options;
}

/// Made, used and gone on one thread.
class Chain {
 public:
  Chain(const PreparedPlan& prepared, const sim::Trial& trial,
        const executor::CycleRunner::Parameters& loop)
      : cell_(prepared.cell),
        task_(prepared.task),
        link_({.bitrate_bps = cell_.robot.bitrate_bps, .seed = trial.seed},
              cell_.robot.master_node),
        arm_(cell_.robot, link_.master()),
        controller_(cell_, prepared.dry_run, {}),
        runner_(arm_, controller_, nullptr, loop),
        virtual_cell_(cell_, task_, world_of(prepared.candidate, prepared.joints, trial)),
        time_(arm_, virtual_cell_, link_,
              {.cycle_ns = std::int64_t{1000} * cell_.robot.cycle_us,
               .feedback_deadline = loop.feedback_deadline}) {}

  void run() {
    constexpr std::int64_t kCyclesMax = 1'000'000;
    if (!time_.prepare()) return;
    while (time_.statistics().cycles < kCyclesMax && time_.cycle(runner_)) {
      plan_ran_ = plan_ran_ || controller_.state() == executor::State::kRunning;
    }
  }

  [[nodiscard]] sim::TrialResult result() const {
    const executor::RunResult run = told();
    const sim::Truth truth = virtual_cell_.truth();
    sim::TrialResult result;
    result.done = run.exit_code == 0;
    result.at_goal = truth.within_tolerance && inserted(task_, truth.tool);
    result.ending = to_string(run.reason);
    result.reason = run.message;
    result.steps = run.steps.size();
    result.duration_s = run.duration_s;
    if (plan_ran_) result.step = static_cast<int>(controller_.runner().step());
    if (!run.steps.empty() && run.steps.back().step == controller_.runner().step()) {
      result.outcome = to_string(run.steps.back().result.outcome);
    }
    result.error = truth.error;
    result.contact_force_N_max = truth.contact_force_N_max;
    if (result.done && !result.at_goal) {
      result.reason += format("; the part is %.2f mm from its goal (%.2f allowed) and %sinserted",
                              1e3 * truth.error_norm_m, 1e3 * truth.goal_tolerance_m,
                              inserted(task_, truth.tool) ? "" : "not ");
    }
    if (truth.solver_messages > 0) {
      result.done = false;
      result.ending = sim::kNoPhysics;
      result.reason = format("the physics solver gave up %zu times; the executor says: ",
                             static_cast<std::size_t>(truth.solver_messages)) +
                      run.message;
    }
    return result;
  }

  void print() const {
    for (const executor::StepReport& step : told().steps) {
      std::printf("%s\n", executor::step_line(step).c_str());
    }
    std::printf("%s\n%s", told().message.c_str(), sim::describe(virtual_cell_.truth()).c_str());
  }

  [[nodiscard]] const executor::BlackBox& black_box() const { return runner_.black_box(); }

 private:
  [[nodiscard]] executor::RunResult told() const {
    return executor::gather_result(controller_, runner_, 0,
                                   hw::describe(arm_.fault(), cell_.robot));
  }

  const Cell& cell_;
  const Task& task_;
  sim::VirtualLink link_;
  hw::CanopenArm arm_;
  executor::Controller controller_;
  executor::CycleRunner runner_;
  sim::VirtualCell virtual_cell_;
  sim::Lockstep time_;
  bool plan_ran_ = false;
};

/// @param look called with the chain once its run has ended
template <typename Look>
sim::TrialResult execute(const PreparedPlan& prepared, const sim::Trial& trial,
                         const executor::CycleRunner::Parameters& loop, const Look& look) {
  std::optional<Chain> chain;
  try {
    chain.emplace(prepared, trial, loop);
  } catch (const InputError& error) {
    sim::TrialResult result;
    result.ending = sim::kNoWorld;
    result.reason = error.what();
    return result;
  }
  chain->run();
  look(*chain);
  return chain->result();
}

}  // namespace

PlanRunner::PlanRunner(const Cell& cell, const Task& task, const sim::Candidate& candidate) {
  std::vector<std::string> refusals = executor::check_plan(candidate.plan, cell);
  executor::DryRun dry_run = executor::dry_run(candidate.plan, cell);
  refusals.insert(refusals.end(), dry_run.refusals.begin(), dry_run.refusals.end());
  if (!refusals.empty()) {
    throw InputError(candidate.file + ": cell '" + cell.name +
                     "' cannot execute this plan: " + refusals.front());
  }
  const JointVector joints = sim::start_joints(cell, candidate.start.pose);
  prepared_ = std::make_shared<const PreparedPlan>(
      PreparedPlan{cell, task, candidate, std::move(dry_run), joints});
}

sim::TrialResult PlanRunner::run(const sim::Trial& trial) const {
  return execute(*prepared_, trial, {}, [](const Chain&) {});
}

sim::TrialResult PlanRunner::tell(const sim::Trial& trial, const std::string& black_box) const {
  executor::CycleRunner::Parameters loop;
  loop.black_box_s = kToldCycles_s;
  return execute(*prepared_, trial, loop, [&](const Chain& chain) {
    chain.print();
    if (!black_box.empty()) chain.black_box().write_csv(black_box);
  });
}

}  // namespace tenon

#include "sim/evaluation_chain/trial_chain.h"

#include <cstdio>
#include <utility>

#include "shared/base/shown.h"
#include "shared/base/text.h"
#include "shared/task/inserted.h"
#include "shared/task/touched.h"

namespace tenon::sim {
namespace {

VirtualCell::Options world_of(const Candidate& candidate, const JointVector& joints,
                              const Trial& trial) {
  VirtualCell::Options options;
  options.start = candidate.start.name;
  options.seed = trial.seed;
  options.offset = trial.offset;
  options.world = trial.world;
  options.joints = joints;
  return options;
}

const executor::CycleRecord& last_cycle(const executor::CycleRunner& runner) {
  return runner.black_box().at(runner.black_box().size() - 1);
}

Vector3 to_um(const Vector3& position_m) { return (1e6 * position_m).array().round() / 1e6; }

}  // namespace

TrialChain::TrialChain(const PreparedPlan& prepared, const Trial& trial,
                       const executor::CycleRunner::Parameters& loop)
    : cell_(prepared.cell),
      task_(prepared.task),
      link_({.bitrate_bps = cell_.robot.bitrate_bps, .seed = trial.seed}, cell_.robot.master_node,
            cell_.robot.sensor.own_bitrate_bps),
      arm_(hw::open_arm(cell_, link_.master())),
      controller_(cell_, prepared.dry_run, {}),
      runner_(*arm_, controller_, nullptr, loop),
      virtual_cell_(cell_, task_, world_of(prepared.candidate, prepared.joints, trial)),
      time_(*arm_, virtual_cell_, link_,
            {.cycle_ns = std::int64_t{1000} * cell_.robot.cycle_us,
             .feedback_deadline = loop.feedback_deadline}) {}

void TrialChain::run(Recording* recording) {
  constexpr std::int64_t kCyclesMax = 1'000'000;
  if (!time_.prepare()) return;
  while (time_.statistics().cycles < kCyclesMax && time_.cycle(runner_)) {
    follow();
    if (recording != nullptr && plan_ran_) record(*recording);
  }
}

void TrialChain::follow() {
  if (!plan_ran_ && controller_.state() == executor::State::kRunning) {
    plan_ran_ = true;
    began_ns_ = last_cycle(runner_).motion_ns;
    path_m_.push_back(to_um(virtual_cell_.truth().tool.position_m));
  }
  if (plan_ran_ && path_m_.size() <= controller_.runner().report_count()) {
    path_m_.push_back(to_um(virtual_cell_.truth().tool.position_m));
  }
}

void TrialChain::record(Recording& recording) const {
  const executor::CycleRecord& cycle = last_cycle(runner_);
  recording.feel(executor::vector_of(cycle.wrench));
  Moment moment;
  moment.time_ns = cycle.motion_ns - began_ns_;
  if (!recording.is_due(moment.time_ns)) return;
  const Truth truth = virtual_cell_.truth();
  moment.tool = truth.tool;
  moment.step = static_cast<int>(controller_.runner().step());
  moment.touching = touched_pieces(task_, truth.touching);
  recording.add(std::move(moment));
}

std::string wrong_end_text(const Task& task, const Truth& truth) {
  std::string text =
      format("the part is %.2f mm, turned by %.2f degrees, from its goal (allowed: %s)",
             1e3 * truth.error_norm_m, degrees(truth.error_norm_rad),
             tolerance_text(task.goal_tolerance_m, task.goal_axes).c_str());
  if (task.inserted) text += inserted(task, truth.tool) ? " and inserted" : " and not inserted";
  return text;
}

TrialResult TrialChain::result() const {
  const executor::RunResult run = told();
  const Truth truth = virtual_cell_.truth();
  TrialResult result;
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
  result.path_m = path_m_;
  result.path_m.push_back(to_um(truth.tool.position_m));
  result.contact_force_N_max = truth.contact_force_N_max;
  if (result.done && !result.at_goal) {
    result.reason += "; " + wrong_end_text(task_, truth);
  }
  if (truth.solver_messages > 0) {
    result.done = false;
    result.ending = kNoPhysics;
    result.reason = format("the physics solver gave up %zu times; the executor says: ",
                           static_cast<std::size_t>(truth.solver_messages)) +
                    run.message;
  }
  return result;
}

void TrialChain::print() const {
  const executor::RunResult run = told();
  for (const executor::StepReport& step : run.steps) {
    std::printf("%s\n", executor::step_line(step).c_str());
  }
  std::printf("%s\n%s", run.message.c_str(), describe(virtual_cell_.truth()).c_str());
}

executor::RunResult TrialChain::told() const {
  return executor::gather_result(controller_, runner_, 0,
                                 hw::fault_text(arm_->fault(), cell_.robot));
}

}  // namespace tenon::sim

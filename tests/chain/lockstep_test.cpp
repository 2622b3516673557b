// Plan, executor, CAN protocol and virtual arm together, in virtual time.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "shared/motion/guarded_move.h"
#include "shared/plan/plan.h"
#include "sim/physics/rollout/ode_rollout.h"
#include "tests/support/frame_filter.h"
#include "tests/support/planned.h"
#include "tests/support/whole_run.h"

namespace tenon::tests {
namespace {

using executor::CycleRecord;
using executor::EndReason;
using executor::State;

class Recorder : public executor::CycleSink {
 public:
  void record(const CycleRecord& record) noexcept override { records.push_back(record); }
  std::vector<CycleRecord> records;
};

WholeRun::Options off_by(double x_m, double y_m) {
  WholeRun::Options options;
  options.start = "1";
  options.offset[0] = x_m;
  options.offset[1] = y_m;
  return options;
}

TEST(Chain, ThePartEndsAtTheGoalAlthoughTheTableIsCentimetresOff) {
  WholeRun run(gantry_cell(), box_task(), box_plan("1"), off_by(0.031, -0.024));
  const auto result = run.run();
  EXPECT_EQ(result.ending.reason, EndReason::kPlanDone) << result.reason;
  EXPECT_LT(result.truth.error_norm_m, box_task().goal_tolerance_m);
  EXPECT_EQ(result.truth.solver_messages, 0U);
  EXPECT_LT(result.truth.contact_force_N_max, gantry_cell().force_fault_N);
  for (const auto& drive : result.truth.drives) EXPECT_TRUE(drive.brake_engaged) << drive.joint;
}

TEST(Chain, APlanThatDoesNotFitTheWorldStopsWithItsStepAndReason) {
  // Six standard deviations: the walls are nowhere near where any particle had them.
  WholeRun run(gantry_cell(), box_task(), box_plan("1"), off_by(-0.18, 0.0));
  const auto result = run.run();
  EXPECT_EQ(result.ending.reason, EndReason::kPlanFailed) << result.reason;
  EXPECT_NE(result.reason.find("step"), std::string::npos) << result.reason;
}

TEST(Chain, ATraceFromTheExecutorReplaysOfflineBitForBit) {
  Recorder recorder;
  WholeRun run(gantry_cell(), box_task(), box_plan("1"), off_by(0.02, 0.015), &recorder);
  const auto result = run.run();
  ASSERT_EQ(result.ending.reason, EndReason::kPlanDone) << result.reason;

  const executor::PlanRunner& executed = run.controller().runner();
  std::optional<GuardedMove> move;
  std::optional<Pose> held;
  std::size_t finished = 0;
  for (const CycleRecord& record : recorder.records) {
    if (!record.moving) continue;
    if (record.move_started) {
      move.emplace(move_parameters(box_plan("1"), static_cast<std::size_t>(record.step)),
                   ContactSignature{record.signature_before}, held);
    }
    ASSERT_TRUE(move);
    GuardedMove::Input input;
    input.time_ns = record.motion_ns;
    input.pose = executor::pose_of(record.pose);
    input.wrench = executor::vector_of(record.wrench);
    input.wrench_fresh = record.wrench_fresh;
    const GuardedMove::Output output = move->update(input);
    ASSERT_EQ(output.setpoint.pose, executor::pose_of(record.setpoint)) << record.sequence;
    ASSERT_EQ(output.phase, record.phase) << record.sequence;
    held = output.setpoint.pose;
    if (output.phase != GuardedMove::Phase::kDone) continue;
    const GuardedMove::Result& there = executed.report(finished).result;
    const GuardedMove::Result& here = *move->result();
    EXPECT_EQ(here.outcome, there.outcome);
    EXPECT_EQ(here.decided_ns, there.decided_ns);
    EXPECT_EQ(here.duration_ns, there.duration_ns);
    EXPECT_EQ(here.travelled, there.travelled);
    EXPECT_EQ(here.signature, there.signature);
    ++finished;
  }
  EXPECT_EQ(finished, executed.report_count());
  EXPECT_EQ(finished, box_plan("1").steps.size());
}

// The first move of a plan that touches something, its travel in the plan's own physics and on the
// virtual arm, for a given on-threshold.
struct Travels {
  double decided_in_rollout_s = 0.0;
  double decided_on_arm_s = 0.0;
};
Travels first_contact(double force_on_N) {
  // Touch slowly and softly, so that the force rises over many samples.
  Task task = box_task();
  task.contact_stiffness_Npm = 5e3;
  Cell cell = gantry_cell();
  cell.contact_stiffness_Npm = 5e3;
  cell.robot.sensor.force_noise_N = 1e-3;  // a noisy sample fires a little early
  Plan plan = box_plan("1");
  plan.check_envelopes = false;
  plan.goal_tolerance_m = 0.0;  // it ends at the wall
  plan.parameter_sets[0].thresholds.force_on_N = force_on_N;
  plan.parameter_sets[0].speeds.approach_mps = 0.02;
  plan.parameter_sets[0].speeds.contact_mps = 0.01;
  plan.parameter_sets[0].timeout_us = 60'000'000;
  const Start& start = box_start("1");
  Vector6 to_wall = Vector6::Zero();
  to_wall[0] = -(start.pose.position_m.x() + 0.42);  // 3 cm short of the -x wall ...
  plan.steps.assign(1, plan.steps[0]);
  plan.steps[0].displacement = to_wall;
  plan.steps[0].displacement[0] -= 0.06;  // ... and 3 cm into it
  plan.steps[0].slow_from_m = 0.0;
  for (OutcomeRule& rule : plan.steps[0].outcomes) rule.successor = kSuccessorDone;

  Travels travels;
  sim::OdeRollout rollout(task);
  Particle particle;
  particle.pose = start.pose;
  particle.physics = {task.friction.nominal, 5e3};
  const auto simulated = rollout.simulate(particle, move_parameters(plan, 0), 2000, nullptr);
  EXPECT_TRUE(simulated.valid);
  EXPECT_EQ(simulated.move.outcome, Outcome::kContact);
  travels.decided_in_rollout_s = 1e-9 * static_cast<double>(simulated.move.decided_ns);

  WholeRun run(cell, task, plan, off_by(0.0, 0.0));
  const auto result = run.run();
  EXPECT_EQ(result.ending.reason, EndReason::kPlanDone) << result.reason;
  const auto& executed = run.controller().runner().report(0).result;
  EXPECT_EQ(executed.outcome, Outcome::kContact);
  travels.decided_on_arm_s = 1e-9 * static_cast<double>(executed.decided_ns);
  return travels;
}

TEST(Chain, AThresholdInThePlanMovesRolloutAndExecutionAlike) {
  const Travels high = first_contact(9.0);
  const Travels low = first_contact(4.0);
  // The command alone needs 5 N / (5e3 N/m * 10 mm/s) = 0.1 s longer; the tool yields meanwhile.
  const double later_in_rollout_s = high.decided_in_rollout_s - low.decided_in_rollout_s;
  const double later_on_arm_s = high.decided_on_arm_s - low.decided_on_arm_s;
  EXPECT_GT(later_in_rollout_s, 0.1);
  EXPECT_GT(later_on_arm_s, 0.1);
  EXPECT_NEAR(later_on_arm_s, later_in_rollout_s, 0.05);
}

// Runs until a move has been under way for a while.
void into_motion(WholeRun& run) {
  ASSERT_TRUE(run.prepare());
  for (int moving = 0; moving < 400;) {
    ASSERT_TRUE(run.cycle());
    moving += run.controller().state() == State::kRunning;
  }
}

TEST(Chain, AStopRequestRampsDownWithBoundedJerkAndEndsWithBrakesOn) {
  Recorder recorder;
  WholeRun run(gantry_cell(), box_task(), box_plan("1"), off_by(0.0, 0.0), &recorder);
  into_motion(run);
  run.controller().request_stop();
  while (run.cycle()) {
  }
  const auto result = run.result();
  EXPECT_EQ(result.ending.reason, EndReason::kStopRequested) << result.reason;
  for (const auto& drive : result.truth.drives) EXPECT_TRUE(drive.brake_engaged) << drive.joint;

  // Commanded speed falls to zero without a step: its change a cycle is bounded by the plan's
  // acceleration.
  const double cycle_s = 1e-6 * gantry_cell().robot.cycle_us;
  const double most_mps2 = 1.05 * box_task().motion.speeds.acceleration_mps2;
  const auto is_stopping = [](const CycleRecord& r) { return r.state == State::kStopping; };
  auto at = std::find_if(recorder.records.begin(), recorder.records.end(), is_stopping);
  ASSERT_NE(at, recorder.records.end());
  double fastest_mps = 0.0;
  for (; at + 1 != recorder.records.end() && is_stopping(*(at + 1)); ++at) {
    const Vector6 change =
        executor::vector_of((at + 1)->velocity) - executor::vector_of(at->velocity);
    EXPECT_LE(change.head<3>().norm() / cycle_s, most_mps2);
    fastest_mps = std::max(fastest_mps, executor::vector_of(at->velocity).head<3>().norm());
  }
  EXPECT_GT(fastest_mps, 0.03) << "it was in motion";
}

TEST(Chain, DrivesStopByThemselvesWhenTheExecutorIsGone) {
  WholeRun run(gantry_cell(), box_task(), box_plan("1"), off_by(0.0, 0.0));
  into_motion(run);
  run.leave_alone(2.0);
  const sim::Truth truth = run.cell().truth();
  EXPECT_TRUE(run.cell().at_standstill());
  for (const auto& drive : truth.drives) EXPECT_TRUE(drive.brake_engaged) << drive.joint;
  const bool told = std::any_of(truth.events.begin(), truth.events.end(), [](const auto& event) {
    return event.what.find("heartbeat") != std::string::npos;
  });
  EXPECT_TRUE(told) << "the truth names the lost heartbeat";
}

TEST(Chain, AfterAMissingAnswerGuardedMovesTakeNoSamplesForAFewCycles) {
  // cycle        k     k+1   k+2 ...
  // joint x     lost
  // sample      none  none  none ... then again
  Recorder recorder;
  WholeRun run(gantry_cell(), box_task(), box_plan("1"), off_by(0.0, 0.0), &recorder);
  into_motion(run);
  int lost = 0;
  const FrameFilter filter(
      run.bus(), [&](CanFrame& frame, std::size_t) { return frame.id != 0x190 || lost++ > 0; });
  for (int i = 0; i < 10; ++i) ASSERT_TRUE(run.cycle());
  EXPECT_GE(lost, 1);
  const auto at = [&](std::size_t back) {
    return recorder.records[recorder.records.size() - 10 + back].wrench_fresh;
  };
  EXPECT_FALSE(at(0));
  EXPECT_FALSE(at(1));
  EXPECT_FALSE(at(2));
  EXPECT_TRUE(at(8));
  while (run.cycle()) {
  }
  EXPECT_EQ(run.result().ending.reason, EndReason::kPlanDone) << run.result().reason;
}

TEST(Chain, ALoopThatIsLateEveryFourthCycleIsNotBlindForEver) {
  WholeRun run(gantry_cell(), box_task(), box_plan("1"), off_by(0.0, 0.0));
  into_motion(run);
  const auto blind_before = run.controller().blind_cycles();
  std::uint64_t cycles = 0;
  do {
    if (cycles % 4 == 0) run.controller().distrust_samples();
    ++cycles;
  } while (run.controller().state() == State::kRunning && run.cycle());
  EXPECT_EQ(run.controller().ending().reason, EndReason::kBlind);
  EXPECT_NEAR(static_cast<double>(cycles), 0.1 / 0.002, 3.0);
  EXPECT_NEAR(static_cast<double>(run.controller().blind_cycles() - blind_before), 0.1 / 0.002,
              3.0);
}

TEST(Chain, TheBusGoingDownInMidMotionIsANamedFault) {
  WholeRun run(gantry_cell(), box_task(), box_plan("1"), off_by(0.0, 0.0));
  into_motion(run);
  run.bus().set_up(false);
  while (run.cycle()) {
  }
  const auto result = run.result();
  EXPECT_EQ(result.ending.reason, EndReason::kArmFault) << result.reason;
  EXPECT_EQ(result.ending.arm_fault.kind, ArmFaultKind::kBusDown) << result.reason;
}

TEST(Chain, ARunRepeatsItselfToTheBit) {
  const auto once = WholeRun(gantry_cell(), box_task(), box_plan("1"), off_by(0.01, 0.02)).run();
  const auto again = WholeRun(gantry_cell(), box_task(), box_plan("1"), off_by(0.01, 0.02)).run();
  EXPECT_EQ(once.cycles, again.cycles);
  EXPECT_EQ(once.truth.tool, again.truth.tool);
}

}  // namespace
}  // namespace tenon::tests

// The motions of an identification in the loop that runs plans: they get what a plan's run gets.

#include <gtest/gtest.h>

#include <functional>
#include <memory>
#include <nlohmann/json.hpp>
#include <set>

#include "executor/identification/identification.h"
#include "executor/loop/cycle_runner.h"
#include "executor/telemetry/recorder.h"
#include "executor/telemetry/run_result.h"
#include "tests/executor/bench.h"
#include "tests/support/allocation_count.h"

namespace tenon::executor {
namespace {

// Six axes with the tool above the task, elbow up.
JointVector arm_joints() {
  Plan plan = touch_and_slide_plan();
  plan.start.position_m = Vector3(0.0, 0.0, 0.05);
  return *dry_run(plan, hand_made_arm_cell()).start;
}

struct IdentifyBench {
  // Along +x on the gantry. @param wall_x_m where something stands
  explicit IdentifyBench(double wall_x_m)
      : arm(hand_made_cell(), Pose{Vector3(0.1, 0.0, 0.0), Eigen::Quaterniond::Identity()}),
        identification(make_contact_identification(hand_made_cell(), "x")) {
    arm.walls.push_back({0, +1, wall_x_m});
    (void)arm.prepare(0);
  }
  // The payload on six axes.
  IdentifyBench()
      : arm(hand_made_arm_cell(), arm_joints()),
        identification(make_payload_identification(hand_made_arm_cell())) {
    (void)arm.prepare(0);
  }

  [[nodiscard]] ControlTask& task() const { return identification->motion(); }

  // To the end. @param watch sees every cycle's number and may turn knobs
  void run(const std::function<void(int)>& watch = [](int) {}) {
    bool going_on = true;
    for (; going_on && cycles < 100'000; ++cycles) {
      watch(cycles);
      const std::uint64_t before = tests::allocation_count();
      going_on = runner.step(now_ns += kCycle_ns);
      allocations += tests::allocation_count() - before;
      states.insert(task().state());
      if (cycles % 1000 == 0) recorder->drain();
    }
    ASSERT_TRUE(task().finished());
  }
  [[nodiscard]] RunResult result() const {
    std::optional<Finding> finding;
    if (task().ending().reason == EndReason::kMeasured) finding = identification->finding();
    return gather_result(task(), finding, runner, 0, "");
  }

  WallArm arm;
  std::unique_ptr<Identification> identification;
  std::unique_ptr<Recorder> recorder = std::make_unique<Recorder>();
  CycleRunner runner{arm, identification->motion(), recorder.get(), {}};
  std::set<State> states;
  std::uint64_t allocations = 0;
  int cycles = 0;
  std::int64_t now_ns = 0;
};

TEST(IdentifyMotion, AContactIsMeasuredAndTheJsonHasTheNumbers) {
  IdentifyBench bench(0.104);
  bench.run();
  const RunResult result = bench.result();
  EXPECT_EQ(result.exit_code, 0) << result.message;
  const auto json = nlohmann::json::parse(to_json(result, bench.task().cell()));
  EXPECT_EQ(json.at("status"), "done");
  EXPECT_EQ(json.at("reason"), "measured");
  EXPECT_EQ(json.at("disable_confirmed"), true);
  EXPECT_EQ(json.at("task"), "");
  EXPECT_EQ(json.at("steps").size(), 0U);
  EXPECT_EQ(json.at("finding").at("status"), "identified");
  EXPECT_NEAR(json["finding"].at("stiffness_Npm").get<double>(), bench.arm.stiffness_Npm,
              0.01 * bench.arm.stiffness_Npm);
  EXPECT_EQ(json.at("cycle").at("cycles"), bench.cycles);
  EXPECT_GT(json.at("peak_force_N").get<double>(), 20.0);
  EXPECT_EQ(bench.states,
            (std::set<State>{State::kWaiting, State::kTaring, State::kRunning, State::kHolding,
                             State::kDisabling, State::kWatching, State::kFinished}));
  EXPECT_FALSE(result.ended_badly());
}

TEST(IdentifyMotion, ThePayloadsJsonHasMassAndCentre) {
  IdentifyBench bench;
  bench.run();
  const RunResult result = bench.result();
  EXPECT_EQ(result.exit_code, 0) << result.message;
  const auto json = nlohmann::json::parse(to_json(result, bench.task().cell()));
  EXPECT_NEAR(json.at("finding").at("mass_kg").get<double>(), 0.0, 1.0);
  EXPECT_EQ(json["finding"].at("com_m").size(), 3U);
}

TEST(IdentifyMotion, WhereNothingStandsTheEndingSaysSoAndTheToolIsBack) {
  IdentifyBench bench(0.5);
  bench.run();
  const RunResult result = bench.result();
  EXPECT_EQ(result.reason, EndReason::kNothingMet);
  EXPECT_EQ(result.message, "nothing was met within 0.05 m along +x");
  EXPECT_EQ(result.exit_code, 1);
  EXPECT_FALSE(result.ended_badly());
  EXPECT_NEAR(bench.arm.tool().position_m.x(), 0.1, 1e-4);
}

TEST(IdentifyMotion, FeedbackThatGoesOnMissingEndsItByName) {
  IdentifyBench bench(0.5);
  bench.run([&](int cycle) { bench.arm.mute_joints = cycle % 8 == 0 ? 1U : 0U; });
  EXPECT_EQ(bench.task().ending().reason, EndReason::kFeedbackPoor);
  EXPECT_TRUE(bench.states.contains(State::kQuickStopping));
  EXPECT_GT(bench.arm.quick_stops(), 0);
  EXPECT_TRUE(bench.result().ended_badly());
}

TEST(IdentifyMotion, TheBlackBoxEndsWithTheReason) {
  IdentifyBench bench(0.5);
  bench.run([&](int cycle) {
    if (cycle == 2000) bench.arm.push[2] = 90.0;
  });
  EXPECT_EQ(bench.task().ending().reason, EndReason::kForceFault);
  EXPECT_TRUE(bench.result().ended_badly());
  const BlackBox& box = bench.runner.black_box();
  ASSERT_EQ(box.size(), 500U);  // a second of 2 ms
  const CycleRecord& last = box.at(box.size() - 1);
  EXPECT_EQ(last.state, State::kFinished);
  EXPECT_EQ(last.end_reason, static_cast<std::uint8_t>(EndReason::kForceFault));
  EXPECT_EQ(box.at(0).state, State::kRunning);
  EXPECT_GT(box.at(0).velocity[0], 1e-3);
  EXPECT_GT(box.at(0).commanded.position_m[0], 0.1);
}

TEST(IdentifyMotion, AStopRampsDownAndIsNoFault) {
  IdentifyBench bench(0.5);
  bench.run([&](int cycle) {
    if (cycle == 2000) bench.task().request_stop();
  });
  EXPECT_EQ(bench.task().ending().reason, EndReason::kStopRequested);
  EXPECT_TRUE(bench.states.contains(State::kStopping));
  EXPECT_FALSE(bench.states.contains(State::kQuickStopping));
  EXPECT_EQ(bench.result().exit_code, 1);
  EXPECT_FALSE(bench.result().ended_badly());
}

TEST(IdentifyMotion, NeitherMeasuringNorAnyFaultAllocates) {
  IdentifyBench contact(0.104);
  contact.run();
  EXPECT_EQ(contact.allocations, 0U);
  IdentifyBench payload;
  payload.run();
  EXPECT_EQ(payload.allocations, 0U);
  EXPECT_GT(payload.cycles, 10'000);
  for (int kind = 0; kind < 4; ++kind) {
    IdentifyBench bench;
    bench.run([&](int cycle) {
      if (cycle != 1000) return;
      if (kind == 0) bench.task().request_stop();
      if (kind == 1) bench.task().report_overruns(50);
      if (kind == 2) bench.arm.break_with.kind = ArmFaultKind::kHeartbeatLost;
      if (kind == 3) bench.arm.bias[0] = 300.0;
    });
    EXPECT_NE(bench.task().ending().reason, EndReason::kMeasured) << kind;
    EXPECT_EQ(bench.allocations, 0U) << kind;
  }
}

}  // namespace
}  // namespace tenon::executor

#pragma once
// A controller on a wall arm, stepped in virtual time.

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "executor/loop/controller.h"
#include "executor/loop/cycle_runner.h"
#include "tests/support/hand_made.h"
#include "tests/support/wall_arm.h"

namespace tenon::executor {

inline constexpr std::int64_t kCycle_ns = 2'000'000;

class Keeper : public CycleSink {
 public:
  void record(const CycleRecord& record) noexcept override { records.push_back(record); }
  std::vector<CycleRecord> records;
};

struct Bench {
  explicit Bench(const Plan& plan, const Controller::Parameters& parameters = {},
                 const Cell& bench_cell = hand_made_cell(), Vector3 off_start_m = Vector3::Zero(),
                 CycleSink* sink = nullptr)
      : arm(bench_cell, Pose{plan.start.position_m + off_start_m, plan.start.orientation}),
        controller(bench_cell, plan, parameters),
        runner(arm, controller, sink != nullptr ? sink : &keeper, {}) {
    (void)arm.prepare(0);
  }
  /// Any arm, standing at `joints`.
  Bench(const Plan& plan, const Controller::Parameters& parameters, const Cell& bench_cell,
        const JointVector& joints)
      : arm(bench_cell, joints),
        controller(bench_cell, plan, parameters),
        runner(arm, controller, &keeper, {}) {
    (void)arm.prepare(0);
  }

  bool step() { return runner.step(now_ns += kCycle_ns); }

  /// Runs to the end; `watch` sees every cycle and may turn knobs.
  template <typename Watch>
  void run(Watch watch) {
    for (int cycle = 0; cycle < 50'000; ++cycle) {
      watch();
      if (!step()) return;
    }
    FAIL() << "no end within 100 s";
  }
  void run() {
    run([] {});
  }
  void run_until(State state) {
    for (int cycle = 0; cycle < 50'000 && controller.state() != state; ++cycle) {
      ASSERT_TRUE(step()) << ending();
    }
    ASSERT_EQ(controller.state(), state);
  }
  [[nodiscard]] std::string ending() const {
    return describe(controller.ending(), controller.plan(), controller.cell());
  }

  WallArm arm;
  Controller controller;
  Keeper keeper;
  CycleRunner runner;
  std::int64_t now_ns = 0;
};

}  // namespace tenon::executor

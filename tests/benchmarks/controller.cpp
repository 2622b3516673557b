// What the executor computes in a cycle, without bus and devices: Controller::cycle() from waiting
// for the drives over taring and a plan of two moves (touch a wall, slide along it) to the end.

#include "executor/loop/controller.h"

#include <benchmark/benchmark.h>

#include "tests/benchmarks/cost.h"
#include "tests/support/hand_made.h"
#include "tests/support/wall_arm.h"

namespace {

using namespace tenon;
using namespace tenon::executor;

constexpr std::int64_t kCyclesMax = 20'000;

/// True where the plan came to its end.
bool run_once(bench::Cost& cost) {
  const Cell cell = hand_made_cell();
  const Plan plan = touch_and_slide_plan();
  WallArm arm(cell, plan.start);
  arm.walls.push_back({.axis = 0, .sign = 1, .position_m = 0.13});
  Controller controller(cell, plan, {});
  static_cast<void>(arm.prepare(0));
  const std::int64_t period_ns = std::int64_t{1000} * cell.robot.cycle_us;
  std::int64_t now_ns = 0;
  for (std::int64_t i = 0; i < kCyclesMax && !controller.finished(); ++i) {
    now_ns += period_ns;
    arm.start_cycle(now_ns);
    ArmFeedback feedback;
    static_cast<void>(arm.receive(now_ns, feedback));
    Controller::Command command;
    cost.measure([&] { command = controller.cycle(now_ns, feedback); });
    arm.command(now_ns, command.request, command.position);
  }
  return controller.finished() && controller.runner().status() == PlanRunner::Status::kDone;
}

void cycle(benchmark::State& state) {
  bench::Cost cost;
  for (auto _ : state) {
    if (!run_once(cost)) state.SkipWithError("the plan did not come to its end");
  }
  cost.report(state);
}

BENCHMARK(cycle)->Iterations(50)->Unit(benchmark::kMillisecond);

}  // namespace

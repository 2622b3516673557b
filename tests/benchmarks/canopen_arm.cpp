// What the CANopen master computes in a cycle of a three-axis arm that follows: SYNC, taking in
// what four nodes send, supervision, setpoints; and the same with 240 frames in the queue that are
// not for it, near the 256 that one call takes in at most.

#include "hw/arm/canopen_arm.h"

#include <benchmark/benchmark.h>

#include "tests/benchmarks/cost.h"
#include "tests/hw/gantry_on_bus.h"

namespace {

using namespace tenon;
using namespace tenon::hw;

constexpr std::int64_t kPeriod_ns = 2'000'000;

/// @param foreign frames between SYNC and answers, a cycle
void cycle(benchmark::State& state, int foreign) {
  GantryOnBus gantry;
  CanBus& intruder = gantry.bus.attach();
  if (!gantry.prepare_and_enable()) {
    state.SkipWithError("the arm did not come up");
    return;
  }
  bench::Cost cost;
  ArmFeedback feedback;
  JointVector setpoint = gantry.feedback.position;
  bool enabled = true;
  for (auto _ : state) {
    // The three calls of a cycle, without the nodes' own work in between.
    cost.measure([&] { gantry.arm.start_cycle(gantry.now_ns); });
    gantry.step_nodes();
    for (int i = 0; i < foreign; ++i) static_cast<void>(intruder.send({.id = 0x321, .length = 8}));
    cost.extend([&] {
      static_cast<void>(gantry.arm.receive(gantry.now_ns, feedback));
      gantry.arm.command(gantry.now_ns, ArmRequest::kEnabled, setpoint);
    });
    enabled = enabled && gantry.arm.state() == ArmState::kEnabled;
    setpoint[0] += 1e-6;
    gantry.now_ns += kPeriod_ns;
    gantry.bus.advance(gantry.now_ns);
  }
  if (!enabled) state.SkipWithError("the arm did not stay enabled");
  cost.report(state);
}

BENCHMARK_CAPTURE(cycle, quiet_bus, 0)->Iterations(50'000)->Unit(benchmark::kMicrosecond);
BENCHMARK_CAPTURE(cycle, flooded_bus, 240)->Iterations(10'000)->Unit(benchmark::kMicrosecond);

}  // namespace

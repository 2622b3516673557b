// What the kinematics of a six-axis arm cost in a control cycle: where the flange is, its Jacobian,
// and the joints for the next setpoint, 0.2 mm and 0.5 mrad away from the last.

#include <benchmark/benchmark.h>

#include "shared/config/load.h"
#include "shared/kinematics/serial_chain.h"
#include "tests/benchmarks/cost.h"
#include "tests/support/places.h"

namespace {

using namespace tenon;

constexpr JointVector kBent{0.3, -0.7, 1.1, 0.4, 0.9, -0.2};

SerialChain csp6() { return SerialChain(load_robot(tests::in_tree("hw/robots/csp6/robot.yaml"))); }

void flange(benchmark::State& state) {
  const SerialChain chain = csp6();
  bench::Cost cost;
  for (auto _ : state) cost.measure([&] { benchmark::DoNotOptimize(chain.flange(kBent)); });
  cost.report(state);
}

void jacobian(benchmark::State& state) {
  const SerialChain chain = csp6();
  bench::Cost cost;
  for (auto _ : state) cost.measure([&] { benchmark::DoNotOptimize(chain.jacobian(kBent)); });
  cost.report(state);
}

void inverse_from_the_last_setpoint(benchmark::State& state) {
  const SerialChain chain = csp6();
  const Pose goal =
      displaced(chain.flange(kBent), (Vector6() << 2e-4, 0, 0, 0, 5e-4, 0).finished());
  bench::Cost cost;
  SerialChain::Inverse found;
  for (auto _ : state) cost.measure([&] { found = chain.inverse(goal, kBent, {}); });
  if (found.status != SerialChain::InverseStatus::kSolved) state.SkipWithError("not solved");
  cost.report(state);
  state.counters["iterations"] = found.iterations;
}

BENCHMARK(flange)->Iterations(200'000)->Unit(benchmark::kMicrosecond);
BENCHMARK(jacobian)->Iterations(200'000)->Unit(benchmark::kMicrosecond);
BENCHMARK(inverse_from_the_last_setpoint)->Iterations(100'000)->Unit(benchmark::kMicrosecond);

}  // namespace

// Guarded-move rollouts in ODE: what the planner spends its time on. items_per_second is rollouts
// per second on one thread, simulated_s the length of one.

#include <benchmark/benchmark.h>

#include "sim/physics/rollout/ode_rollout.h"
#include "tests/benchmarks/box_moves.h"
#include "tests/benchmarks/cost.h"

namespace {

using namespace tenon;
using bench::Move;

void rollout(benchmark::State& state, Move move) {
  sim::OdeRollout physics(bench::box_task());
  const Particle particle = bench::box_particle(move, physics);
  const MoveParameters parameters = bench::box_move(move);
  RolloutResult result;
  bench::Cost cost;
  for (auto _ : state) {
    cost.measure([&] {
      result = physics.simulate(particle, parameters, bench::box_task().rollout_step_us, nullptr);
    });
  }
  if (!result.valid || result.move.outcome != bench::box_outcome(move)) {
    state.SkipWithError("the move ended otherwise than it should");
  }
  state.SetItemsProcessed(state.iterations());
  state.counters["simulated_s"] = 1e-9 * static_cast<double>(result.move.duration_ns);
  cost.report(state);
}

BENCHMARK_CAPTURE(rollout, free, Move::kFree)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(rollout, contact, Move::kContact)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(rollout, slide, Move::kSlide)->Unit(benchmark::kMillisecond);

}  // namespace

// GuardedMove::update() on what a rollout measured, from the first sample to the end of settling.

#include "shared/motion/guarded_move.h"

#include <benchmark/benchmark.h>

#include <vector>

#include "sim/physics/rollout/ode_rollout.h"
#include "tests/benchmarks/box_moves.h"
#include "tests/benchmarks/cost.h"

namespace {

using namespace tenon;
using bench::Move;

void update(benchmark::State& state, Move kind) {
  sim::OdeRollout physics(bench::box_task());
  const Particle particle = bench::box_particle(kind, physics);
  const MoveParameters parameters = bench::box_move(kind);
  std::vector<TraceSample> trace;
  const RolloutResult result =
      physics.simulate(particle, parameters, bench::box_task().rollout_step_us, &trace);
  if (!result.valid || result.move.outcome != bench::box_outcome(kind)) {
    state.SkipWithError("the move ended otherwise than it should");
    return;
  }
  bench::Cost cost;
  for (auto _ : state) {  // a whole move
    GuardedMove move(parameters, particle.signature);
    for (const TraceSample& sample : trace) {
      cost.measure([&] { benchmark::DoNotOptimize(move.update(sample.input)); });
    }
  }
  cost.report(state);
}

BENCHMARK_CAPTURE(update, free, Move::kFree)->Iterations(200)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(update, contact, Move::kContact)->Iterations(200)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(update, slide, Move::kSlide)->Iterations(200)->Unit(benchmark::kMillisecond);

}  // namespace

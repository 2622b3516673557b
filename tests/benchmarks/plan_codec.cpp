// A plan from bytes and to bytes: the three moves of FORMAT.md, a usual plan of 15 steps, and the
// largest there is.

#include <benchmark/benchmark.h>

#include <cstdint>
#include <vector>

#include "shared/plan/codec.h"
#include "tests/benchmarks/cost.h"
#include "tests/shared/example_plans.h"

namespace {

using namespace tenon;

Plan documented() { return tests::documented_plan(); }
Plan usual() { return tests::long_plan(0x03, 15, {Outcome::kReached, Outcome::kContact}); }
Plan largest() {
  return tests::long_plan(0x3F, kMaxSteps,
                          {Outcome::kReached, Outcome::kContact, Outcome::kRelease,
                           Outcome::kBlocked, Outcome::kTimeout});
}

void decode(benchmark::State& state, Plan (*make)()) {
  const std::vector<std::uint8_t> bytes = encode_plan(make());
  bench::Cost cost;
  for (auto _ : state) {
    cost.measure([&] { benchmark::DoNotOptimize(decode_plan(bytes)); });
  }
  state.SetBytesProcessed(state.iterations() * static_cast<std::int64_t>(bytes.size()));
  cost.report(state);
}

void encode(benchmark::State& state, Plan (*make)()) {
  const Plan plan = make();
  bench::Cost cost;
  for (auto _ : state) {
    cost.measure([&] { benchmark::DoNotOptimize(encode_plan(plan)); });
  }
  cost.report(state);
}

BENCHMARK_CAPTURE(decode, documented, documented)->Unit(benchmark::kMicrosecond);
BENCHMARK_CAPTURE(decode, fifteen_steps, usual)->Unit(benchmark::kMicrosecond);
BENCHMARK_CAPTURE(decode, largest, largest)->Unit(benchmark::kMicrosecond);
BENCHMARK_CAPTURE(encode, fifteen_steps, usual)->Unit(benchmark::kMicrosecond);

}  // namespace

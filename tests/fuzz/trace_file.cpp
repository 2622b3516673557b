// A trace of arbitrary bytes.

#include <cstddef>
#include <cstdint>
#include <vector>

#include "executor/telemetry/trace.h"
#include "tests/fuzz/support/refused.h"

// NOLINTNEXTLINE(readability-identifier-naming): libFuzzer's name
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace tenon;
  static const fuzz::InputFolder folder;
  const auto file = folder.put("trace", fuzz::text_of(data, size));
  std::vector<executor::TracedMove> moves;
  fuzz::accepted([&] { moves = executor::read_trace(file); });
  for (const executor::TracedMove& move : moves) {
    fuzz::must(static_cast<std::size_t>(move.outcome) < kOutcomes.size(),
               "an outcome is one of ours");
    for (const executor::TracedInput& input : move.inputs) {
      fuzz::must(input.input.pose.position_m.allFinite() && input.input.wrench.allFinite(),
                 "an input is made of numbers");
    }
  }
  return 0;
}

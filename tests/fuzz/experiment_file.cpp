// An experiment file of arbitrary bytes.

#include <cmath>
#include <cstddef>
#include <cstdint>

#include "shared/config/load.h"
#include "tests/fuzz/support/refused.h"

// NOLINTNEXTLINE(readability-identifier-naming): libFuzzer's name
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace tenon;
  static const fuzz::InputFolder folder;
  const auto file = folder.put("experiment.yaml", fuzz::text_of(data, size));
  WorldRanges ranges;
  if (!fuzz::accepted([&] { ranges = load_experiment(file); })) return 0;
  fuzz::must(!ranges.name.empty(), "an experiment has a name");
  for (const Spread& spread : {ranges.clearance_m, ranges.size_error_m, ranges.backlash_m}) {
    fuzz::must(std::isfinite(spread.low) && spread.low <= spread.high && spread.sigma >= 0.0,
               "a range has its ends in order");
  }
  return 0;
}

// The run log of an evaluation of arbitrary bytes: as it is read, as it is taken up to go on with,
// and its lines.

#include "sim/evaluation/run_log.h"

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>

#include "sim/evaluation/run_line.h"
#include "tests/fuzz/support/refused.h"

namespace {

constexpr const char* kIdentity = "{}";

}  // namespace

// NOLINTNEXTLINE(readability-identifier-naming): libFuzzer's name
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace tenon;
  static const fuzz::InputFolder folder;
  const auto file = folder.put("runs.jsonl", fuzz::text_of(data, size));
  std::size_t runs = 0;
  const bool readable = fuzz::accepted([&] {
    for (const std::string& line : sim::read_run_log(file, kIdentity)) {
      ++runs;
      const std::optional<sim::RunRecord> record = sim::parse_run_line(line);
      if (!record) continue;
      for (const Vector3& point_m : record->result.path_m) {
        fuzz::must(point_m.allFinite(), "a path is made of numbers");
      }
      if (!record->result.error) continue;
      fuzz::must(record->result.error->allFinite(), "an error is made of numbers");
    }
  });
  fuzz::accepted([&] {
    sim::RunLog log(file, kIdentity);
    fuzz::must(!readable || log.found().size() == runs, "both readers find the same runs");
    log.append("{}");
  });
  return 0;
}

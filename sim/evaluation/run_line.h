#pragma once
// A run as one line of JSON: what the run log holds and, line by line, the evaluation's JSON.
// Offline.

#include <optional>
#include <string>

#include "sim/evaluation/trial.h"

namespace tenon::sim {

/// @param plan the hash of the plan's file  @param with_world whether more than the offset was
/// drawn
[[nodiscard]] std::string run_line(const std::string& plan, const Run& run, bool with_world);

/// What stands in a line. The draw is not read: it follows from the number.
struct RunRecord {
  std::string plan;
  std::size_t number = 0;
  std::uint64_t seed = 0;
  TrialResult result;
};
/// Nothing where it is no such line.
[[nodiscard]] std::optional<RunRecord> parse_run_line(const std::string& line);

}  // namespace tenon::sim

#pragma once
// What tenon-evaluate is asked for: its options, what they name, and whether they go together.
// Reads files; one thread.

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "shared/cell/cell.h"
#include "shared/system/fan_out.h"
#include "shared/task/task.h"
#include "sim/evaluation/evaluation.h"

namespace tenon {

struct EvaluateLine {
  std::string cell;
  std::string task;
  std::vector<std::string> plans;
  std::string experiment;
  std::string corner;
  std::size_t count = 100;
  std::uint64_t seed = 0;
  std::size_t threads = all_cores();
  std::string shard = "1/1";
  std::vector<std::string> merge;
  std::optional<std::size_t> only;
  std::vector<std::string> by;
  std::string runs;
  std::string json;
  std::string report;
  std::string summary;
  std::string figures;
  std::string junit;
  std::optional<double> min_success;  ///< proportion, 0 to 1
  std::string black_box;
};

/// Of cell, robot, task, experiment and this program: what a run depends on besides plan and
/// number.
[[nodiscard]] std::string identity_of(const EvaluateLine& line, const Task& task);

/// The run log's name; empty: none is kept.
[[nodiscard]] std::string log_file_of(const EvaluateLine& line);

/// @throws InputError for files that two options would write, or one would write and another read,
/// and for options that do not go together
void check_options(const EvaluateLine& line);

/// Loads task, experiment and plans. @throws InputError for what cannot be used
[[nodiscard]] sim::Evaluation evaluation_of(const EvaluateLine& line, const Cell& cell);

}  // namespace tenon

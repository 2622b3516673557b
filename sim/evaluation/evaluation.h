#pragma once
// Everything that an evaluation's reports are made of. Plain data; a report follows from it alone,
// whichever way the runs were made.

#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "shared/cell/cell.h"
#include "shared/experiment/world_ranges.h"
#include "shared/plan/plan.h"
#include "shared/task/task.h"
#include "sim/evaluation/quantity.h"
#include "sim/evaluation/recording.h"
#include "sim/evaluation/run_line.h"
#include "sim/evaluation/trial.h"

namespace tenon::sim {

/// One of the plans that are compared.
struct Candidate {
  std::string file;
  std::string hash;  ///< of the file
  Plan plan;
  Start start;                                  ///< the task's, of the plan's name
  std::map<std::size_t, Run> runs;              ///< by number
  std::map<std::size_t, Recording> recordings;  ///< of the few that a page replays, by number
};

struct Evaluation {
  Task task;
  Cell cell;                          ///< as its file has it
  std::optional<WorldRanges> ranges;  ///< of the experiment
  std::uint64_t seed = 0;
  std::vector<Candidate> candidates;
  std::vector<Bins> by;  ///< none, one or two: what success is broken down by
  /// The command line without plan and number: what makes a run again.
  std::string replay;

  [[nodiscard]] Trial trial(std::size_t plan, std::size_t number) const {
    return draw_trial(task, cell, candidates[plan].start, ranges ? &*ranges : nullptr, seed,
                      number);
  }
};

/// A typing error in --by must not cost a thousand runs.
/// @param count how many runs there will be
/// @throws InputError where none of them falls in a bin
void check_bins(const Evaluation& evaluation, std::size_t count);

}  // namespace tenon::sim

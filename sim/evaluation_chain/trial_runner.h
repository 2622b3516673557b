#pragma once
// Runs a plan in drawn worlds: the function that an evaluation calls for each of its trials.

#include <memory>
#include <string>

#include "shared/cell/cell.h"
#include "shared/system/record_file.h"
#include "shared/task/task.h"
#include "sim/evaluation/evaluation.h"
#include "sim/evaluation/recording.h"
#include "sim/evaluation/trial.h"

namespace tenon::sim {

/// What all trials of a plan share.
struct PreparedPlan;

/// Cell, task and candidate must outlive it; any number of threads may use it at once.
class TrialRunner {
 public:
  /// @throws InputError where the cell cannot execute the plan
  TrialRunner(const Cell& cell, const Task& task, const Candidate& candidate);

  [[nodiscard]] TrialResult run(const Trial& trial) const;
  /// The same run, kept as it goes.
  TrialResult record(const Trial& trial, Recording& recording) const;
  /// The same, and prints what happened step by step.
  /// @param black_box CSV file for the last minute of cycles; empty: none
  /// @param written what became of that file
  TrialResult tell(const Trial& trial, const std::string& black_box, RecordReport& written) const;

 private:
  std::shared_ptr<const PreparedPlan> prepared_;
};

}  // namespace tenon::sim

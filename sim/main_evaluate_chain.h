#pragma once
// One run of tenon-evaluate: executor, CANopen master, bus and virtual arm in one process and in
// virtual time.

#include <memory>
#include <string>

#include "shared/cell/cell.h"
#include "shared/task/task.h"
#include "sim/evaluation/evaluation.h"
#include "sim/evaluation/trial.h"

namespace tenon {

/// What all runs of a plan share.
struct PreparedPlan;

/// Runs a plan in drawn worlds. Cell, task and candidate must outlive it; any number of threads may
/// use it at once.
class PlanRunner {
 public:
  /// @throws InputError where the cell cannot execute the plan
  PlanRunner(const Cell& cell, const Task& task, const sim::Candidate& candidate);

  [[nodiscard]] sim::TrialResult run(const sim::Trial& trial) const;
  /// The same, and prints what happened step by step.
  /// @param black_box CSV file for the last minute of cycles; empty: none
  sim::TrialResult tell(const sim::Trial& trial, const std::string& black_box) const;

 private:
  std::shared_ptr<const PreparedPlan> prepared_;
};

}  // namespace tenon

#pragma once
// tenon-evaluate on a plan for start 1 of the box task, in worlds so harsh that some of its runs
// fail.

#include <string>
#include <vector>

#include "tests/support/commands.h"
#include "tests/support/scratch_folder.h"

namespace tenon::tests {

struct HarshEvaluation {
  static constexpr int kRuns = 8;

  /// The command and further options; kRuns runs, unless the options have --only.
  [[nodiscard]] std::vector<std::string> command(const std::vector<std::string>& more) const;
  /// The command, run to its end.
  [[nodiscard]] Ended evaluate(const std::vector<std::string>& more) const;

  [[nodiscard]] std::string path(const std::string& name) const { return folder.path() / name; }

  ScratchFolder folder;
  std::string plan_file = put_box_plan(folder, "1");
  std::string experiment_file = folder.put(
      "harsh.yaml", "name: harsh\nfriction: [0.1, 0.6]\nforce_drift_N_sqrts: [0.0, 1.2]\n");
};

}  // namespace tenon::tests

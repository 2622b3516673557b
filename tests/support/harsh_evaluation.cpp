#include "tests/support/harsh_evaluation.h"

#include <algorithm>

#include "tests/support/places.h"

namespace tenon::tests {

std::vector<std::string> HarshEvaluation::command(const std::vector<std::string>& more) const {
  std::vector<std::string> all = {executable("tenon-evaluate"),
                                  "--cell",
                                  gantry_cell_file(),
                                  "--task",
                                  box_task_file(),
                                  "--plan",
                                  plan_file,
                                  "--experiment",
                                  experiment_file,
                                  "--seed",
                                  "5"};
  if (std::find(more.begin(), more.end(), "--only") == more.end()) {
    all.insert(all.end(), {"-n", std::to_string(kRuns)});
  }
  all.insert(all.end(), more.begin(), more.end());
  return all;
}

Ended HarshEvaluation::evaluate(const std::vector<std::string>& more) const {
  return run(folder, command(more));
}

}  // namespace tenon::tests

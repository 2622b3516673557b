#include "sim/evaluation/run_sample.h"

#include <algorithm>
#include <vector>

namespace tenon::sim {
namespace {

/// From the first to the last.
void take_evenly(const std::vector<const Run*>& from, std::size_t most,
                 std::map<std::size_t, Run>& runs) {
  const std::size_t count = std::min(most, from.size());
  for (std::size_t i = 0; i < count; ++i) {
    const Run& run = *from[i * from.size() / count];
    runs.emplace(run.trial.number, run);
  }
}

}  // namespace

Candidate sample_of(const Candidate& candidate, std::size_t most) {
  if (candidate.runs.size() <= most) return candidate;
  std::vector<const Run*> succeeded;
  std::vector<const Run*> failed;
  Candidate sample = candidate;
  sample.runs.clear();
  for (const auto& [number, run] : candidate.runs) {
    if (candidate.recordings.count(number) > 0) {
      sample.runs.emplace(number, run);
      continue;
    }
    (classify(run.result) == TrialClass::kSucceeded ? succeeded : failed).push_back(&run);
  }
  const std::size_t room = most - std::min(most, sample.runs.size());
  const std::size_t failures_max = room - std::min(succeeded.size(), room / 3);
  take_evenly(failed, failures_max, sample.runs);
  take_evenly(succeeded, most - std::min(most, sample.runs.size()), sample.runs);
  return sample;
}

}  // namespace tenon::sim

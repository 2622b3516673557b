#include "sim/evaluation/trial.h"

#include "shared/base/random.h"
#include "shared/task/spread.h"
#include "sim/cell/virtual_arm/environment_offset.h"

namespace tenon::sim {
namespace {

constexpr int kSeedBits = 53;  // which every JSON reader keeps

}  // namespace

const char* to_string(TrialClass trial_class) {
  switch (trial_class) {
    case TrialClass::kSucceeded:
      return "succeeded";
    case TrialClass::kStopped:
      return "stopped";
    case TrialClass::kDoneButWrong:
      return "done_but_wrong";
  }
  return "?";
}

Trial draw_trial(const Task& task, const Start& start, const WorldRanges* ranges,
                 std::uint64_t seed, std::size_t number) {
  Trial trial;
  trial.number = number;
  trial.seed = stream_seed(seed, number) >> (64 - kSeedBits);
  trial.offset = draw_offset(task, start, trial.seed);
  trial.distance = sigmas_out(task, start, trial.offset);
  if (ranges != nullptr) trial.world = draw_world(*ranges, task, trial.seed);
  return trial;
}

}  // namespace tenon::sim

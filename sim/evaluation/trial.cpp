#include "sim/evaluation/trial.h"

#include <cmath>

#include "shared/base/random.h"
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
  trial.offset = draw_offset(start, task.coordinates, trial.seed);
  double squares = 0.0;
  for (int axis = 0; axis < 6; ++axis) {
    if (trial.offset[axis] != 0.0) squares += std::pow(trial.offset[axis] / start.sigma[axis], 2);
  }
  trial.distance = std::sqrt(squares);
  if (ranges != nullptr) trial.world = draw_world(*ranges, task, trial.seed);
  return trial;
}

}  // namespace tenon::sim

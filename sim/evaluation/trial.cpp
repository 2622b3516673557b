#include "sim/evaluation/trial.h"

#include <cmath>

#include "sim/virtual_arm/environment_offset.h"

namespace tenon::sim {
namespace {

// SplitMix64: neighbouring numbers give unrelated seeds, and two seeds of an evaluation share none.
// 53 bits, which every JSON reader keeps.
std::uint64_t seed_of_run(std::uint64_t seed, std::size_t number) {
  const auto mix = [](std::uint64_t value) {
    value += 0x9E3779B97F4A7C15;
    value = (value ^ value >> 30) * 0xBF58476D1CE4E5B9;
    value = (value ^ value >> 27) * 0x94D049BB133111EB;
    return value ^ value >> 31;
  };
  return mix(mix(seed) + number) >> 11;
}

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
  trial.seed = seed_of_run(seed, number);
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

#include "sim/evaluation/trial.h"

#include <cmath>

#include "shared/base/random.h"
#include "shared/base/shown.h"
#include "shared/base/text.h"
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

double tilt_of(const WorldDraw& world, const Task& task, const Cell& cell) {
  Vector3 environment = cell.X_BT.orientation.conjugate() * world.task_in_base_error.tail<3>();
  Vector3 held = task.goal.orientation *
                 (cell.X_FP.orientation.conjugate() * world.tool_in_flange_error.tail<3>());
  for (int axis = 0; axis < 3; ++axis) {
    if (has(task.coordinates, 3 + axis)) environment[axis] = held[axis] = 0.0;
  }
  return std::hypot(environment.norm(), held.norm());
}

bool within_promise(const Trial& trial, const Task& task) {
  return trial.distance <= task.particle_sigmas && trial.tilt_rad <= task.tilt_rad;
}

std::string tilt_text(const Trial& trial) {
  if (trial.tilt_rad == 0.0) return "";
  return format(", tilted by %.2f degrees", shown(trial.tilt_rad, 3));
}

Trial draw_trial(const Task& task, const Cell& cell, const Start& start, const WorldRanges* ranges,
                 std::uint64_t seed, std::size_t number) {
  Trial trial;
  trial.number = number;
  trial.seed = stream_seed(seed, number) >> (64 - kSeedBits);
  trial.offset = draw_offset(task, start, trial.seed);
  trial.distance = sigmas_out(task, start, trial.offset);
  if (ranges != nullptr) {
    trial.world = draw_world(*ranges, task, trial.seed);
    trial.tilt_rad = tilt_of(trial.world, task, cell);
  }
  return trial;
}

}  // namespace tenon::sim

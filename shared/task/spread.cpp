#include "shared/task/spread.h"

#include <algorithm>
#include <cmath>

#include "shared/base/text.h"

namespace tenon {

double sigmas_out(const Task& task, const Start& start, const Vector6& offset) {
  double squares = 0.0;
  double farthest = 0.0;
  for (int axis = 0; axis < 6; ++axis) {
    if (start.sigma[axis] <= 0.0) continue;
    const double z = std::abs(offset[axis]) / start.sigma[axis];
    squares += z * z;
    farthest = std::max(farthest, z);
  }
  return task.errors == Distribution::kUniform ? farthest : std::sqrt(squares);
}

double drawn_sigmas(const Task& task) {
  return task.particle_sigmas + (task.errors == Distribution::kUniform ? 0.0 : 1.0);
}

std::string reach_text(const Task& task) {
  return task.errors == Distribution::kUniform
             ? "at the bounds"
             : format("%g standard deviations out", task.particle_sigmas);
}

std::string out_text(const Task& task, double sigmas) {
  return task.errors == Distribution::kUniform
             ? format("at %.0f %% of the bounds", 100.0 * sigmas / task.particle_sigmas)
             : format("%.2f sigma out", sigmas);
}

const char* error_key(const Task& task, int axis) {
  if (task.errors == Distribution::kUniform) return axis < 3 ? "uniform_m" : "uniform_rad";
  return axis < 3 ? "sigma_m" : "sigma_rad";
}

double stated_error(const Task& task, const Start& start, int axis) {
  return (task.errors == Distribution::kUniform ? task.particle_sigmas : 1.0) * start.sigma[axis];
}

std::string within_text(const Task& task, double sigmas) {
  return task.errors == Distribution::kUniform && sigmas >= task.particle_sigmas
             ? "within the bounds"
             : format("within %g sigma", sigmas);
}

}  // namespace tenon

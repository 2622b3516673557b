#include "shared/task/own_moves.h"

#include <Eigen/Geometry>
#include <algorithm>

namespace tenon {
namespace {

constexpr double kStepOverReach = 1.2;
constexpr double kLongestPush_m = 10.0;
constexpr std::size_t kSamples = 60;
// A guide that leads past several contacts costs many times what the straight way does.
constexpr double kGuideWeight = 30.0;

void extend(Eigen::AlignedBox3d& box, const Shape& shape, const Pose& at) {
  // A ball around the shape, whichever way it stands.
  const Vector3 half_m = Vector3::Constant(0.5 * shape.size_m.norm());
  const Vector3 centre_m = compose(at, shape.pose).position_m;
  box.extend(centre_m - half_m);
  box.extend(centre_m + half_m);
}

}  // namespace

void derive_moves(Task& task) {
  double sigma_m = 0.0;
  double sigma_rad = 0.0;
  Eigen::AlignedBox3d all;
  for (const Shape& shape : task.environment) extend(all, shape, {});
  for (const Start& start : task.starts) {
    sigma_m = std::max(sigma_m, start.sigma.head<3>().maxCoeff());
    sigma_rad = std::max(sigma_rad, start.sigma.tail<3>().maxCoeff());
    for (const Shape& shape : task.held) extend(all, shape, start.pose);
  }
  const double reach_m = task.particle_sigmas * sigma_m;
  if (reach_m > 0.0) task.step_m = kStepOverReach * reach_m;
  if (sigma_rad > 0.0) task.step_rad = kStepOverReach * task.particle_sigmas * sigma_rad;
  task.long_step_m =
      std::clamp(all.sizes().maxCoeff() + 2.0 * reach_m, task.step_m, kLongestPush_m);
  task.direct_reach_m = task.long_step_m;
  task.guide_moves = true;
  task.attractor_samples = kSamples;
  task.w2 = kGuideWeight;
  task.move_weight = task.distance_weight_per_m * task.goal_tolerance_m;
}

}  // namespace tenon

#include "shared/task/pose_error.h"

namespace tenon {

Pose environment_pose(const Vector6& error, const Vector3& about_m) {
  const Eigen::Quaterniond turn = rotation_of(error.tail<3>());
  const Vector3 swing_m = about_m - turn * about_m;
  return {swing_m + error.head<3>(), turn};
}

Pose seen_from(const Pose& environment, const Pose& tool) {
  return environment == Pose{} ? tool : compose(inverse(environment), tool);
}

Pose seen_as(const Pose& environment, const Pose& seen) {
  return environment == Pose{} ? seen : compose(environment, seen);
}

}  // namespace tenon

#include "executor/dry_run/path_follower.h"

#include <algorithm>
#include <cmath>

#include "executor/motion/joint_difference.h"

namespace tenon::executor {

int PathFollower::points_between(const Vector6& from, const Vector6& to) {
  const double way_m = (to - from).head<3>().norm();
  const double turn_rad = (to - from).tail<3>().norm();
  return static_cast<int>(std::ceil(std::max(way_m / kGrid_m, turn_rad / kGrid_rad)));
}

bool PathFollower::advance(const Vector6& from, const Vector6& to, JointVector& joints,
                           int halvings) {
  SerialChain::InverseParameters parameters;
  parameters.respect_limits = false;
  const auto next = kinematics_.joints(displaced(origin_, to), joints, parameters);
  const bool solved = next.status == SerialChain::InverseStatus::kSolved;
  const JointDifference stride = largest_difference(next.position, joints);
  if (solved && stride.value <= kStride) {
    joints = next.position;
    return true;
  }
  if (halvings == 0) {
    failure_ = {solved ? Status::kJump : Status::kOutOfReach, solved ? stride.joint : -1,
                solved ? stride.value : next.error, to};
    return false;
  }
  const Vector6 middle = 0.5 * (from + to);
  return advance(from, middle, joints, halvings - 1) && advance(middle, to, joints, halvings - 1);
}

}  // namespace tenon::executor

#pragma once
// Follows the tool along a straight line with continuously moving joints: every point of the line
// is solved from its neighbour, so that a pose which has joint positions only on another branch
// counts as out of reach. Set-up code.

#include <cstdint>

#include "executor/motion/tool_kinematics.h"
#include "shared/math/pose.h"

namespace tenon::executor {

class PathFollower {
 public:
  /// Neighbouring points of the grid are at most this far apart.
  static constexpr double kGrid_m = 0.02;
  static constexpr double kGrid_rad = 0.05;
  /// No joint moves further between two solved points, m or rad; the way between two points of the
  /// grid is halved until that holds, at most kHalvings times.
  static constexpr double kStride = 0.1;
  static constexpr int kHalvings = 8;

  enum class Status : std::uint8_t {
    kReached = 0,
    kOutOfReach = 1,  ///< value: error that is left, m or rad
    kJump = 2,        ///< joint: would move by value within the finest halving
  };

  struct Failure {
    Status status = Status::kReached;
    int joint = -1;
    double value = 0.0;
    Vector6 at = Vector6::Zero();  ///< displacement from the origin
  };

  /// @param origin what displacements start from, task frame  @param kinematics outlives this
  PathFollower(const ToolKinematics& kinematics, const Pose& origin)
      : kinematics_(kinematics), origin_(origin) {}

  /// From one displacement of the origin to another; joint limits do not count. Calls
  /// visit(joints) at every point of the grid but the first.
  /// @param joints in: those at `from`; out: those at the last point reached
  template <typename Visit>
  bool follow(const Vector6& from, const Vector6& to, JointVector& joints, Visit visit) {
    const int points = points_between(from, to);
    Vector6 here = from;
    for (int i = 1; i <= points; ++i) {
      const Vector6 next = from + (to - from) * (static_cast<double>(i) / points);
      if (!advance(here, next, joints, kHalvings)) return false;
      visit(joints);
      here = next;
    }
    return true;
  }

  /// Of the last follow() that was false.
  [[nodiscard]] const Failure& failure() const { return failure_; }

 private:
  [[nodiscard]] static int points_between(const Vector6& from, const Vector6& to);
  bool advance(const Vector6& from, const Vector6& to, JointVector& joints, int halvings);

  const ToolKinematics& kinematics_;
  Pose origin_;
  Failure failure_;
};

}  // namespace tenon::executor

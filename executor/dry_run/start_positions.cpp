#include "executor/dry_run/start_positions.h"

#include <algorithm>
#include <cmath>

#include "executor/motion/joint_difference.h"
#include "shared/base/random.h"
#include "shared/base/text.h"

namespace tenon::executor {
namespace {

constexpr int kSeeds = 64;
// Solutions that differ by less than this in every joint are one.
constexpr double kSame = 1e-3;
// A robot without some freedom holds the rest of the pose as well as this.
constexpr double kPosition_m = 1e-6;
constexpr double kAngle_rad = 1e-3;
// Heights that differ by less are equal, m.
constexpr double kSameHeight_m = 1e-3;

// Mean height of an arm's joints above its base.
class Height {
 public:
  explicit Height(const Cell& cell) : up_B_(cell.up_B) {
    Robot part = cell.robot;
    part.flange = {};
    while (!part.joints.empty()) {
      parts_.emplace_back(part);
      part.joints.pop_back();
    }
  }
  [[nodiscard]] double operator()(const JointVector& position) const {
    double sum_m = 0.0;
    for (const SerialChain& part : parts_) sum_m += up_B_.dot(part.flange(position).position_m);
    return sum_m / static_cast<double>(parts_.size());
  }

 private:
  Vector3 up_B_;
  std::vector<SerialChain> parts_;  ///< the arm up to each of its joints
};

double off_middle(const JointVector& position, const Cell& cell) {
  double squares = 0.0;
  for (std::size_t i = 0; i < cell.robot.joints.size(); ++i) {
    const Joint& joint = cell.robot.joints[i];
    const double off =
        (position[i] - 0.5 * (joint.lower + joint.upper)) / (joint.upper - joint.lower);
    squares += off * off;
  }
  return squares;
}

void put_best_first(std::vector<JointVector>& found, const Cell& cell) {
  const Height height_m(cell);
  const auto rank = [&](const JointVector& position) {
    return std::pair(-std::round(height_m(position) / kSameHeight_m), off_middle(position, cell));
  };
  std::sort(found.begin(), found.end(),
            [&](const JointVector& a, const JointVector& b) { return rank(a) < rank(b); });
}

std::string out_of_limits(const JointVector& position, const Cell& cell) {
  for (std::size_t i = 0; i < cell.robot.joints.size(); ++i) {
    const Joint& joint = cell.robot.joints[i];
    const double q = position[i];
    if (q >= joint.lower + kJointMargin && q <= joint.upper - kJointMargin) continue;
    return format("joint %s would be at %.4f %s, must be in [%g, %g] less %g margin",
                  joint.name.c_str(), q, joint_unit(joint), joint.lower, joint.upper, kJointMargin);
  }
  return "no joint positions inside the limits were found";
}

}  // namespace

StartPositions start_positions(const Pose& start, const Cell& cell,
                               const ToolKinematics& kinematics) {
  StartPositions result;
  SerialChain::InverseParameters parameters;
  parameters.limit_margin = kJointMargin;
  double turned_rad = 0.0;
  Random random(1);
  JointVector seed = kinematics.middle();
  for (int attempt = 0; attempt < kSeeds; ++attempt) {
    const auto inverse = kinematics.joints(start, seed, parameters);
    for (std::size_t i = 0; i < cell.robot.joints.size(); ++i) {
      const Joint& joint = cell.robot.joints[i];
      seed[i] = random.uniform(joint.lower, joint.upper);
    }
    if (inverse.status != SerialChain::InverseStatus::kSolved) continue;
    const Vector6 off = displacement_between(kinematics.tool(inverse.position), start);
    if (off.tail<3>().norm() > kAngle_rad || off.head<3>().norm() > kPosition_m) {
      turned_rad = std::max(kAngle_rad, off.tail<3>().norm());
      continue;
    }
    const bool known =
        std::any_of(result.found.begin(), result.found.end(), [&](const JointVector& other) {
          return largest_difference(other, inverse.position).value < kSame;
        });
    if (!known) result.found.push_back(inverse.position);
  }
  put_best_first(result.found, cell);
  if (!result.found.empty()) return result;

  if (turned_rad > 0.0) {
    result.refusal =
        format("the robot's tool is turned by %g rad against it, and the robot moves only %s",
               turned_rad, axis_list(kinematics.axes()).c_str());
    return result;
  }
  parameters.respect_limits = false;
  const auto free = kinematics.joints(start, kinematics.middle(), parameters);
  result.refusal = free.status == SerialChain::InverseStatus::kSolved
                       ? out_of_limits(free.position, cell)
                       : format("%s, off by %g m or rad", to_string(free.status), free.error);
  return result;
}

}  // namespace tenon::executor

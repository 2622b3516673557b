#include "executor/dry_run/step_walk.h"

#include <algorithm>
#include <cmath>
#include <map>

#include "executor/dry_run/start_positions.h"
#include "executor/motion/joint_difference.h"
#include "executor/motion/joint_stop.h"
#include "shared/base/text.h"
#include "shared/motion/path_limits.h"

namespace tenon::executor {
namespace {

// Length of path over which the change of the joints' rates is taken, m or rad.
constexpr double kDifference = 1e-4;
// Two ways to one corner give the same joints, m or rad.
constexpr double kSameCorner = 1e-3;

void keep_largest(JointExtreme& largest, int joint, double value) {
  if (value > largest.value) largest = {joint, value};
}

}  // namespace

StepWalk::StepWalk(const Plan& plan, std::size_t step, const StepReach& reach, const Cell& cell,
                   const ToolKinematics& kinematics)
    : step_(plan.steps[step]),
      set_(plan.parameter_sets[step_.parameter_set]),
      reach_(reach),
      cell_(cell),
      kinematics_(kinematics),
      follower_(kinematics, plan.start),
      ends_(reach.ends.size()),
      compliant_axes_(plan.compliance.compliant_axes) {
  if (cell.joint_torque) torque_map_.emplace(cell);
  demand_.step = step;
  find_ways();
}

// The whole displacement, and what is left of it where held contacts drop axes.
void StepWalk::find_ways() {
  unsigned droppable = 0;
  for (int axis = 0; axis < 6; ++axis) {
    const double way = step_.displacement[axis];
    if (way != 0.0 && reach_.before.has(axis, way > 0.0 ? -1 : +1)) droppable |= 1U << axis;
  }
  for (unsigned dropped = 0; dropped < 64; ++dropped) {
    if ((dropped & ~droppable) != 0) continue;
    Vector6 displacement = step_.displacement;
    for (int axis = 0; axis < 6; ++axis) {
      if ((dropped >> axis & 1U) != 0) displacement[axis] = 0.0;
    }
    const double length = path_length(displacement);
    if (length <= 0.0) continue;
    const PathLimits limits = path_limits(displacement, set_.speeds);
    Way way;
    way.along = displacement / length;
    way.slow = limits.contact_speed;
    way.fast = step_.slow_from_m > 0.0 ? std::max(way.slow, limits.approach_speed) : way.slow;
    way.acceleration = limits.acceleration;
    ways_.push_back(way);
  }
}

std::optional<std::string> StepWalk::run(const JointVector& middle) {
  visit(middle);
  const bool walked = walk_moves(middle) && walk_edges(middle);
  const double share =
      std::max(demand_.speed.value, std::sqrt(demand_.acceleration.value * kShareMax));
  if (share > kShareMax * kPlanRounding) demand_.slow_down = kShareMax / share;
  look_at_limits();
  return verdict(walked);
}

bool StepWalk::follow(const Vector6& from, const Vector6& to, JointVector& joints) {
  if (follower_.follow(from, to, joints, [this](const JointVector& q) { visit(q); })) return true;
  failure_ = follower_.failure();
  return false;
}

bool StepWalk::walk_moves(const JointVector& middle) {
  const Vector6 centre = reach_.begin.centre();
  for (std::size_t i = 0; i < reach_.ends.size(); ++i) {
    const ReachBox& end = reach_.ends[i].box;
    ends_[i] = middle;
    if (!follow(centre, end.centre(), ends_[i])) return false;
    const unsigned extent = reach_.begin.extent() | end.extent();
    for (unsigned pattern = 0; pattern < 64; ++pattern) {
      if ((pattern & ~extent) != 0) continue;
      const Vector6 corner = reach_.begin.corner(pattern);
      JointVector joints = middle;
      if (!follow(centre, corner, joints)) return false;
      if (!follow(corner, end.corner(pattern), joints)) return false;
    }
  }
  return true;
}

bool StepWalk::walk_edges(const JointVector& middle) {
  const ReachBox& box = reach_.swept;
  const unsigned extent = box.extent();
  std::map<unsigned, JointVector> corners;
  for (unsigned pattern = 0; pattern < 64; ++pattern) {
    if ((pattern & ~extent) != 0) continue;
    corners[pattern] = middle;
    if (!follow(reach_.begin.centre(), box.corner(pattern), corners[pattern])) return false;
  }
  for (const auto& [pattern, joints] : corners) {
    for (unsigned edge = 1; edge < 64; edge <<= 1U) {
      if ((extent & edge) == 0 || (pattern & edge) != 0) continue;
      JointVector walked = joints;
      const Vector6 far = box.corner(pattern | edge);
      if (!follow(box.corner(pattern), far, walked)) return false;
      const JointDifference off = largest_difference(walked, corners[pattern | edge]);
      if (off.value <= kSameCorner) continue;
      failure_ = {PathFollower::Status::kJump, off.joint, off.value, far};
      return false;
    }
  }
  return true;
}

void StepWalk::visit(const JointVector& joints) {
  ++demand_.points;
  if (torque_map_) {
    const Vector6 here = TorqueMap::resolution(torque_map_->at(joints), effort_uncertainty(cell_));
    demand_.resolution = demand_.resolution.cwiseMax(here);
  }
  demand_.conditioning = std::min(demand_.conditioning, kinematics_.conditioning(joints));
  if (ways_.empty()) visited_.push_back({joints, {}});
  for (const Way& way : ways_) look_at_rates(joints, way);
}

// With q' and q'' along the path: q. = q' v and q.. = q' a + q'' v^2.
void StepWalk::look_at_rates(const JointVector& joints, const Way& way) {
  const JointVector rates = kinematics_.rates(joints, way.along);
  JointVector ahead = joints;
  for (std::size_t i = 0; i < kMaxJoints; ++i) ahead[i] += kDifference * rates[i];
  const JointVector rates_ahead = kinematics_.rates(ahead, way.along);
  Moving moving{joints, {}};
  for (std::size_t i = 0; i < cell_.robot.joints.size(); ++i) {
    const Joint& limits = cell_.robot.joints[i];
    const int index = static_cast<int>(i);
    const double bend = std::abs(rates_ahead[i] - rates[i]) / kDifference;
    const double rate = std::abs(rates[i]);
    keep_largest(demand_.speed, index, rate * way.fast / limits.speed_max);
    keep_largest(demand_.acceleration, index,
                 (rate * way.acceleration + bend * way.fast * way.fast) / limits.acceleration_max);
    moving.velocity[i] = rates[i] * way.slow;
  }
  visited_.push_back(moving);
}

// The tool may be at contact speed anywhere in its boxes, and the run may have to stop there.
void StepWalk::look_at_limits() {
  for (Moving& moving : visited_) {
    for (double& velocity : moving.velocity) velocity *= demand_.slow_down;
    const JointVector rest = JointStop(moving.position, moving.velocity, cell_.robot).end();
    for (std::size_t i = 0; i < cell_.robot.joints.size(); ++i) {
      const Joint& limits = cell_.robot.joints[i];
      const double margin =
          std::min({rest[i] - limits.lower, limits.upper - rest[i],
                    moving.position[i] - limits.lower, limits.upper - moving.position[i]});
      if (margin >= demand_.limit.value) continue;
      demand_.limit = {static_cast<int>(i), margin};
      demand_.limit_position = moving.position[i];
    }
  }
}

std::optional<std::string> StepWalk::verdict(bool walked) const {
  if (demand_.limit.value < kJointMargin) return too_close();
  if (!walked) return lost_way();
  if (demand_.conditioning < kConditioningMin) {
    return format("near a singularity: conditioning %.3g, must be at least %g; ",
                  demand_.conditioning, kConditioningMin) +
           asked_for(demand_, cell_);
  }
  if (demand_.slow_down < kSlowDownMin) return too_fast();
  return too_coarse();
}

// A contact that is held has to be told from none: off-thresholds are the finest that a step asks.
std::optional<std::string> StepWalk::too_coarse() const {
  if (!torque_map_) return std::nullopt;
  const std::uint8_t axes = compliant_axes_ & set_.sensed_axes;
  for (int axis = 0; axis < 6; ++axis) {
    if ((axes >> axis & 1U) == 0) continue;
    const ContactThresholds& t = set_.thresholds;
    const double asked = axis < 3 ? t.force_off_N : t.torque_off_Nm;
    const double possible = demand_.resolution[axis];
    if (possible <= asked * kPlanRounding) continue;
    const char* unit = axis < 3 ? "N" : "Nm";
    if (!std::isfinite(possible)) {
      return format(
          "the joints' efforts tell nothing about %s, where the step senses; plan with "
          "--cell, or give the cell a sensor",
          axis_name(axis));
    }
    return format(
        "%s_off = %g %s along %s, the joints' efforts resolve %.3g %s there: must be at "
        "least that; plan with --cell",
        axis < 3 ? "force" : "torque", asked, unit, axis_name(axis), possible, unit);
  }
  return std::nullopt;
}

std::string StepWalk::too_close() const {
  const Joint& limits = joint(demand_.limit.joint);
  const double q = demand_.limit_position;
  const double margin = std::min(q - limits.lower, limits.upper - q);
  const std::string stopping = margin < kJointMargin
                                   ? ""
                                   : format(" and would stop %.4f %s further",
                                            margin - demand_.limit.value, joint_unit(limits));
  return format("joint %s would be at %.4f %s%s, must be in [%g, %g] less %g margin",
                limits.name.c_str(), q, joint_unit(limits), stopping.c_str(), limits.lower,
                limits.upper, kJointMargin);
}

std::string StepWalk::lost_way() const {
  const Vector6& at = failure_.at;
  const std::string where = format("(%.3f, %.3f, %.3f) m from the start", at[0], at[1], at[2]);
  if (failure_.status == PathFollower::Status::kJump) {
    const Joint& jumping = joint(failure_.joint);
    return format("joint %s would jump by %.3g %s %s: the way there passes a singularity",
                  jumping.name.c_str(), failure_.value, joint_unit(jumping), where.c_str());
  }
  const std::string before =
      demand_.slow_down < 1.0 ? "; on the way there " + asked_for(demand_, cell_) : "";
  return format("the tool %s is out of continuous reach by %.3g m or rad%s", where.c_str(),
                failure_.value, before.c_str());
}

std::string StepWalk::too_fast() const {
  return asked_for(demand_, cell_) +
         format(": the step would have to run at %.3g of its speed, at least %g is allowed",
                demand_.slow_down, kSlowDownMin);
}

std::string asked_for(const StepDemand& demand, const Cell& cell) {
  const double share = demand.speed.value;
  const bool by_speed = share * share >= demand.acceleration.value * StepWalk::kShareMax;
  const JointExtreme& worst = by_speed ? demand.speed : demand.acceleration;
  const Joint& joint = cell.robot.joints[static_cast<std::size_t>(worst.joint)];
  const double most = by_speed ? joint.speed_max : joint.acceleration_max;
  return format("joint %s is asked for %.4g %s/s%s, its limit is %g", joint.name.c_str(),
                worst.value * most, joint_unit(joint), by_speed ? "" : "^2", most);
}

}  // namespace tenon::executor

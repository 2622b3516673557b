#include "hw/mit/gravity.h"

namespace tenon::hw::mit {
namespace {

constexpr double kGravity_mps2 = 9.80665;

}  // namespace

Gravity::Gravity(const Cell& cell)
    : count_(cell.robot.joints.size()), lift_mps2_(kGravity_mps2 * cell.up_B) {
  for (std::size_t i = 0; i < count_; ++i) {
    const Joint& joint = cell.robot.joints[i];
    links_[i] = {joint.origin, joint.axis, joint.kind == Joint::Kind::kRevolute, joint.link.mass_kg,
                 joint.link.mass_kg * joint.link.com_m};
  }
  if (count_ == 0) return;
  Link& last = links_[count_ - 1];
  const Pose X_LS = compose(cell.robot.flange, cell.X_FS);
  const Vector3 payload_m = X_LS.position_m + X_LS.orientation * cell.payload_com_m;
  last.mass_kg += cell.payload_mass_kg;
  last.moment_kgm += cell.payload_mass_kg * payload_m;
}

// From the tool to the base: what is beyond a joint, as one mass and its moment about the base.
JointVector Gravity::holding_effort(const JointVector& position) const noexcept {
  std::array<Vector3, kMaxJoints> axis{};
  std::array<Vector3, kMaxJoints> anchor_m{};
  std::array<Vector3, kMaxJoints> moment_kgm{};
  Pose X_BL;
  for (std::size_t i = 0; i < count_; ++i) {
    const Link& link = links_[i];
    X_BL = compose(X_BL, link.origin);
    axis[i] = X_BL.orientation * link.axis;
    anchor_m[i] = X_BL.position_m;
    if (link.revolute) {
      const Eigen::Quaterniond turn(Eigen::AngleAxisd(position[i], link.axis));
      X_BL.orientation = (X_BL.orientation * turn).normalized();
    } else {
      X_BL.position_m += position[i] * axis[i];
    }
    moment_kgm[i] = link.mass_kg * X_BL.position_m + X_BL.orientation * link.moment_kgm;
  }
  JointVector effort{};
  double mass_kg = 0.0;
  Vector3 beyond_kgm = Vector3::Zero();
  for (std::size_t i = count_; i-- > 0;) {
    mass_kg += links_[i].mass_kg;
    beyond_kgm += moment_kgm[i];
    const Vector3 lever_kgm = beyond_kgm - mass_kg * anchor_m[i];
    effort[i] = links_[i].revolute ? axis[i].dot(lever_kgm.cross(lift_mps2_))
                                   : mass_kg * axis[i].dot(lift_mps2_);
  }
  return effort;
}

}  // namespace tenon::hw::mit

#include "shared/kinematics/inverse_dynamics.h"

namespace tenon {
namespace {

constexpr double kGravity_mps2 = 9.80665;

/// The link with a point mass fixed to it.
LinkInertia with_point(const LinkInertia& link, double mass_kg, const Vector3& at_m) {
  LinkInertia both;
  both.mass_kg = link.mass_kg + mass_kg;
  if (!(both.mass_kg > 0.0)) return link;
  both.com_m = (link.mass_kg * link.com_m + mass_kg * at_m) / both.mass_kg;
  const auto about_com = [&](double part_kg, const Vector3& part_m) {
    const Vector3 off_m = part_m - both.com_m;
    return Eigen::Matrix3d(
        part_kg * (off_m.squaredNorm() * Eigen::Matrix3d::Identity() - off_m * off_m.transpose()));
  };
  both.inertia_kgm2 =
      link.inertia_kgm2 + about_com(link.mass_kg, link.com_m) + about_com(mass_kg, at_m);
  return both;
}

}  // namespace

InverseDynamics::InverseDynamics(const Cell& cell)
    : count_(cell.robot.joints.size()), lift_mps2_(kGravity_mps2 * cell.up_B) {
  for (std::size_t i = 0; i < count_; ++i) {
    const Joint& joint = cell.robot.joints[i];
    links_[i] = {joint.origin, joint.axis, joint.kind == Joint::Kind::kRevolute, joint.link};
  }
  if (count_ == 0) return;
  const Pose X_LS = compose(cell.robot.flange, cell.X_FS);
  LinkInertia& last = links_[count_ - 1].inertia;
  last = with_point(last, cell.payload_mass_kg,
                    X_LS.position_m + X_LS.orientation * cell.payload_com_m);
}

// `moving` holds the link before and becomes this one.
void InverseDynamics::move(const Link& link, double position, double velocity, double acceleration,
                           Eigen::Matrix3d& orientation, Moving& moving) const noexcept {
  const Vector3 omega = moving.omega_radps;
  const Vector3 alpha = moving.alpha_radps2;
  Vector3 way_m = orientation * link.origin.position_m;
  orientation = orientation * link.origin.orientation.toRotationMatrix();
  moving.axis = orientation * link.axis;
  if (!link.revolute) way_m += position * moving.axis;
  moving.origin_m += way_m;
  moving.acceleration_mps2 += alpha.cross(way_m) + omega.cross(omega.cross(way_m));
  if (link.revolute) {
    orientation = orientation * Eigen::AngleAxisd(position, link.axis).toRotationMatrix();
    moving.alpha_radps2 += acceleration * moving.axis + velocity * omega.cross(moving.axis);
    moving.omega_radps += velocity * moving.axis;
  } else {
    moving.acceleration_mps2 +=
        acceleration * moving.axis + 2.0 * velocity * omega.cross(moving.axis);
  }
  const Vector3& w = moving.omega_radps;
  moving.com_m = orientation * link.inertia.com_m;
  moving.force_N =
      link.inertia.mass_kg * (moving.acceleration_mps2 + moving.alpha_radps2.cross(moving.com_m) +
                              w.cross(w.cross(moving.com_m)));
  const Eigen::Matrix3d inertia = orientation * link.inertia.inertia_kgm2 * orientation.transpose();
  moving.torque_Nm = inertia * moving.alpha_radps2 + w.cross(inertia * w);
}

JointVector InverseDynamics::effort(const JointVector& position, const JointVector& velocity,
                                    const JointVector& acceleration) const noexcept {
  std::array<Moving, kMaxJoints> links;
  Eigen::Matrix3d orientation = Eigen::Matrix3d::Identity();
  const Vector3 zero = Vector3::Zero();
  Moving moving{zero, zero, zero, zero, lift_mps2_, zero, zero, zero};
  for (std::size_t i = 0; i < count_; ++i) {
    move(links_[i], position[i], velocity[i], acceleration[i], orientation, moving);
    links[i] = moving;
  }
  JointVector effort{};
  Vector3 force_N = zero;
  Vector3 torque_Nm = zero;  // about the origin of the link that was last
  Vector3 about_m = zero;
  for (std::size_t i = count_; i-- > 0;) {
    const Moving& link = links[i];
    torque_Nm += (about_m - link.origin_m).cross(force_N);
    about_m = link.origin_m;
    force_N += link.force_N;
    torque_Nm += link.torque_Nm + link.com_m.cross(link.force_N);
    effort[i] = link.axis.dot(links_[i].revolute ? torque_Nm : force_N);
  }
  return effort;
}

}  // namespace tenon

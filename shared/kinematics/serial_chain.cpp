#include "shared/kinematics/serial_chain.h"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <string>

#include "shared/base/error.h"

namespace tenon {
namespace {

// One iteration moves no joint further than this, m or rad: a linear model is worth no more.
constexpr double kStepMax = 0.5;
// Damping relative to the squared error, and what is left of it at the solution.
constexpr double kDamping = 1e-3;
constexpr double kDampingFloor = 1e-18;
// A unit motion counts as possible where the joints reproduce it this well.
constexpr double kFreeAxisError = 1e-6;
// Squared singular values below this share of the largest are rounding.
constexpr double kNoMotion = 1e-12;

bool finite(const Pose& pose) {
  return pose.position_m.allFinite() && pose.orientation.coeffs().allFinite();
}

}  // namespace

SerialChain::SerialChain(const Robot& robot) : count_(robot.joints.size()), flange_(robot.flange) {
  if (count_ == 0 || count_ > kMaxJoints) {
    throw InputError("robot '" + robot.name + "' has " + std::to_string(count_) +
                     " joints, must be in 1.." + std::to_string(kMaxJoints));
  }
  for (std::size_t i = 0; i < count_; ++i) {
    const Joint& joint = robot.joints[i];
    links_[i] = {joint.origin, joint.axis.normalized(), joint.kind == Joint::Kind::kRevolute,
                 joint.lower, joint.upper};
  }
}

Pose SerialChain::flange(const JointVector& position) const {
  Pose pose;
  for (std::size_t i = 0; i < count_; ++i) {
    const Link& link = links_[i];
    pose = compose(pose, link.origin);
    if (link.revolute) {
      pose.orientation = (pose.orientation * rotation_of(position[i] * link.axis)).normalized();
    } else {
      pose.position_m += pose.orientation * (position[i] * link.axis);
    }
  }
  return compose(pose, flange_);
}

SerialChain::Jacobian SerialChain::jacobian(const JointVector& position) const {
  Jacobian jacobian = Jacobian::Zero();
  const Vector3 end_m = flange(position).position_m;
  Pose pose;
  for (std::size_t i = 0; i < count_; ++i) {
    const Link& link = links_[i];
    const auto column = static_cast<int>(i);
    pose = compose(pose, link.origin);
    const Vector3 axis = pose.orientation * link.axis;
    if (link.revolute) {
      jacobian.col(column) << axis.cross(end_m - pose.position_m), axis;
      pose.orientation = (pose.orientation * rotation_of(position[i] * link.axis)).normalized();
    } else {
      jacobian.col(column).head<3>() = axis;
      pose.position_m += position[i] * axis;
    }
  }
  return jacobian;
}

SerialChain::Inverse SerialChain::inverse(const Pose& flange_goal, const JointVector& seed,
                                          const InverseParameters& parameters) const {
  Inverse result;
  result.position = seed;
  const bool seed_finite = std::all_of(seed.begin(), seed.begin() + static_cast<long>(count_),
                                       [](double q) { return std::isfinite(q); });
  if (!finite(flange_goal) || !seed_finite) {
    result.status = InverseStatus::kNotFinite;
    return result;
  }
  // The index of the last joint that a limit holds back, or -1.
  const auto keep_limits = [&] {
    int held_back = -1;
    for (std::size_t i = 0; parameters.respect_limits && i < count_; ++i) {
      const double lower = links_[i].lower + parameters.limit_margin;
      const double upper = links_[i].upper - parameters.limit_margin;
      double& q = result.position[i];
      if (q >= lower && q <= upper) continue;
      held_back = static_cast<int>(i);
      q = q < lower ? lower : upper;
    }
    return held_back;
  };
  result.joint = keep_limits();
  for (; result.iterations <= parameters.iterations_max; ++result.iterations) {
    Vector6 error = displacement_between(flange(result.position), flange_goal);
    for (int axis = 0; axis < 6; ++axis) {
      if ((parameters.axes >> axis & 1U) == 0) error[axis] = 0.0;
    }
    result.error = error.lpNorm<Eigen::Infinity>();
    if (result.error <= parameters.tolerance) {
      result.joint = -1;
      result.status = InverseStatus::kSolved;
      return result;
    }
    if (result.iterations == parameters.iterations_max) break;

    Jacobian J = jacobian(result.position);
    for (int axis = 0; axis < 6; ++axis) {
      if ((parameters.axes >> axis & 1U) == 0) J.row(axis).setZero();
    }
    Eigen::Matrix<double, 6, 6> normal = J * J.transpose();
    normal.diagonal().array() += kDamping * error.squaredNorm() + kDampingFloor;
    const Eigen::Matrix<double, static_cast<int>(kMaxJoints), 1> step =
        J.transpose() * normal.ldlt().solve(error);
    const double largest = step.lpNorm<Eigen::Infinity>();
    const double scale = largest > kStepMax ? kStepMax / largest : 1.0;
    for (std::size_t i = 0; i < count_; ++i) {
      result.position[i] += scale * step[static_cast<int>(i)];
    }
    result.joint = keep_limits();
  }
  result.status = result.joint >= 0 ? InverseStatus::kJointLimit : InverseStatus::kNotConverged;
  return result;
}

std::uint8_t SerialChain::free_axes(const JointVector& position) const {
  using Square = Eigen::Matrix<double, 6, 6>;
  const Jacobian J = jacobian(position);
  const Square squared = J * J.transpose();
  // Its eigenvectors with a value span all twists that the joints can make.
  const Eigen::SelfAdjointEigenSolver<Square> solver(squared);
  Square possible = Square::Zero();
  for (int i = 0; i < 6; ++i) {
    if (solver.eigenvalues()[i] <= kNoMotion * solver.eigenvalues()[5]) continue;
    possible += solver.eigenvectors().col(i) * solver.eigenvectors().col(i).transpose();
  }
  std::uint8_t axes = 0;
  for (int axis = 0; axis < 6; ++axis) {
    const Vector6 left = possible.col(axis) - Vector6::Unit(axis);
    if (left.norm() < kFreeAxisError) axes |= static_cast<std::uint8_t>(1U << axis);
  }
  return axes;
}

const char* to_string(SerialChain::InverseStatus status) {
  switch (status) {
    case SerialChain::InverseStatus::kSolved:
      return "solved";
    case SerialChain::InverseStatus::kJointLimit:
      return "a joint limit is in the way";
    case SerialChain::InverseStatus::kNotConverged:
      return "out of reach";
    case SerialChain::InverseStatus::kNotFinite:
      return "not a finite pose";
  }
  return "?";
}

}  // namespace tenon

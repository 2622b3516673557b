#pragma once
// From efforts that the joints feel to the wrench at the tool tip that makes them: J^T w = tau,
// solved by damped least squares along what the arm resolves at that position; and from what is
// uncertain of the efforts to what is of the wrench. Owns a copy of what it needs; no allocation,
// fit for real time and any thread.

#include <cstdint>
#include <string>

#include "shared/cell/cell.h"
#include "shared/kinematics/serial_chain.h"

namespace tenon {

class TorqueMap {
 public:
  using ToWrench = Eigen::Matrix<double, 6, static_cast<int>(kMaxJoints)>;

  /// A metre of lever that a radian counts for.
  static constexpr double kLever_m = 0.3;
  /// An axis of which less comes back is not resolved.
  static constexpr double kShareLeast = 0.9;

  /// @throws InputError for a robot without joints
  explicit TorqueMap(const Cell& cell);

  struct At {
    ToWrench to_wrench = ToWrench::Zero();  ///< efforts to N and Nm, task axes at the tool tip
    ToWrench jacobian = ToWrench::Zero();   ///< of the tool tip, task axes: its transpose back
    std::uint8_t axes = 0;                  ///< bit a: axis a (x y z rx ry rz) is resolved
  };
  [[nodiscard]] At at(const JointVector& position) const noexcept;

  /// What the wrench may be off by where every effort is off by so much, whichever way, N and Nm;
  /// infinite where an axis is not resolved.
  [[nodiscard]] static Vector6 resolution(const At& at, const JointVector& effort) noexcept;

  /// Tool frame in the task frame.
  [[nodiscard]] Pose tool(const JointVector& position) const;

 private:
  SerialChain chain_;
  Pose X_TB_;
  Pose X_FP_;
};

/// What stays unknown of each joint's effort, N or Nm: what friction's identification left, or, of
/// one not identified, all that it may be.
[[nodiscard]] JointVector effort_uncertainty(const Cell& cell);

/// "x 0.93 N, y 0.95 N, z 1.2 N; not: rx ry rz"
[[nodiscard]] std::string resolution_text(const Vector6& resolution);

}  // namespace tenon

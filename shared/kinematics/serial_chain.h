#pragma once
// Kinematics of a serial arm: where the flange is, how it moves with the joints, and the way back.
// Knows neither time nor dynamics. Owns a copy of what it needs of the robot; no allocation after
// construction, so every function is fit for real time and for any thread.

#include <array>
#include <cstddef>
#include <cstdint>

#include "shared/cell/robot.h"
#include "shared/math/pose.h"
#include "shared/ports/arm.h"

namespace tenon {

class SerialChain {
 public:
  /// Column i: twist of the flange [m/s, rad/s] in base axes at the flange's origin for unit speed
  /// of joint i. Columns of joints that the robot lacks are zero.
  using Jacobian = Eigen::Matrix<double, 6, static_cast<int>(kMaxJoints)>;

  static constexpr std::uint8_t kAllAxes = 0x3F;

  struct InverseParameters {
    /// Bit a (x y z rx ry rz, base axes): this error of the flange counts, the others are ignored.
    std::uint8_t axes = kAllAxes;
    double tolerance = 1e-9;  ///< on each counted error, m or rad
    int iterations_max = 40;
    bool respect_limits = true;
    double limit_margin = 0.0;  ///< m or rad kept to every joint limit
  };

  enum class InverseStatus : std::uint8_t {
    kSolved = 0,
    kJointLimit = 1,    ///< stuck with a joint at its limit; `joint` says which
    kNotConverged = 2,  ///< out of reach, or too far from the seed
    kNotFinite = 3,     ///< NaN or infinity in goal or seed
  };

  struct Inverse {
    InverseStatus status = InverseStatus::kNotConverged;
    JointVector position{};  ///< the best found
    int joint = -1;          ///< for kJointLimit
    double error = 0.0;      ///< largest counted error left, m or rad
    int iterations = 0;
  };

  /// @throws InputError for no joints or more than kMaxJoints.
  explicit SerialChain(const Robot& robot);

  [[nodiscard]] std::size_t joint_count() const { return count_; }

  /// Flange in the base frame.
  [[nodiscard]] Pose flange(const JointVector& position) const;

  [[nodiscard]] Jacobian jacobian(const JointVector& position) const;

  /// Damped least squares from a seed: the damping shrinks with the error, so that the last steps
  /// are Newton's. A bounded number of iterations of fixed cost.
  [[nodiscard]] Inverse inverse(const Pose& flange, const JointVector& seed,
                                const InverseParameters& parameters) const;

  /// Axes (bits as in InverseParameters::axes) along which the flange can move by itself at this
  /// position, no other axis moving: three linear axes give 0x07, a dexterous arm 0x3F.
  [[nodiscard]] std::uint8_t free_axes(const JointVector& position) const;

 private:
  struct Link {
    Pose origin;
    Vector3 axis = Vector3::UnitX();
    bool revolute = false;
    double lower = 0.0;
    double upper = 0.0;
  };

  std::array<Link, kMaxJoints> links_{};
  std::size_t count_ = 0;
  Pose flange_;
};

[[nodiscard]] const char* to_string(SerialChain::InverseStatus status);

}  // namespace tenon

// Poses and displacements against 4x4 matrices and closed forms.

#include "shared/math/pose.h"

#include <gtest/gtest.h>

#include <numbers>
#include <random>

namespace tenon {
namespace {

Eigen::Matrix4d matrix_of(const Pose& pose) {
  Eigen::Matrix4d matrix = Eigen::Matrix4d::Identity();
  matrix.topLeftCorner<3, 3>() = pose.orientation.toRotationMatrix();
  matrix.topRightCorner<3, 1>() = pose.position_m;
  return matrix;
}

class RandomPoses {
 public:
  Vector3 vector(double magnitude) {
    return magnitude * Vector3(unit_(random_), unit_(random_), unit_(random_));
  }
  Pose pose() { return {vector(2.0), rotation_of(vector(1.8))}; }

 private:
  std::mt19937 random_{3};
  std::uniform_real_distribution<double> unit_{-1.0, 1.0};
};

TEST(Pose, ComposeAndInverseAreThoseOfMatrices) {
  RandomPoses random;
  for (int i = 0; i < 200; ++i) {
    const Pose a = random.pose();
    const Pose b = random.pose();
    EXPECT_TRUE(matrix_of(compose(a, b)).isApprox(matrix_of(a) * matrix_of(b), 1e-12));
    EXPECT_TRUE(matrix_of(inverse(a)).isApprox(matrix_of(a).inverse(), 1e-12));
  }
}

TEST(Pose, RotationVectorGoesThereAndBackAtEverySize) {
  RandomPoses random;
  for (const double angle_rad :
       {0.0, 1e-300, 1e-12, 1e-9, 1e-6, 1e-3, 1.0, 3.0, std::numbers::pi - 1e-9}) {
    for (int i = 0; i < 50; ++i) {
      const Vector3 vector = angle_rad * random.vector(1.0).normalized();
      const Vector3 back = rotation_vector(rotation_of(vector));
      EXPECT_LE((back - vector).norm(), 1e-14 + 1e-12 * angle_rad) << angle_rad;
    }
  }
}

TEST(Pose, RotationVectorIgnoresTheSignOfTheQuaternion) {
  const Eigen::Quaterniond turn = rotation_of({0.4, -1.0, 2.0});
  const Eigen::Quaterniond same(-turn.w(), -turn.x(), -turn.y(), -turn.z());
  EXPECT_EQ(rotation_vector(turn), rotation_vector(same));
}

TEST(Pose, HalfATurnHasTheAngleOfHalfATurn) {
  EXPECT_NEAR(rotation_vector(Eigen::Quaterniond(0.0, 0.0, 1.0, 0.0)).norm(), std::numbers::pi,
              1e-15);
}

TEST(Pose, QuarterTurnAboutZTakesXToY) {
  const Eigen::Quaterniond turn = rotation_of({0.0, 0.0, std::numbers::pi / 2});
  EXPECT_TRUE((turn * Vector3::UnitX()).isApprox(Vector3::UnitY(), 1e-15));
}

TEST(Pose, DisplacementTakesOnePoseToTheOther) {
  RandomPoses random;
  for (int i = 0; i < 200; ++i) {
    const Pose from = random.pose();
    const Pose to = random.pose();
    const Pose there = displaced(from, displacement_between(from, to));
    EXPECT_TRUE(matrix_of(there).isApprox(matrix_of(to), 1e-12));
  }
}

TEST(Pose, DisplacementIsInTheAxesOfTheCommonFrame) {
  // A tool that is turned a quarter about z: moving it along the frame's x is still x.
  const Pose from{Vector3(1.0, 2.0, 3.0), rotation_of({0.0, 0.0, std::numbers::pi / 2})};
  Vector6 displacement;
  displacement << 0.1, 0.0, 0.0, 0.2, 0.0, 0.0;
  const Pose to = displaced(from, displacement);
  EXPECT_TRUE(to.position_m.isApprox(Vector3(1.1, 2.0, 3.0)));
  EXPECT_TRUE(to.orientation.toRotationMatrix().isApprox(
      rotation_of({0.2, 0.0, 0.0}).toRotationMatrix() * from.orientation.toRotationMatrix(),
      1e-14));
}

TEST(Pose, TranslationLeavesTheOrientationBitForBit) {
  RandomPoses random;
  const Pose from = random.pose();
  Vector6 displacement = Vector6::Zero();
  displacement[1] = 0.3;
  EXPECT_EQ(displaced(from, displacement).orientation.coeffs(), from.orientation.coeffs());
}

}  // namespace
}  // namespace tenon

#include "shared/motion/path_limits.h"

#include <gtest/gtest.h>

namespace tenon {
namespace {

SpeedLimits limits() {
  SpeedLimits v;
  v.approach_mps = 0.4;
  v.contact_mps = 0.1;
  v.acceleration_mps2 = 2.0;
  v.jerk_mps3 = 30.0;
  v.approach_radps = 0.8;
  v.contact_radps = 0.3;
  v.acceleration_radps2 = 5.0;
  v.jerk_radps3 = 60.0;
  return v;
}

void expect_limits(const Vector6& displacement, const PathLimits& expected) {
  const PathLimits path = path_limits(displacement, limits());
  EXPECT_EQ(path.approach_speed, expected.approach_speed);
  EXPECT_EQ(path.contact_speed, expected.contact_speed);
  EXPECT_EQ(path.acceleration, expected.acceleration);
  EXPECT_EQ(path.jerk, expected.jerk);
}

TEST(PathLimits, ATranslationHasTheLinearOnes) {
  const Vector6 displacement{{0.3, 0.0, -0.4, 0.0, 0.0, 0.0}};
  EXPECT_DOUBLE_EQ(path_length(displacement), 0.5);
  expect_limits(displacement, {0.4, 0.1, 2.0, 30.0});
}

TEST(PathLimits, ARotationHasTheAngularOnes) {
  const Vector6 displacement{{0.0, 0.0, 0.0, 0.0, -0.2, 0.0}};
  EXPECT_DOUBLE_EQ(path_length(displacement), 0.2);
  expect_limits(displacement, {0.8, 0.3, 5.0, 60.0});
}

// 0.5 m while it turns by 1 rad: each metre is 2 rad, so 0.8 rad/s are 0.4 m/s and 0.3 are 0.15.
TEST(PathLimits, OfBothTheTighterHoldsForEachLimit) {
  const Vector6 displacement{{0.5, 0.0, 0.0, 0.0, 0.0, 1.0}};
  EXPECT_DOUBLE_EQ(path_length(displacement), 0.5);
  expect_limits(displacement, {0.4, 0.1, 2.0, 30.0});
  const Vector6 tighter{{0.5, 0.0, 0.0, 0.0, 0.0, 2.0}};
  EXPECT_DOUBLE_EQ(path_limits(tighter, limits()).contact_speed, 0.075);
  EXPECT_DOUBLE_EQ(path_limits(tighter, limits()).jerk, 15.0);
}

TEST(PathLimits, LessThanANanometreIsNoMotion) {
  const Vector6 displacement{{1e-10, 0.0, 0.0, 0.0, 1e-10, 0.0}};
  EXPECT_EQ(path_length(displacement), 0.0);
}

}  // namespace
}  // namespace tenon

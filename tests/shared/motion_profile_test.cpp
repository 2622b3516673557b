// The two-speed profile: closed forms, and its limits under finite differences.

#include "shared/motion/motion_profile.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

namespace tenon {
namespace {

using Parameters = MotionProfile::Parameters;
using Sample = MotionProfile::Sample;

std::string describe(const Parameters& p) {
  return "length " + std::to_string(p.length) + " slow_from " + std::to_string(p.slow_from) +
         " speeds " + std::to_string(p.fast_speed) + " " + std::to_string(p.slow_speed) +
         " acceleration " + std::to_string(p.acceleration) + " jerk " + std::to_string(p.jerk);
}

std::vector<Parameters> many() {
  std::vector<Parameters> all;
  for (const double length : {1e-9, 1e-5, 1e-3, 0.01, 0.1, 1.0}) {
    for (const double slow_share : {0.0, 0.05, 0.5, 0.95, 1.0, 2.0}) {
      for (const double fast_speed : {0.02, 0.1, 0.5}) {
        for (const double acceleration : {0.5, 1.0, 10.0}) {
          all.push_back({length, slow_share * length, fast_speed, 0.05, acceleration, 20.0});
        }
      }
    }
  }
  return all;
}

TEST(MotionProfile, StartsAtRestAndEndsAtRestAtItsLength) {
  for (const Parameters& p : many()) {
    const MotionProfile profile(p);
    for (const double before_s : {-1.0, 0.0}) {
      EXPECT_EQ(profile.at(before_s).position, 0.0) << describe(p);
      EXPECT_EQ(profile.at(before_s).velocity, 0.0) << describe(p);
    }
    for (const double after_s : {0.0, 1.0}) {
      const Sample end = profile.at(profile.duration_s() + after_s);
      EXPECT_EQ(end.position, p.length) << describe(p);
      EXPECT_EQ(end.velocity, 0.0) << describe(p);
      EXPECT_EQ(end.acceleration, 0.0) << describe(p);
    }
    // And it arrives there, instead of jumping.
    const Sample last = profile.at(profile.duration_s() * (1.0 - 1e-12));
    EXPECT_NEAR(last.position, p.length, 1e-9 * p.length) << describe(p);
    EXPECT_NEAR(last.velocity, 0.0, 1e-5) << describe(p);
  }
}

TEST(MotionProfile, KeepsItsLimitsUnderFiniteDifferences) {
  constexpr int kSamples = 2000;
  for (const Parameters& p : many()) {
    const MotionProfile profile(p);
    const double h_s = profile.duration_s() / kSamples;
    const double top_speed = std::max(p.fast_speed, p.slow_speed);
    for (int i = 1; i < kSamples; ++i) {
      const double t_s = i * h_s;
      const Sample before = profile.at(t_s - h_s);
      const Sample now = profile.at(t_s);
      const Sample after = profile.at(t_s + h_s);
      ASSERT_LE(now.velocity, top_speed * (1 + 1e-9)) << describe(p);
      ASSERT_GE(now.velocity, -1e-9) << describe(p);
      ASSERT_LE(std::abs(now.acceleration), p.acceleration * (1 + 1e-9)) << describe(p);
      ASSERT_LE(std::abs(after.acceleration - now.acceleration), p.jerk * h_s * (1 + 1e-6) + 1e-9)
          << describe(p);
      // Velocity and acceleration are derivatives: a difference is off by the jerk's share alone.
      ASSERT_NEAR((after.position - before.position) / (2 * h_s), now.velocity,
                  p.jerk * h_s * h_s / 6 + 1e-9)
          << describe(p);
      ASSERT_NEAR((after.velocity - before.velocity) / (2 * h_s), now.acceleration,
                  p.jerk * h_s / 2 + 1e-6)
          << describe(p);
    }
  }
}

TEST(MotionProfile, IsDownToTheSlowSpeedBySlowFrom) {
  int fast = 0;
  for (const Parameters& p : many()) {
    const MotionProfile profile(p);
    for (int i = 0; i <= 1000; ++i) {
      const Sample sample = profile.at(i * profile.duration_s() / 1000);
      if (sample.position >= p.slow_from) {
        ASSERT_LE(sample.velocity, p.slow_speed * (1 + 1e-6)) << describe(p);
      } else {
        fast += sample.velocity > 1.01 * p.slow_speed ? 1 : 0;
      }
    }
  }
  EXPECT_GT(fast, 1000) << "no profile used its fast speed";
}

// Full speed, full acceleration: L/v + v/a + a/j.
TEST(MotionProfile, LongMoveTakesTheTimeOfTheClosedForm) {
  const MotionProfile profile({0.1, 0.0, 0.05, 0.05, 0.5, 20.0});
  EXPECT_NEAR(profile.duration_s(), 0.1 / 0.05 + 0.05 / 0.5 + 0.5 / 20.0, 1e-12);
}

// Two speeds: each ramp covers its mean speed times its time, the rest is cruised.
TEST(MotionProfile, TwoSpeedMoveTakesTheTimeOfTheClosedForm) {
  const MotionProfile profile({0.5, 0.4, 0.1, 0.05, 0.5, 20.0});
  const double up_s = 0.1 / 0.5 + 0.5 / 20.0;
  const double down_s = 0.05 / 0.5 + 0.5 / 20.0;
  const double fast_s = (0.4 - 0.05 * up_s - 0.075 * down_s) / 0.1;
  const double slow_s = (0.1 - 0.025 * down_s) / 0.05;
  EXPECT_NEAR(profile.duration_s(), up_s + fast_s + down_s + slow_s + down_s, 1e-12);
}

// Too short for any limit but the jerk: four equal pieces of cbrt(L / 2j).
TEST(MotionProfile, ShortMoveIsLimitedByJerkAlone) {
  const MotionProfile profile({1e-5, 0.0, 0.05, 0.05, 1.0, 20.0});
  EXPECT_NEAR(profile.duration_s(), 4 * std::cbrt(1e-5 / 40.0), 1e-9);
}

TEST(MotionProfile, NoLengthIsNoTime) {
  EXPECT_EQ(MotionProfile({0.0, 0.0, 0.1, 0.05, 1.0, 20.0}).duration_s(), 0.0);
  EXPECT_EQ(MotionProfile().duration_s(), 0.0);
}

}  // namespace
}  // namespace tenon

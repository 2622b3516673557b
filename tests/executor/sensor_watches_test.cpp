// Whether a sensor measures, its zero stays and an encoder tells what can be: each watch by itself,
// against the noise and the motion of an arm that is well.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "executor/sensing/drift_watch.h"
#include "executor/sensing/encoder_watch.h"
#include "executor/sensing/frozen_watch.h"
#include "shared/base/random.h"
#include "tests/support/hand_made.h"

namespace tenon::executor {
namespace {

ForceTorqueSensor sensor(double noise_counts) {
  ForceTorqueSensor sensor;
  sensor.force_per_count_N = 0.01;
  sensor.torque_per_count_Nm = 0.0005;
  sensor.force_noise_N = noise_counts * sensor.force_per_count_N;
  sensor.torque_noise_Nm = noise_counts * sensor.torque_per_count_Nm;
  return sensor;
}

/// As such a sensor reads it, rounded to its counts.
Vector6 reading(const ForceTorqueSensor& sensor, Random& random) {
  Vector6 sample;
  for (int axis = 0; axis < 6; ++axis) {
    const double noise = axis < 3 ? sensor.force_noise_N : sensor.torque_noise_Nm;
    const double per_count = axis < 3 ? sensor.force_per_count_N : sensor.torque_per_count_Nm;
    sample[axis] = per_count * std::round(noise * random.normal() / per_count);
  }
  return sample;
}

TEST(FrozenWatch, TheSeventhEqualSampleIsNamedWhileTheCounterRuns) {
  FrozenWatch watch(sensor(10.0));
  ASSERT_TRUE(watch.watches());
  const Vector6 same = Vector6::Constant(1.0);
  for (std::uint16_t counter = 1; counter < kFrozenSamples; ++counter) {
    EXPECT_FALSE(watch.update(same, counter)) << counter;
  }
  const auto frozen = watch.update(same, kFrozenSamples);
  ASSERT_TRUE(frozen);
  EXPECT_EQ(frozen->axis, -1) << "all of them";
  EXPECT_EQ(frozen->samples, kFrozenSamples);
  EXPECT_FALSE(watch.update(same, kFrozenSamples)) << "a counter that stands is another fault";
}

// A tenth of the noise of the data sheet is one count: the noisiest case of equal samples.
TEST(FrozenWatch, ASensorThatIsTenTimesQuieterThanItsSheetIsNotNamed) {
  FrozenWatch watch(sensor(10.0));
  const ForceTorqueSensor quiet = sensor(1.0);
  Random random(7);
  for (int sample = 0; sample < 1'000'000; ++sample) {
    ASSERT_FALSE(watch.update(reading(quiet, random), static_cast<std::uint16_t>(sample)));
  }
}

TEST(FrozenWatch, WhereNoiseIsBelowACountEqualSamplesTellNothing) {
  for (const double counts : {0.0, 1.0, 4.0}) {
    FrozenWatch watch(sensor(counts));
    EXPECT_FALSE(watch.watches()) << counts;
    for (std::uint16_t counter = 0; counter < 100; ++counter) {
      EXPECT_FALSE(watch.update(Vector6::Zero(), counter));
    }
  }
}

// A tenth of the sheet's noise is one count: an axis may stand at it for 30 pairs.
TEST(FrozenWatch, AnAxisThatStandsWhileTheOthersMeasureIsNamed) {
  for (const int dead : {0, 2, 4}) {
    FrozenWatch watch(sensor(10.0));
    const ForceTorqueSensor alive = sensor(10.0);
    Random random(5);
    constexpr int kDies = 1000;
    int named_at = 0;
    for (int sample = 0; sample < 2000 && named_at == 0; ++sample) {
      Vector6 wrench = reading(alive, random);
      if (sample >= kDies) wrench[dead] = 0.25;
      const auto frozen = watch.update(wrench, static_cast<std::uint16_t>(sample));
      if (!frozen) continue;
      named_at = sample;
      EXPECT_EQ(frozen->axis, dead);
    }
    EXPECT_EQ(named_at - kDies, 31) << "axis " << dead;
  }
}

// Less noise than a count: at the edge between two counts it changes often, and within one never.
TEST(FrozenWatch, AQuietAxisMayStandStill) {
  for (const double noise_counts : {0.05, 0.2, 0.4, 0.6, 0.8, 1.5}) {
    for (const double begins_at : {0.0, 0.5}) {
      FrozenWatch watch(sensor(10.0));
      const ForceTorqueSensor alive = sensor(10.0);
      Random random(9);
      for (int sample = 0; sample < 100'000; ++sample) {
        Vector6 wrench = reading(alive, random);
        const double creeps = begins_at + 1e-4 * sample;
        wrench[1] = std::round(creeps + noise_counts * random.normal());
        const auto frozen = watch.update(wrench, static_cast<std::uint16_t>(sample));
        ASSERT_FALSE(frozen) << noise_counts << " counts from " << begins_at << " in " << sample;
      }
    }
  }
}

TEST(DriftWatch, NoiseOfTheGreatestDeviationIsNoDriftAndASlowOneIs) {
  DriftWatch steady{{}};
  DriftWatch drifting{{}};
  Random random(3);
  int named_at = 0;
  for (int sample = 0; sample < 200'000; ++sample) {
    Vector6 wrench = Vector6::Zero();
    for (int axis = 0; axis < 6; ++axis) wrench[axis] = (axis < 3 ? 0.3 : 0.015) * random.normal();
    ASSERT_FALSE(steady.add(wrench)) << sample;
    wrench[1] += 1e-3 * sample;  // 0.5 N/s at 500 Hz
    const auto drift = drifting.add(wrench);
    if (!drift || named_at > 0) continue;
    named_at = sample + 1;
    EXPECT_EQ(drift->axis, 1);
    EXPECT_GT(drift->moved, drift->bound);
  }
  // 0.25 N lie between means that are 250 samples apart.
  EXPECT_GE(named_at, 200);
  EXPECT_LE(named_at, 500);
}

Robot robot() {
  Robot robot = hand_made_cell().robot;
  for (Joint& joint : robot.joints) joint.counts_per_unit = 1e6;
  robot.cycle_us = 2000;
  robot.response_lag_s = 0.004;
  return robot;
}

constexpr std::int64_t kWatchedCycle_ns = 2'000'000;
constexpr std::uint32_t kAll = 7;

// Full speed is 0.5 m/s, 1 mm a cycle.
TEST(EncoderWatch, AtRestAJointGoesNoFurtherThanItsFullSpeedAllows) {
  for (const double jump_m : {0.0009, -0.0009, 0.0011, -0.0011}) {
    EncoderWatch watch(robot());
    JointVector at{};
    for (int cycle = 0; cycle < 100; ++cycle) {
      if (cycle == 50) at[1] = jump_m;
      const auto jump = watch.update(at, kAll, cycle * kWatchedCycle_ns);
      ASSERT_EQ(jump.has_value(), cycle == 50 && std::abs(jump_m) > 0.001) << jump_m;
      if (jump) {
        EXPECT_EQ(jump->joint, 1);
        EXPECT_NEAR(jump->bound, std::copysign(0.001, jump_m), 3e-6);
      }
      watch.commanded({});
    }
  }
}

// A joint at full speed that misses four commands and then makes up for them, or answers late, or
// whose loop slept.
TEST(EncoderWatch, WhatAJointMakesUpForIsNoJump) {
  EncoderWatch watch(robot());
  double commanded_m = 0.0;
  double measured_m = 0.0;
  std::int64_t now_ns = 0;
  for (int cycle = 0; cycle < 1000; ++cycle) {
    const bool stands = cycle % 50 < 4;
    const bool silent = cycle % 70 < 5;
    if (cycle % 90 == 0) now_ns += 10 * kWatchedCycle_ns;
    if (!stands) measured_m = commanded_m;
    const auto jump = watch.update({measured_m, measured_m, measured_m}, silent ? 0 : kAll, now_ns);
    ASSERT_FALSE(jump) << "cycle " << cycle << ": " << jump->moved << " beyond " << jump->bound;
    commanded_m += 0.001;
    watch.commanded({commanded_m, commanded_m, commanded_m});
    now_ns += kWatchedCycle_ns;
  }
}

TEST(EncoderWatch, AJumpAgainstTheMotionIsNamedInTheFastestMoveToo) {
  EncoderWatch watch(robot());
  double at_m = 0.0;
  for (int cycle = 0; cycle < 200; ++cycle) {
    at_m += 0.001;
    const double read_m = cycle >= 100 ? at_m - 0.003 : at_m;
    const auto jump = watch.update({read_m, 0.0, 0.0}, kAll, cycle * kWatchedCycle_ns);
    ASSERT_EQ(jump.has_value(), cycle == 100) << cycle;
    watch.commanded({at_m, 0.0, 0.0});
  }
}

}  // namespace
}  // namespace tenon::executor

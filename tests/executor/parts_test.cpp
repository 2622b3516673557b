// The small parts around the controller: stop profile, wrench estimate, tare, bucket, histogram,
// black box, state machine.

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <random>
#include <set>

#include "executor/loop/leaky_bucket.h"
#include "executor/motion/stop_profile.h"
#include "executor/record/black_box.h"
#include "executor/record/histogram.h"
#include "executor/sensing/sensor_tare.h"
#include "executor/sensing/wrench_estimator.h"
#include "executor/states/state_machine.h"
#include "shared/system/record_file.h"
#include "tests/support/hand_made.h"

namespace tenon::executor {
namespace {

TEST(StopProfile, EveryStopKeepsItsBoundsAndEndsAtRest) {
  std::mt19937 random(7);
  const auto uniform = [&](double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(random);
  };
  SpeedLimits limits;
  for (int trial = 0; trial < 300; ++trial) {
    GuardedMove::Setpoint moving;
    const Vector3 direction = Vector3(uniform(-1, 1), uniform(-1, 1), uniform(-1, 1)).normalized();
    const double v_mps = uniform(0.02, 0.25);
    // What a jerk-limited motion can have at this speed on its way up or down.
    const double a_mps2 = uniform(-1, 1) * std::min(1.0, std::sqrt(2 * limits.jerk_mps3 * v_mps));
    moving.velocity.head<3>() = v_mps * direction;
    moving.acceleration.head<3>() = a_mps2 * direction;
    const StopProfile stop(moving, limits);
    EXPECT_LT(stop.duration_s(), 1.0);

    constexpr double kT = 1e-4;
    double last_a = a_mps2;
    double last_v = v_mps;
    double way_m = 0.0;
    for (int i = 1; i * kT < stop.duration_s(); ++i) {
      const GuardedMove::Setpoint s = stop.at(i * kT);
      const double v = s.velocity.head<3>().dot(direction);
      const double a = s.acceleration.head<3>().dot(direction);
      way_m += 0.5 * kT * (v + last_v);
      EXPECT_NEAR((v - last_v) / kT, 0.5 * (a + last_a), 1e-3);
      EXPECT_LE(std::abs(a - last_a) / kT, 1.001 * limits.jerk_mps3);
      EXPECT_LE(std::abs(a), limits.acceleration_mps2 + 1e-9);
      EXPECT_NEAR(s.pose.position_m.dot(direction), way_m, 1e-6);
      last_a = a;
      last_v = v;
    }
    EXPECT_NEAR(last_v, 0.0, 1e-4);
    EXPECT_EQ(stop.at(stop.duration_s()).velocity.norm(), 0.0);
    EXPECT_EQ(stop.at(2.0).pose.position_m, stop.at(3.0).pose.position_m);
  }
}

TEST(StopProfile, WhatRestsStaysWhereItIs) {
  GuardedMove::Setpoint resting;
  resting.pose.position_m = Vector3(1, 2, 3);
  const StopProfile stop(resting, {});
  EXPECT_EQ(stop.duration_s(), 0.0);
  EXPECT_EQ(stop.at(0.1).pose, resting.pose);
}

TEST(WrenchEstimator, AForceAtTheTipIsFoundThroughFramesWeightAndBias) {
  const Cell cell = hand_made_cell();
  WrenchEstimator estimator(cell);
  // Flange in base is identity here, so everything can be written down by hand. The sensor's axes:
  // x is base x, y is base z, z is base -y. The tip is at (0, 0, -0.08) from it, base axes.
  const Pose tool = compose(inverse(cell.X_BT), cell.X_FP);
  const double weight_N = 0.4 * 9.80665;
  Vector6 rest;
  rest << 1.0, 2.0 - weight_N, 3.0, 0.1, 0.2, 0.3;  // bias 1 2 3, weight along -y
  rest.tail<3>() += Vector3(0.0, 0.01, 0.03).cross(Vector3(0.0, -weight_N, 0.0));
  estimator.tare(rest, tool);
  ASSERT_EQ(estimator.update(rest, tool), WrenchEstimator::Status::kGood);
  EXPECT_LT(estimator.external().norm(), 1e-12);

  // 10 N along base x at the tip: torque about the sensor (0, 0, -0.08) x (10, 0, 0) = (0, -0.8,
  // 0), which in sensor axes is along z, +0.8.
  Vector6 pushed = rest;
  pushed[0] += 10.0;
  pushed[5] += 0.8;
  ASSERT_EQ(estimator.update(pushed, tool), WrenchEstimator::Status::kGood);
  // The task frame is turned by +30 degrees about z against the base.
  EXPECT_NEAR(estimator.external()[0], 10.0 * std::sqrt(3.0) / 2.0, 1e-9);
  EXPECT_NEAR(estimator.external()[1], -5.0, 1e-9);
  EXPECT_NEAR(estimator.external()[2], 0.0, 1e-9);
  EXPECT_LT(estimator.external().tail<3>().norm(), 1e-9);
}

// command of cycle k -> taken up with SYNC k + 1, the arm follows by the rest of its lag -> sampled
// -> told a cycle later. An immediate stop: the payload pulls on, the estimate does not feel it.
TEST(WrenchEstimator, TheInertiaOfAnImmediateStopIsNoContact) {
  Cell cell = hand_made_cell();
  cell.X_BT = cell.X_FP = cell.X_FS = Pose{};
  cell.payload_com_m.setZero();
  cell.robot.response_lag_s = 0.004;
  cell.robot.measurement_delay_cycles = 1;
  constexpr double kT = 2e-3;
  constexpr double kV_mps = 0.1;
  const auto felt = [&](double payload_kg) {
    cell.payload_mass_kg = payload_kg;
    WrenchEstimator estimator(cell);
    Vector6 rest = Vector6::Zero();
    rest[2] = -0.4 * 9.80665;
    estimator.tare(rest, {});
    double most_N = 0.0;
    double arm_mps = 0.0;  // the arm: a cycle of dead time and 2 ms of first order
    double commanded_mps = 0.0;
    double waiting_mps = 0.0;
    double acting_mps = 0.0;
    for (int i = 0; i < 200; ++i) {
      const double before_mps = arm_mps;
      arm_mps += (acting_mps - arm_mps) * kT / (kT + 0.002);
      acting_mps = waiting_mps;
      waiting_mps = commanded_mps;
      commanded_mps = i < 100 ? kV_mps : 0.0;
      Vector6 raw = rest;
      raw[0] -= 0.4 * (arm_mps - before_mps) / kT;
      (void)estimator.update(raw, {});
      most_N = std::max(most_N, std::abs(estimator.external()[0]));
      Vector6 velocity = Vector6::Zero();
      velocity[0] = commanded_mps;
      estimator.commanded(velocity);
    }
    return most_N;
  };
  EXPECT_GT(felt(0.0), 6.0);  // above the default on-threshold without compensation
  EXPECT_LT(felt(0.4), 1.0);
}

TEST(WrenchEstimator, AReadingAtTheRangeIsSaturatedByItsAxis) {
  WrenchEstimator estimator(hand_made_cell());
  Vector6 raw = Vector6::Zero();
  raw[4] = -20.0;
  EXPECT_EQ(estimator.update(raw, {}), WrenchEstimator::Status::kSaturated);
  EXPECT_EQ(estimator.axis(), 4);
  raw[4] = std::nan("");
  EXPECT_EQ(estimator.update(raw, {}), WrenchEstimator::Status::kNotFinite);
}

TEST(SensorTare, TheMeanOfASteadySensorIsFoundUnderALargeBias) {
  SensorTare tare({.samples = 400, .force_deviation_max_N = 0.3, .torque_deviation_max_Nm = 0.03});
  std::mt19937 random(3);
  std::normal_distribution<double> noise(0.0, 1.0);
  for (int i = 0; i < 400; ++i) {
    Vector6 sample;
    sample << 150, -20, 0, 1, 2, 3;
    for (int axis = 0; axis < 6; ++axis) sample[axis] += (axis < 3 ? 0.2 : 0.01) * noise(random);
    (void)tare.add(sample);
  }
  EXPECT_EQ(tare.status(), SensorTare::Status::kDone);
  EXPECT_NEAR(tare.mean()[0], 150.0, 0.04);
  EXPECT_NEAR(tare.mean()[5], 3.0, 0.002);
  EXPECT_NEAR(tare.deviation(0), 0.2, 0.03);
}

TEST(SensorTare, OneLoudAxisIsRefusedByItsNumber) {
  SensorTare tare({.samples = 100, .force_deviation_max_N = 0.3, .torque_deviation_max_Nm = 0.03});
  for (int i = 0; i < 100; ++i) {
    Vector6 sample = Vector6::Zero();
    sample[4] = i % 2 == 0 ? 0.1 : -0.1;
    (void)tare.add(sample);
  }
  EXPECT_EQ(tare.status(), SensorTare::Status::kUnsteady);
  EXPECT_EQ(tare.worst_axis(), 4);
  EXPECT_NEAR(tare.deviation(4), 0.1005, 1e-3);
}

// Noise of 0.2 N on a zero that moves by 0.5 to 500 N in the while.
TEST(SensorTare, WhatNoiseIsBesideADriftIsFoundHoweverStrongThatIs) {
  for (const double drift_N : {0.0, 0.5, 5.0, 50.0, 500.0}) {
    SensorTare tare({.samples = 200});
    std::mt19937 random(5);
    std::normal_distribution<double> noise(0.0, 0.2);
    for (int i = 0; i < 200; ++i) {
      Vector6 sample = Vector6::Zero();
      sample[1] = 20.0 + drift_N * i / 200.0 + noise(random);
      (void)tare.add(sample);
    }
    EXPECT_NEAR(tare.deviation_beside_drift(1), 0.2, 0.03) << drift_N;
    EXPECT_EQ(tare.deviation_beside_drift(0), 0.0);
  }
}

TEST(LeakyBucket, OneBadCycleInTwentyGoesOnForEverAndABurstDoesNot) {
  LeakyBucket bucket({.capacity = 50.0, .leak = 0.05});
  for (int i = 0; i < 100'000; ++i) {
    if (i % 21 == 0) {
      bucket.bad(1);
    } else {
      bucket.good();
    }
    ASSERT_FALSE(bucket.full());
  }
  bucket.bad(50);
  EXPECT_TRUE(bucket.full());
}

TEST(Histogram, PercentilesAreUpperEdgesOfMicrosecondBins) {
  Histogram histogram;
  EXPECT_EQ(histogram.percentile_us(0.5), 0.0);
  for (int i = 0; i < 99; ++i) histogram.add(10'500);
  histogram.add(7'000'000);
  EXPECT_EQ(histogram.percentile_us(0.5), 11.0);
  EXPECT_EQ(histogram.percentile_us(0.99), 11.0);
  EXPECT_EQ(histogram.percentile_us(1.0), 7000.0);
  EXPECT_EQ(histogram.max_us(), 7000.0);
}

TEST(BlackBox, ItKeepsTheLastCyclesAndWritesALineForEach) {
  BlackBox box(5);
  CycleRecord record;
  for (std::uint64_t i = 0; i < 12; ++i) {
    record.sequence = i;
    box.record(record);
  }
  ASSERT_EQ(box.size(), 5U);
  EXPECT_EQ(box.at(0).sequence, 7U);
  EXPECT_EQ(box.at(4).sequence, 11U);
  const std::filesystem::path file =
      std::filesystem::path(testing::TempDir()) / "tenon_black_box_test.csv";
  EXPECT_TRUE(box.write_csv(file).whole());
  std::ifstream in(file);
  std::string line;
  std::set<long> columns;
  int lines = 0;
  for (; std::getline(in, line); ++lines) columns.insert(std::count(line.begin(), line.end(), ','));
  EXPECT_EQ(lines, 6);
  EXPECT_EQ(columns.size(), 1U);  // the header names every value
  std::filesystem::remove(file);
}

TEST(StateMachine, NothingLeadsOutOfFinishedAndAFaultWithDrivesOnIsAQuickStop) {
  for (int e = 0; e <= static_cast<int>(Event::kBrakeFailed); ++e) {
    EXPECT_EQ(next_state(State::kFinished, static_cast<Event>(e)), State::kFinished);
  }
  for (const State on :
       {State::kTaring, State::kApproaching, State::kRunning, State::kStopping, State::kHolding}) {
    EXPECT_EQ(next_state(on, Event::kFault), State::kQuickStopping) << to_string(on);
  }
  EXPECT_EQ(next_state(State::kWaiting, Event::kFault), State::kDisabling);
  EXPECT_EQ(next_state(State::kQuickStopping, Event::kAtRest), State::kDisabling);
  EXPECT_EQ(next_state(State::kDisabling, Event::kDisabled), State::kWatching);
  EXPECT_EQ(next_state(State::kWatching, Event::kHeld), State::kFinished);
}

TEST(StateMachine, ItHasTheArrowsOfItsDiagramAndNoOther) {
  // A row a state, in the order of the enumerators: waiting, taring, approaching, running,
  // stopping, quick stopping, holding, disabling, finished, watching (9), catching (a). A column an
  // event: enabled, tared, at start, work ended, stop, fault, at rest, held, disabled, brake
  // failed.
  constexpr std::array<const char*, 11> kNext = {"1 0 0 0 7 7 0 0 0 0",  //
                                                 "1 2 1 1 6 5 1 1 1 1",  //
                                                 "2 2 3 2 4 5 2 2 2 2",  //
                                                 "3 3 3 6 4 5 3 3 3 3",  //
                                                 "4 4 4 4 4 5 6 4 4 4",  //
                                                 "5 5 5 5 5 5 7 5 5 5",  //
                                                 "6 6 6 6 6 5 6 7 6 6",  //
                                                 "7 7 7 7 7 7 7 7 9 7",  //
                                                 "8 8 8 8 8 8 8 8 8 8",  //
                                                 "9 9 9 9 9 9 9 8 9 a",  //
                                                 "a a a a 7 a a a a a"};
  for (std::size_t state = 0; state < kNext.size(); ++state) {
    for (std::size_t event = 0; event < 10; ++event) {
      EXPECT_EQ(static_cast<int>(next_state(static_cast<State>(state), static_cast<Event>(event))),
                std::stoi(std::string(1, kNext.at(state)[2 * event]), nullptr, 16))
          << state << " " << event;
    }
  }
  EXPECT_EQ(next_state(State::kHolding, static_cast<Event>(99)), State::kQuickStopping);
  EXPECT_EQ(next_state(static_cast<State>(99), Event::kHeld), State::kQuickStopping);
}

}  // namespace
}  // namespace tenon::executor

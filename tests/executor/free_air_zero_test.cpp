// A sensor's zero follows what a move through free air shows of it, and nothing that touches.

#include "executor/sensing/free_air_zero.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "shared/base/random.h"
#include "tests/executor/bench.h"

namespace tenon::executor {
namespace {

constexpr double kMoved_N = 0.4;
constexpr double kMost_N = 0.75;  // half of what counts as gone

/// A move of so many samples with a force on z that grows from nothing to its end.
void go(FreeAirZero& zero, int samples, double from_N, double to_N) {
  Random random(1);
  zero.begin(true);
  for (int i = 0; i < samples; ++i) {
    const double force_N = from_N + (to_N - from_N) * i / samples;
    zero.add(Vector6::Unit(2) * (force_N + 0.1 * random.normal()));
  }
}

TEST(FreeAirZero, TakesWhatTheEndOfAFreeWayReads) {
  FreeAirZero zero({});
  go(zero, 1000, 0.3, 0.4);
  const auto moved = zero.end();
  ASSERT_TRUE(moved.has_value());
  EXPECT_NEAR((*moved)[2], 0.4, 0.02);
  EXPECT_NEAR((*moved)[1], 0.0, 1e-12);
  EXPECT_EQ(zero.moved(), *moved);
}

TEST(FreeAirZero, GoesNoFartherThanItMayHoweverOftenItMoves) {
  FreeAirZero zero({});
  double sum_N = 0.0;
  for (int move = 0; move < 5; ++move) {
    go(zero, 200, 0.3, 0.3);
    sum_N += zero.end().value_or(Vector6::Zero())[2];
  }
  EXPECT_NEAR(sum_N, kMost_N, 1e-9);
  EXPECT_NEAR(zero.moved()[2], kMost_N, 1e-9);
}

TEST(FreeAirZero, LearnsNothingFromAWayThatWasNotFreeOrTooShort) {
  FreeAirZero zero({});
  go(zero, 30, 0.3, 0.3);
  EXPECT_FALSE(zero.end().has_value()) << "too short";
  go(zero, 500, 0.0, 1.5);
  EXPECT_FALSE(zero.end().has_value()) << "a push that grows";
  go(zero, 200, 0.3, 0.3);
  zero.touch();
  EXPECT_FALSE(zero.end().has_value()) << "touched";
  zero.begin(false);
  for (int i = 0; i < 200; ++i) zero.add(Vector6::Unit(2) * 0.3);
  EXPECT_FALSE(zero.end().has_value()) << "began in a contact";
  EXPECT_TRUE(zero.moved().isZero());
}

// A peg that brushes the wall of its slot on the way in: as recorded, no more than noise may be
// over the whole of the way, and less at its end than what holds a contact.
TEST(FreeAirZero, LearnsNothingFromABodyThatTheToolBrushesOnTheWay) {
  const auto pushed = [](double begins, double first_N, double last_N) {
    FreeAirZero zero({.deviation_max = Vector6::Constant(0.6)});
    Random random(2);
    constexpr int kSamples = 227;
    zero.begin(true);
    for (int i = 0; i < kSamples; ++i) {
      const double part = static_cast<double>(i) / kSamples;
      const double force_N =
          part < begins ? 0.0 : first_N + (last_N - first_N) * (part - begins) / (1.0 - begins);
      zero.add(Vector6::Unit(0) * (force_N + 0.12 * random.normal()));
    }
    return zero.end().has_value();
  };
  EXPECT_FALSE(pushed(0.45, 1.5, 0.5));
  EXPECT_FALSE(pushed(0.25, 0.5, 0.5)) << "a steady one, met on the way";
  EXPECT_TRUE(pushed(0.0, 0.3, 0.35)) << "a zero that moves slowly";
}

/// To and fro along x, `moves` times, nothing near.
Plan to_and_fro(int moves) {
  Plan plan = hand_made_plan();
  for (int i = 0; i < moves; ++i) {
    const Successor next = i + 1 < moves ? static_cast<Successor>(i + 1) : kSuccessorDone;
    plan.steps.push_back(hand_made_step(0, i % 2 == 0 ? 0.03 : -0.03, {{Outcome::kReached, next}}));
  }
  return plan;
}

// Uncorrected, 0.4 N would have pushed the tool nearly 0.4 mm aside: K is 1000 N/m.
TEST(FreeAirZero, AToolInFreeAirComesBackToItsWay) {
  Bench bench(to_and_fro(8));
  bench.arm.noise_N = 0.1;
  bench.run_until(State::kRunning);
  bench.arm.bias[1] += kMoved_N;  // along the tool's z
  double most_m = 0.0;
  const auto aside_m = [&] { return std::abs(bench.arm.tool().position_m.z()); };
  bench.run([&] { most_m = std::max(most_m, aside_m()); });
  EXPECT_EQ(bench.controller.ending().reason, EndReason::kPlanDone) << bench.ending();
  EXPECT_GT(most_m, 0.1e-3);
  EXPECT_LT(aside_m(), 0.03e-3);
}

}  // namespace
}  // namespace tenon::executor

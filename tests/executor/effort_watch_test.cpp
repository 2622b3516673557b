// Whether drives still measure their efforts: against the noise of those that do, and the silence
// of coarse ones at rest and in even motion.

#include "executor/sensing/effort_watch.h"

#include <gtest/gtest.h>

#include <cmath>
#include <optional>

#include "shared/base/random.h"

namespace tenon::executor {
namespace {

constexpr double kCount_N = 0.2;  // a thousandth of 200 N
constexpr double kUnit_m = 1e-6;  // a count of the encoder
constexpr double kResidual_N = 1.4;
constexpr int kTare = 200;

Cell one_joint(bool identified = true) {
  Cell cell;
  Joint joint;
  joint.name = "x";
  joint.counts_per_unit = 1.0 / kUnit_m;
  joint.rated_effort = 1000.0 * kCount_N;
  cell.robot.joints = {joint};
  cell.joint_torque.emplace();
  if (identified) cell.joint_torque->joints = {{.residual = kResidual_N}};
  return cell;
}

/// A joint whose drive reports in whole counts, and the watch over it.
class Bench {
 public:
  explicit Bench(double noise_counts, bool identified = true)
      : watch(one_joint(identified)), noise_counts_(noise_counts) {}

  /// One cycle. @param moved m  @param effort_N true, as the model knows it
  std::optional<EffortWatch::Frozen> cycle(double moved, double effort_N = 0.0) {
    position_ += moved;
    if (!stuck) {
      reported_ = kCount_N * std::round(effort_N / kCount_N + noise_counts_ * random_.normal());
    }
    ArmFeedback feedback;
    feedback.position[0] = kUnit_m * std::round(position_ / kUnit_m) + flicker();
    feedback.effort[0] = reported_;
    JointVector commanded{};
    commanded[0] = position_;
    JointVector external{};
    external[0] = effort_N - reported_;
    return watch.update(feedback, commanded, external);
  }
  void tare() {
    watch.begin_tare();
    for (int i = 0; i < kTare; ++i) EXPECT_FALSE(cycle(0.0));
    watch.end_tare();
  }

  EffortWatch watch;
  bool stuck = false;
  bool flickers = false;  ///< the encoder's last bit

 private:
  double flicker() { return flickers && random_.uniform() < 0.5 ? kUnit_m : 0.0; }

  double noise_counts_;
  Random random_{5};
  double position_ = 0.0;
  double reported_ = 0.0;
};

TEST(EffortWatch, ADriveThatHasShownNoiseIsNamedWithinItsBoundOfMotion) {
  for (const double noise_counts : {1.5, 2.0, 5.0}) {
    Bench bench(noise_counts);
    bench.tare();
    const int most = bench.watch.cycles_max(0);
    ASSERT_GT(most, 0) << noise_counts;
    for (int i = 0; i < 1000; ++i) ASSERT_FALSE(bench.cycle(1e-5));
    bench.stuck = true;
    int cycles = 1;
    while (cycles < 1000 && !bench.cycle(1e-5)) ++cycles;
    EXPECT_LE(cycles, most + 2) << noise_counts;
    EXPECT_LE(cycles, kFrozenEffortCycles + 2) << noise_counts;
    std::printf("noise of %g counts: named after %d cycles\n", noise_counts, cycles);
  }
}

TEST(EffortWatch, OneThatMeasuresIsNeverNamed) {
  for (const double noise_counts : {0.3, 0.6, 1.0, 1.5, 2.0, 5.0}) {
    Bench bench(noise_counts);
    bench.tare();
    for (int i = 0; i < 1'000'000; ++i) {
      ASSERT_FALSE(bench.cycle(1e-5, 1e-4 * i)) << noise_counts << " in " << i;
    }
  }
}

// Half an hour at 500 Hz.
TEST(EffortWatch, ACoarseDriveWithoutNoiseMayRestForEver) {
  for (const bool flickers : {false, true}) {
    Bench bench(0.0);
    bench.flickers = flickers;
    bench.tare();
    EXPECT_EQ(bench.watch.cycles_max(0), 0) << "it has shown no noise";
    for (int i = 0; i < 900'000; ++i) ASSERT_FALSE(bench.cycle(0.0, 40.0)) << i;
  }
}

// However noisy it was when it was tared: a rest proves nothing.
TEST(EffortWatch, NobodyIsNamedAtRest) {
  Bench bench(2.0);
  bench.tare();
  ASSERT_GT(bench.watch.cycles_max(0), 0);
  bench.stuck = true;
  bench.flickers = true;
  for (int i = 0; i < 900'000; ++i) ASSERT_FALSE(bench.cycle(0.0)) << i;
  int cycles = 1;
  while (cycles < 1000 && !bench.cycle(1e-5)) ++cycles;
  EXPECT_LE(cycles, kFrozenEffortCycles + 2) << "the next motion does";
}

// Gravity of a slide does not change, nor does friction within a motion.
TEST(EffortWatch, ACoarseDriveInEvenMotionMayReportOneValue) {
  Bench bench(0.0);
  bench.tare();
  for (int i = 0; i < 900'000; ++i) ASSERT_FALSE(bench.cycle(1e-5, 40.0)) << i;
}

// And what the model is off by at both ends proves nothing either.
TEST(EffortWatch, ACoarseDriveIsNamedOnlyWhereTheModelSaysThatItMustHaveChanged) {
  for (const double change_N :
       {0.9 * EffortWatch::kSure * kResidual_N, 1.2 * EffortWatch::kSure * kResidual_N}) {
    Bench bench(0.0);
    bench.tare();
    bench.stuck = true;
    bool named = false;
    for (int i = 0; i < 500; ++i)
      named = bench.cycle(1e-5, change_N * i / 500.0).has_value() || named;
    for (int i = 0; i < 500; ++i) named = bench.cycle(1e-5, change_N).has_value() || named;
    EXPECT_EQ(named, change_N > EffortWatch::kSure * kResidual_N) << change_N;
  }
}

// Before friction is identified the model says nothing.
TEST(EffortWatch, WithoutAFrictionFileNoiseAloneTells) {
  Bench quiet(0.0, false);
  quiet.tare();
  quiet.stuck = true;
  for (int i = 0; i < 1000; ++i) ASSERT_FALSE(quiet.cycle(1e-5, 1.0 * i));
  Bench noisy(2.0, false);
  noisy.tare();
  noisy.stuck = true;
  bool named = false;
  for (int i = 0; i < 100; ++i) named = noisy.cycle(1e-5).has_value() || named;
  EXPECT_TRUE(named);
}

// A tare that was not steady was no rest: what it showed is forgotten.
TEST(EffortWatch, ATareThatBeginsAgainLearnsAnew) {
  Bench bench(0.0);
  bench.watch.begin_tare();
  for (int i = 0; i < kTare; ++i) ASSERT_FALSE(bench.cycle(0.0, i % 2 == 0 ? 40.0 : 41.0));
  bench.tare();
  EXPECT_EQ(bench.watch.cycles_max(0), 0);
}

TEST(EffortWatch, DrivesThatDoNotFollowMayReportWhatTheyLike) {
  Bench bench(2.0);
  bench.tare();
  bench.stuck = true;
  for (int i = 0; i < 1000; ++i) {
    bench.watch.let_go();
    ASSERT_FALSE(bench.cycle(1e-5)) << i;
  }
}

}  // namespace
}  // namespace tenon::executor

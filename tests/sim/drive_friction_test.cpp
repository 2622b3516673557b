// Friction of the virtual drives: what it adds to the effort that a drive reports, by numbers
// worked out by hand, and that the arm moves as without it; and what noise adds.

#include "sim/cell/virtual_arm/drive_friction.h"

#include <gtest/gtest.h>

#include <cmath>

#include "sim/cell/virtual_arm/effort_mean.h"
#include "sim/cell/virtual_arm/world_draw.h"
#include "tests/sim/literal_cell.h"

namespace tenon::sim {
namespace {

constexpr DriveFriction kFriction = {.coulomb_share = 0.05,
                                     .viscous_share = 0.03,
                                     .hysteresis_share = 0.01,
                                     .way_factor = 1.0,
                                     .start = 0.0};

Joint slide() {
  Joint joint;
  joint.rated_effort = 200.0;
  joint.speed_max = 1.0;
  return joint;
}

// 0.05 * 200 N of Coulomb, 0.01 * 200 N of hysteresis, 0.03 * 200 N at 1 m/s.
TEST(DriveFrictionTest, LongAfterAReversalItIsWhatTheSharesSay) {
  FrictionState friction(slide(), kFriction, 0.1);
  EXPECT_EQ(friction.effort(), 0.0);
  friction.update(0.2, 0.1);
  EXPECT_NEAR(friction.effort(), 10.0 + 2.0 + 0.6, 1e-7);
  friction.update(0.1, -0.1);
  EXPECT_NEAR(friction.effort(), -10.0 - 2.0 - 0.6, 1e-7);
}

// ln 2 ways take z from -1 to 0.
TEST(DriveFrictionTest, BristlesTurnWithinMicrometresAndTheGearWithinMillimetres) {
  FrictionState friction(slide(), kFriction, 0.0);
  friction.update(-0.1, 0.0);
  EXPECT_NEAR(friction.effort(), -12.0, 1e-7);
  friction.update(-0.1 + std::log(2.0) * FrictionState::kGear_m, 0.0);
  EXPECT_NEAR(friction.effort(), 10.0, 1e-7);
  friction.update(friction.kGear_m, 0.0);
  friction.update(0.1, 0.0);
  friction.update(0.1 - std::log(2.0) * FrictionState::kBristles_m, 0.0);
  EXPECT_NEAR(friction.effort(), 2.0, 0.02);
}

TEST(DriveFrictionTest, AtRestItStaysWhereItWas) {
  FrictionState friction(slide(), kFriction, 0.0);
  friction.update(0.1, 0.3);
  friction.update(0.1, 0.0);
  EXPECT_NEAR(friction.effort(), 12.0, 1e-7);
}

TEST(DriveFrictionTest, DrawsKeepToTheirSharesAndASeedKeepsTheArm) {
  WorldRanges ranges;
  ranges.drive_friction = DriveFrictionRange{.share = {.low = 0.02, .high = 0.1}, .seed = 7};
  const Task task = wall_task();
  const WorldDraw one = draw_world(ranges, task, 1);
  EXPECT_EQ(one.drive_friction, draw_world(ranges, task, 2).drive_friction);
  ranges.drive_friction->seed.reset();
  EXPECT_NE(draw_world(ranges, task, 1).drive_friction, draw_world(ranges, task, 2).drive_friction);
  double least = 1.0;
  double most = 0.0;
  for (std::uint64_t seed = 0; seed < 500; ++seed) {
    for (const DriveFriction& drive : draw_world(ranges, task, seed).drive_friction) {
      const double share = drive.coulomb_share + drive.viscous_share + drive.hysteresis_share;
      least = std::min(least, share);
      most = std::max(most, share);
      EXPECT_GE(drive.coulomb_share, 0.5 * share);
      EXPECT_LE(drive.hysteresis_share, 0.2 * share);
      EXPECT_GE(drive.viscous_share, 0.2 * share - 1e-12);
    }
  }
  EXPECT_GE(least, 0.02);
  EXPECT_LT(least, 0.021);
  EXPECT_LE(most, 0.1);
  EXPECT_GT(most, 0.099);
}

struct Moved {
  double permille = 0.0;  ///< mean of 6077h on the way
  std::int32_t counts = 0;
};

/// y at 10 mm/s to one side, after it has gone some way.
Moved moved(const std::vector<DriveFriction>& drives, int counts_a_cycle) {
  VirtualCell::Options options;
  options.world.drive_friction = drives;
  LiteralCell bench(gantry_cell(), wall_task(), options);
  EXPECT_TRUE(bench.enable());
  bench.move(1, counts_a_cycle, 1500);
  Moved moved;
  for (int i = 0; i < 200; ++i) {
    bench.move(1, counts_a_cycle, 1);
    moved.permille += bench.torque_permille[1] / 200.0;
  }
  moved.counts = bench.position_counts[1];
  return moved;
}

// 10 + 2 N of 200 N are 60 per mille; the fixture's joints name no full speed, so nothing is
// viscous.
TEST(DriveFrictionTest, ADriveReportsItAndTheArmMovesAsWithout) {
  const std::vector<DriveFriction> rough(3, kFriction);
  for (const int way : {20, -20}) {
    const Moved smooth = moved({}, way);
    const Moved rubbed = moved(rough, way);
    EXPECT_NEAR(rubbed.permille - smooth.permille, way > 0 ? 60.0 : -60.0, 1.0);
    EXPECT_EQ(rubbed.counts, smooth.counts);
  }
}

// -- Beside friction: the mean of a cycle, and noise
// -----------------------------------------------

TEST(EffortMeanTest, IsTheMeanOfTheLastCycle) {
  EffortMean mean(1, 4, 0.0, 1);
  for (int step = 1; step <= 10; ++step) {
    mean.add(0, step);
    mean.next();
    EXPECT_EQ(mean.off_permille(0), 0.0);
  }
  EXPECT_DOUBLE_EQ(mean.of(0), (7.0 + 8.0 + 9.0 + 10.0) / 4.0);
}

// Of 10,000 cycles the deviation is known to 0.7 %.
TEST(EffortMeanTest, NoiseIsAsWideAsItIsToBeAndAnewInEveryCycle) {
  constexpr int kCycles = 10'000;
  EffortMean mean(2, 4, 2.0, 1);
  double squares = 0.0;
  double products = 0.0;
  for (int cycle = 0; cycle < kCycles; ++cycle) {
    for (int step = 0; step < 4; ++step) {
      const double before = mean.off_permille(0);
      mean.next();
      EXPECT_EQ(mean.off_permille(0) != before, step == 3) << cycle;
    }
    squares += mean.off_permille(0) * mean.off_permille(0);
    products += mean.off_permille(0) * mean.off_permille(1);
  }
  EXPECT_NEAR(std::sqrt(squares / kCycles), 2.0, 0.06);
  EXPECT_NEAR(products / kCycles, 0.0, 0.16) << "two drives have nothing in common";
}

TEST(EffortMeanTest, NoiseIsTheSameForTheSameSeedAndOfADriveWhateverOthersThereAre) {
  EffortMean one(1, 1, 2.0, 7);
  EffortMean three(3, 1, 2.0, 7);
  EffortMean other(1, 1, 2.0, 8);
  for (int cycle = 0; cycle < 100; ++cycle) {
    one.next();
    three.next();
    other.next();
    EXPECT_EQ(one.off_permille(0), three.off_permille(0));
    EXPECT_NE(one.off_permille(0), other.off_permille(0));
  }
}

}  // namespace
}  // namespace tenon::sim

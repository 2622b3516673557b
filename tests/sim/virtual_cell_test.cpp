// The whole virtual cell, from frames to physics, driven by frames written by hand.

#include "sim/cell/virtual_arm/virtual_cell.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "shared/base/error.h"
#include "sim/cell/virtual_arm/environment_offset.h"
#include "tests/sim/literal_cell.h"

namespace tenon::sim {
namespace {

constexpr double kMicrometre = 1e-6;

TEST(VirtualCellTest, EveryNodeBootsUpAndSaysWhatItIs) {
  LiteralCell bench;
  EXPECT_EQ(std::vector<std::string>(bench.log.begin(), bench.log.begin() + 4),
            (std::vector<std::string>{"701#00", "702#00", "703#00", "704#00"}));
  EXPECT_EQ(text_of(bench.sdo(1, {0x40, 0x00, 0x10, 0, 0, 0, 0, 0})), "581#4300100092010200");
  EXPECT_EQ(text_of(bench.sdo(4, {0x40, 0x00, 0x10, 0, 0, 0, 0, 0})), "584#4300100094010000");
  EXPECT_EQ(text_of(bench.sdo(3, {0x40, 0x08, 0x10, 0, 0, 0, 0, 0})), "583#4108100015000000");
  std::string name;
  for (const int command : {0x60, 0x70, 0x60}) {
    const CanFrame segment = bench.sdo(3, {command, 0, 0, 0, 0, 0, 0, 0});
    const auto length = static_cast<std::size_t>(7 - (segment.data[0] >> 1 & 7));
    name.append(segment.data.begin() + 1,
                segment.data.begin() + 1 + static_cast<std::ptrdiff_t>(length));
  }
  EXPECT_EQ(name, "tenon virtual drive z");
}

TEST(VirtualCellTest, StartsWithTheToolAtTheStartAndTheBrakesOn) {
  LiteralCell bench;
  for (int i = 0; i < 500; ++i) bench.step();
  const Truth truth = bench.cell.truth();
  EXPECT_LT(truth.error_norm_m, kMicrometre);  // the goal of this task is the start
  EXPECT_TRUE(truth.within_tolerance);
  for (const DriveTruth& drive : truth.drives) EXPECT_TRUE(drive.brake_engaged);
  EXPECT_TRUE(bench.cell.at_standstill());
  EXPECT_EQ(truth.solver_messages, 0U);
}

TEST(VirtualCellTest, EnablingMovesNoAxis) {
  LiteralCell bench;
  bench.cycle();
  ASSERT_TRUE(bench.enable());
  const std::array<std::int32_t, 3> before = bench.target_counts;
  for (int i = 0; i < 50; ++i) {
    bench.cycle();
    for (std::size_t axis = 0; axis < 3; ++axis) {
      EXPECT_NEAR(bench.position_counts[axis], before[axis], 5) << axis;
    }
  }
}

// target      sent after SYNC k ──> taken up at SYNC k+1 ──> reached at SYNC k+2
// The feedback of a SYNC is therefore the target of two cycles before, along an even motion.
TEST(VirtualCellTest, AnEvenMotionIsTwoCyclesBehindItsTargets) {
  LiteralCell bench;
  ASSERT_TRUE(bench.enable());
  const std::int32_t start = bench.target_counts[1];
  for (int i = 0; i < 300; ++i) {
    bench.move(1, 200, 1);  // 0.1 m/s; the new target leaves after this feedback
    if (i >= 100) {
      EXPECT_NEAR(bench.target_counts[1] - bench.position_counts[1], 2 * 200, 5);
    }
  }
  bench.cycles_of(0x0F, 50);
  EXPECT_NEAR(bench.position_counts[1], start + 60'000, 2);
}

TEST(VirtualCellTest, ASlowerArmLagsByWhatItsRobotFileSays) {
  Cell cell = gantry_cell();
  cell.robot.response_lag_s = 0.020;
  LiteralCell bench(cell);
  ASSERT_TRUE(bench.enable());
  bench.move(1, 200, 300);
  EXPECT_NEAR(bench.target_counts[1] - bench.position_counts[1], 0.020 * 1e5, 30);
}

TEST(VirtualCellTest, ATargetActsOnlyOnTheNextSync) {
  LiteralCell bench;
  ASSERT_TRUE(bench.enable());
  bench.cycles_of(0x0F, 100);
  const std::int32_t before = bench.position_counts[0];
  bench.target_counts[0] += 500;
  bench.cycle();  // the target leaves after this cycle's feedback
  bench.cycle();  // this SYNC takes it up; its feedback was sampled before any motion
  EXPECT_NEAR(bench.position_counts[0], before, 2);
  bench.cycle();
  EXPECT_GT(bench.position_counts[0], before + 20);
}

TEST(VirtualCellTest, ThePayloadsWeightIsReadAtRestInTheSensorsAxes) {
  LiteralCell bench;
  ASSERT_TRUE(bench.enable());
  bench.cycles_of(0x0F, 200);
  const Vector6 wrench = bench.mean_wrench(400);
  // 0.1 N over the square root of 400 samples is 5 mN; five of them.
  EXPECT_NEAR(wrench[0], 0.0, 0.025);
  EXPECT_NEAR(wrench[1], 0.0, 0.025);
  EXPECT_NEAR(wrench[2], -0.5 * 9.80665, 0.025);
  // Torque of a weight 20 mm out along x: r x F = (0.02, 0, z) x (0, 0, -mg) = (0, 0.02 mg, 0).
  EXPECT_NEAR(wrench[3], 0.0, 0.002);
  EXPECT_NEAR(wrench[4], 0.02 * 0.5 * 9.80665, 0.002);
  EXPECT_NEAR(wrench[5], 0.0, 0.002);
}

TEST(VirtualCellTest, BothForceFramesCarryOneSampleAndSamplesDiffer) {
  LiteralCell bench;
  ASSERT_TRUE(bench.enable());
  for (int i = 0; i < 20; ++i) {
    const int before = bench.sample[0];
    const Vector6 wrench = bench.wrench;
    bench.cycle();
    EXPECT_EQ(bench.sample[0], (before + 1) & 0xFFFF);
    EXPECT_EQ(bench.sample[0], bench.sample[1]);
    EXPECT_NE(bench.wrench, wrench);
  }
}

// The x axis may pull 30 N and is sent 4 mm into the wall: it saturates, and the wall pushes back
// with what the servo can give.
TEST(VirtualCellTest, AWallPushesBackWithTheServosForceLimitTowardsMinusX) {
  Cell cell = gantry_cell();
  cell.robot.joints[0].effort_max = 30.0;
  LiteralCell bench(cell);
  ASSERT_TRUE(bench.enable());
  bench.move(0, 100, 540);  // 54 mm, the wall is at 50 mm
  // A constant force on 24.5 kg against a spring: it swings for a while.
  bench.cycles_of(0x0F, 2000);
  const Vector6 wrench = bench.mean_wrench(500);
  EXPECT_NEAR(wrench[0], -30.0, 0.1);
  EXPECT_NEAR(wrench[1], 0.0, 0.1);
  EXPECT_NEAR(bench.torque_permille[0], 150, 2);  // of 200 N
  const Truth truth = bench.cell.truth();
  EXPECT_EQ(truth.touching, std::vector<std::string>{"cube-wall"});
  EXPECT_GE(truth.contact_force_N_max, 29.9);
  EXPECT_EQ(truth.solver_messages, 0U);
  EXPECT_NE(std::find_if(truth.events.begin(), truth.events.end(),
                         [](const TruthEvent& e) { return e.what == "first contact cube-wall"; }),
            truth.events.end());
}

TEST(VirtualCellTest, TheContactIsAsStiffAsTheCellSays) {
  LiteralCell bench;
  ASSERT_TRUE(bench.enable());
  bench.move(0, 100, 502);  // 0.2 mm into the wall: 10 N at 5e4 N/m
  const Vector6 wrench = bench.mean_wrench(300);
  const double depth_m = bench.position_counts[0] * kMicrometre - 0.05;
  EXPECT_NEAR(depth_m, 2e-4, 2e-6);
  EXPECT_NEAR(wrench[0], -5e4 * depth_m, 0.15);
}

TEST(VirtualCellTest, AnAxisStuckAtAWallFaultsByFollowingErrorAndRecovers) {
  LiteralCell bench;
  ASSERT_TRUE(bench.enable());
  bench.move(0, 200, 400);  // 80 mm: 30 mm into the wall would need 1,500 N, the servo has 400 N
  EXPECT_EQ(bench.status[0] & 0x4F, 0x08);
  EXPECT_EQ(bench.status[1] & 0x6F, 0x27);
  EXPECT_NE(std::find(bench.log.begin(), bench.log.end(), "081#1186210000000000"), bench.log.end());
  EXPECT_EQ(bench.cell.truth().faults, 1U);
  EXPECT_EQ(text_of(bench.sdo(1, {0x40, 0x3F, 0x60, 0, 0, 0, 0, 0})), "581#4B3F600011860000");
  bench.target_counts[0] = bench.position_counts[0];
  bench.cycles_of(0x80, 2);
  bench.cycles_of(0x06, 3);
  EXPECT_EQ(bench.status[0] & 0x6F, 0x21);
}

// x at 0.1 m/s, quick stop by 6085h at its default of 10 m/s^2: 0.5 mm and 10 ms.
TEST(VirtualCellTest, QuickStopStopsTheAxisAndHoldsIt) {
  LiteralCell bench;
  ASSERT_TRUE(bench.enable());
  bench.move(1, 200, 200);
  bench.cycles_of(0x02, 2);  // sent, then taken up
  const std::int32_t when_taken = bench.position_counts[1];
  bench.cycles_of(0x02, 100);
  EXPECT_EQ(bench.status[1] & 0x6F, 0x07);
  EXPECT_NEAR(bench.position_counts[1] - when_taken, 500, 60);
  const Truth truth = bench.cell.truth();
  EXPECT_FALSE(truth.drives[1].brake_engaged);
  EXPECT_TRUE(bench.cell.at_standstill());
}

TEST(VirtualCellTest, AMasterThatDiesInMotionLeavesTheArmStoppedWithItsBrakesOn) {
  LiteralCell bench;
  ASSERT_TRUE(bench.enable());
  bench.move(1, 200, 200);
  const std::int32_t at_death = bench.target_counts[1];
  bench.master_alive = false;
  for (int i = 0; i < 600; ++i) bench.step();
  const Truth truth = bench.cell.truth();
  for (const DriveTruth& drive : truth.drives) {
    EXPECT_TRUE(drive.brake_engaged) << drive.joint;
    EXPECT_EQ(drive.state, "switch on disabled");
    EXPECT_FALSE(drive.operational);
  }
  EXPECT_NEAR(truth.drives[1].position * 1e6, at_death, 300.0);
  EXPECT_TRUE(bench.cell.at_standstill());
  EXPECT_NE(std::find(bench.log.begin(), bench.log.end(), "081#3081110000000000"), bench.log.end());
}

/// Two cells in the same even motion, of which one is about to sleep.
class CellThatSleeps : public ::testing::Test {
 protected:
  void SetUp() override {
    for (LiteralCell* bench : {&on_time, &late}) {
      ASSERT_TRUE(bench->enable());
      bench->move(1, 200, 100);
    }
  }
  /// SYNC and target of a cycle, which the sleeper finds when it wakes.
  void send_to_sleeper(int target) {
    late.send(0x080, {});
    late.send(0x202, {0x0F, 0, target & 0xFF, target >> 8 & 0xFF, target >> 16 & 0xFF, 0});
  }
  static double position(const LiteralCell& bench) { return bench.cell.truth().drives[1].position; }

  LiteralCell on_time;
  LiteralCell late;
};

// on time:  SYNC RPDO | SYNC RPDO | SYNC RPDO |      late:  (asleep) SYNC RPDO SYNC RPDO SYNC RPDO
TEST_F(CellThatSleeps, MovesOnWakingAsIfItHadBeenOnTime) {
  for (int i = 1; i <= 3; ++i) {
    on_time.move(1, 200, 1);
    send_to_sleeper(late.target_counts[1] + 200 * i);
  }
  late.now_ns = on_time.now_ns;
  late.cell.step(late.now_ns, late.bus);
  EXPECT_DOUBLE_EQ(position(late), position(on_time));
}

// A sleep that ends between two SYNCs: one was due in the middle of it.
TEST_F(CellThatSleeps, TakesASyncThatWasDueMeanwhileToHaveComeThen) {
  send_to_sleeper(late.target_counts[1] + 200);
  on_time.move(1, 200, 1);
  late.now_ns = on_time.now_ns += 1'500'000;
  for (LiteralCell* bench : {&on_time, &late}) {
    bench->cell.step(bench->now_ns, bench->bus);
    bench->step();  // shows how fast it moves, which the moment of the SYNC decides
  }
  EXPECT_DOUBLE_EQ(position(late), position(on_time));
}

std::vector<std::string> wall_run(std::uint64_t seed, double wall_offset_m, int cycles) {
  VirtualCell::Options options;
  options.seed = seed;
  options.offset[0] = wall_offset_m;
  LiteralCell bench(gantry_cell(), wall_task(), options);
  EXPECT_TRUE(bench.enable());
  bench.move(0, 100, cycles);
  return bench.log;
}

TEST(VirtualCellTest, TheSameSeedGivesTheSameFrames) {
  EXPECT_EQ(wall_run(7, 0.0, 520), wall_run(7, 0.0, 520));
  EXPECT_NE(wall_run(7, 0.0, 520), wall_run(8, 0.0, 520));
}

TEST(VirtualCellTest, NothingOnTheBusTellsWhereTheEnvironmentIsUntilItIsTouched) {
  EXPECT_EQ(wall_run(7, 0.0, 400), wall_run(7, 0.03, 400));
  EXPECT_NE(wall_run(7, 0.0, 520), wall_run(7, 0.03, 520));
}

TEST(VirtualCellTest, TruthIsInTheFrameOfTheDisplacedEnvironment) {
  VirtualCell::Options options;
  options.offset << 0.02, -0.01, 0.0, 0.0, 0.0, 0.0;
  LiteralCell bench(gantry_cell(), wall_task(), options);
  const Truth truth = bench.cell.truth();
  EXPECT_NEAR(truth.error[0], -0.02, kMicrometre);
  EXPECT_NEAR(truth.error[1], 0.01, kMicrometre);
  EXPECT_NEAR(truth.error_norm_m, std::sqrt(5e-4), kMicrometre);
  EXPECT_FALSE(truth.within_tolerance);
}

TEST(OffsetDrawTest, DrawsOnSearchCoordinatesAloneWithTheStartsSigma) {
  const Task task = wall_task();
  double sum = 0.0;
  double squares = 0.0;
  constexpr int kDraws = 4000;
  for (int seed = 0; seed < kDraws; ++seed) {
    const Vector6 offset = draw_offset(task, task.starts[0], static_cast<std::uint64_t>(seed));
    EXPECT_EQ(offset.tail<4>(), (Eigen::Vector4d::Zero()));
    sum += offset[0];
    squares += offset[0] * offset[0];
  }
  EXPECT_NEAR(sum / kDraws, 0.0, 5 * 0.03 / std::sqrt(kDraws));
  EXPECT_NEAR(std::sqrt(squares / kDraws), 0.03, 0.002);
  EXPECT_EQ(draw_offset(task, task.starts[0], 5), draw_offset(task, task.starts[0], 5));
}

TEST(OffsetDrawTest, UniformErrorsAreAsLikelyAnywhereWithinTheirBounds) {
  Task task = wall_task();
  task.errors = Distribution::kUniform;
  const double bound_m = std::numbers::sqrt3 * task.starts[0].sigma[0];
  constexpr int kDraws = 4000;
  std::array<int, 4> quarters{};
  for (int seed = 0; seed < kDraws; ++seed) {
    const double z =
        draw_offset(task, task.starts[0], static_cast<std::uint64_t>(seed))[0] / bound_m;
    ASSERT_LE(std::abs(z), 1.0);
    ++quarters.at(static_cast<std::size_t>(2.0 * (z + 1.0)));
  }
  // Five standard deviations of a count of one in four.
  for (const int count : quarters) EXPECT_NEAR(count, kDraws / 4, 5 * 27.4);
}

TEST(ParseOffsetTest, TakesSearchCoordinatesAndNothingElse) {
  Vector6 expected = Vector6::Zero();
  expected[0] = 0.02;
  expected[1] = -0.01;
  EXPECT_EQ(parse_offset("x_m=0.02,y_m=-0.01", 0x03), expected);
  for (const char* bad : {"", "x_m", "x=0.1", "x_m=", "x_m=nan", "x_m=2", "x_m=0.1,", "z_m=0.1",
                          "x_m=0.1,x_m=0.2", "x_m=0.1 "}) {
    EXPECT_THROW(static_cast<void>(parse_offset(bad, 0x03)), InputError) << bad;
  }
}

TEST(VirtualCellTest, RefusesWhatItCannotHold) {
  VirtualCell::Options options;
  options.start = "nowhere";
  EXPECT_THROW(VirtualCell(gantry_cell(), wall_task(), options), InputError);
  Cell cell = gantry_cell();
  cell.X_BT.position_m.x() = 2.0;
  EXPECT_THROW(VirtualCell(cell, wall_task(), {}), InputError);
  options = {};
  options.offset[0] = -0.06;  // the wall stands in the part
  EXPECT_THROW(VirtualCell(gantry_cell(), wall_task(), options), InputError);
}

}  // namespace
}  // namespace tenon::sim

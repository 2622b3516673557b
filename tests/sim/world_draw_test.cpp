// Worlds that differ from what planner and executor believe: how they are drawn, and that each
// drawn number shows in forces or positions, in the direction that physics says.

#include "sim/cell/virtual_arm/world_draw.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <nlohmann/json.hpp>

#include "shared/base/error.h"
#include "sim/cell/virtual_arm/truth.h"
#include "tests/sim/literal_cell.h"

namespace tenon::sim {
namespace {

VirtualCell::Options in_world(const std::function<void(WorldDraw&)>& change) {
  VirtualCell::Options options;
  change(options.world);
  return options;
}

WorldRanges many_ranges() {
  WorldRanges ranges;
  ranges.friction = Spread{.low = 0.1, .high = 0.6};
  ranges.clearance_m.sigma = 1e-4;
  ranges.size_error_m.sigma = 5e-5;
  ranges.task_in_base_error_m = {.low = -0.01, .high = 0.01};
  ranges.payload_com_error_m.sigma = 0.002;
  ranges.servo_stiffness_factor = {.low = 0.5, .high = 2.0};
  ranges.extra_delay_s = {.low = 0.0, .high = 0.02};
  return ranges;
}

std::string text_of(const WorldDraw& draw) {
  Truth truth;
  truth.world = draw;
  return nlohmann::json::parse(truth_json(truth))["world"].dump();
}

TEST(WorldDrawTest, TheSameSeedIsTheSameWorldAndAnotherSeedAnother) {
  const Task task = wall_task();
  EXPECT_EQ(text_of(draw_world(many_ranges(), task, 5)),
            text_of(draw_world(many_ranges(), task, 5)));
  const WorldDraw one = draw_world(many_ranges(), task, 5);
  const WorldDraw other = draw_world(many_ranges(), task, 6);
  EXPECT_NE(one.friction, other.friction);
  EXPECT_NE(one.clearance_m, other.clearance_m);
  EXPECT_NE(one.task_in_base_error, other.task_in_base_error);
}

TEST(WorldDrawTest, ARangeMoreOrWiderLeavesTheOtherDrawsAlone) {
  const Task task = wall_task();
  const WorldDraw before = draw_world(many_ranges(), task, 5);
  WorldRanges wider = many_ranges();
  wider.friction.reset();
  wider.contact_stiffness_Npm = Spread{.low = 1e4, .high = 2e4};
  wider.tool_in_flange_error_rad.sigma = 0.01;
  wider.clearance_m.sigma = 2e-4;
  wider.payload_mass_error_kg.sigma = 0.1;
  const WorldDraw after = draw_world(wider, task, 5);
  EXPECT_EQ(after.task_in_base_error, before.task_in_base_error);
  EXPECT_EQ(after.held_size_error_m, before.held_size_error_m);
  EXPECT_EQ(after.environment_size_error_m, before.environment_size_error_m);
  EXPECT_EQ(after.payload_com_error_m, before.payload_com_error_m);
  EXPECT_EQ(after.servo_stiffness_factor, before.servo_stiffness_factor);
  EXPECT_EQ(after.extra_delay_s, before.extra_delay_s);
  EXPECT_DOUBLE_EQ(after.clearance_m, 2.0 * before.clearance_m);
}

TEST(WorldDrawTest, WithoutRangesTheWorldIsWhatTheFilesSay) {
  const WorldDraw draw = draw_world({}, wall_task(), 5);
  const Cell cell = gantry_cell();
  const Cell real = real_cell(cell, draw);
  EXPECT_EQ(real.X_BT, cell.X_BT);
  EXPECT_EQ(real.X_FP, cell.X_FP);
  EXPECT_EQ(real.X_FS, cell.X_FS);
  EXPECT_EQ(real.payload_mass_kg, cell.payload_mass_kg);
  EXPECT_EQ(real.payload_com_m, cell.payload_com_m);
  EXPECT_EQ(real.contact_stiffness_Npm, cell.contact_stiffness_Npm);
  EXPECT_EQ(real.robot.joints[1].stiffness, cell.robot.joints[1].stiffness);
  EXPECT_EQ(real.robot.sensor.force_noise_N, cell.robot.sensor.force_noise_N);
  const Task task = real_task(wall_task(), draw);
  EXPECT_EQ(task.held[0].size_m, wall_task().held[0].size_m);
  EXPECT_EQ(task.environment[1].size_m, wall_task().environment[1].size_m);
  EXPECT_EQ(task.friction.nominal, wall_task().friction.nominal);
}

TEST(WorldDrawTest, DrawsKeepToTheirRangesAndSigmas) {
  WorldRanges ranges = many_ranges();
  double low = 1.0;
  double high = 0.0;
  double squares = 0.0;
  double largest = 0.0;
  constexpr int kDraws = 4000;
  for (std::uint64_t seed = 0; seed < kDraws; ++seed) {
    const WorldDraw draw = draw_world(ranges, wall_task(), seed);
    low = std::min(low, *draw.friction);
    high = std::max(high, *draw.friction);
    squares += draw.clearance_m * draw.clearance_m;
    largest = std::max(largest, std::abs(draw.clearance_m));
  }
  EXPECT_GE(low, 0.1);
  EXPECT_LT(low, 0.105);
  EXPECT_LE(high, 0.6);
  EXPECT_GT(high, 0.595);
  // A normal distribution cut at three sigma has 0.9866 of the deviation.
  EXPECT_NEAR(std::sqrt(squares / kDraws), 0.9866e-4, 5 * 1e-4 / std::sqrt(2.0 * kDraws));
  EXPECT_LE(largest, 3e-4);
  EXPECT_GT(largest, 2.7e-4);
}

TEST(WorldDrawTest, ARoundShapeStaysRound) {
  Task task = wall_task();
  task.held[0].kind = Shape::Kind::kCylinder;
  const WorldDraw draw = draw_world(many_ranges(), task, 9);
  const Shape real = real_task(task, draw).held[0];
  EXPECT_NE(draw.held_size_error_m[0].x(), draw.held_size_error_m[0].y());
  EXPECT_EQ(real.size_m.x(), real.size_m.y());
  EXPECT_NE(real.size_m.x(), task.held[0].size_m.x());
}

TEST(WorldDrawTest, ASolidGrowsOnAllSidesAlike) {
  Task task = wall_task();
  task.held[0].kind = Shape::Kind::kSolid;
  const WorldDraw draw = draw_world(many_ranges(), task, 9);
  const Vector3 more_m = real_task(task, draw).held[0].size_m - task.held[0].size_m;
  EXPECT_NE(more_m.x(), 0.0);
  EXPECT_NEAR(more_m.x(), more_m.y(), 1e-15);
  EXPECT_NEAR(more_m.x(), more_m.z(), 1e-15);
}

TEST(WorldDrawTest, AWorldWithoutPartOrPayloadIsRefused) {
  WorldDraw draw;
  draw.clearance_m = 0.2;
  EXPECT_THROW(static_cast<void>(real_task(wall_task(), draw)), InputError);
  draw.payload_mass_error_kg = -0.6;
  EXPECT_THROW(static_cast<void>(real_cell(gantry_cell(), draw)), InputError);
}

// -- What each number does to the arm -----------------------------------------------------------

/// Encoder position at which the cube's push against the wall passes 3 N, m.
double wall_found_m(const VirtualCell::Options& options) {
  LiteralCell bench(gantry_cell(), wall_task(), options);
  EXPECT_TRUE(bench.enable());
  bench.move(0, 100, 400);  // starting jerks
  for (int i = 0; i < 300 && bench.wrench[0] > -3.0; ++i) bench.move(0, 100, 1);
  EXPECT_LT(bench.wrench[0], -3.0) << "no wall";
  return 1e-6 * bench.position_counts[0];
}

double wall_found_m(const std::function<void(WorldDraw&)>& change) {
  return wall_found_m(in_world(change));
}

// One sample's noise is worth 0.1 N / 5e4 N/m = 2 um, one cycle's motion 100 um.
constexpr double kCycle_m = 1.5e-4;

TEST(WorldEffectTest, TheWallStandsWhereGeometryAndCalibrationReallyPutIt) {
  const double nominal_m = wall_found_m([](WorldDraw&) {});
  EXPECT_NEAR(nominal_m, 0.05, 3e-4);
  const double smaller_m = wall_found_m([](WorldDraw& w) { w.clearance_m = 0.004; });
  EXPECT_NEAR(smaller_m - nominal_m, 0.002, kCycle_m);
  const double thicker_m = wall_found_m([](WorldDraw& w) {
    w.environment_size_error_m = {Vector3::Zero(), {0.006, 0.0, 0.0}};
  });
  EXPECT_NEAR(thicker_m - nominal_m, -0.003, kCycle_m);
  const double longer_m = wall_found_m([](WorldDraw& w) {
    w.held_size_error_m = {{0.006, 0.0, 0.0}};
  });
  EXPECT_NEAR(longer_m - nominal_m, -0.003, kCycle_m);
  const double further_m = wall_found_m([](WorldDraw& w) { w.task_in_base_error[0] = 0.005; });
  EXPECT_NEAR(further_m - nominal_m, 0.005, kCycle_m);
  const double ahead_m = wall_found_m([](WorldDraw& w) { w.tool_in_flange_error[0] = 0.005; });
  EXPECT_NEAR(ahead_m - nominal_m, -0.005, kCycle_m);
}

TEST(WorldEffectTest, ATurnedTableIsFoundAtAnAngle) {
  // The wall turned by 0.05 rad about z: the cube's edge, 50 mm off, meets it first.
  const double nominal_m = wall_found_m([](WorldDraw&) {});
  const double turned_m = wall_found_m([](WorldDraw& w) { w.task_in_base_error[5] = 0.05; });
  EXPECT_NEAR(turned_m - nominal_m, -0.05 * 0.05, 2.0 * kCycle_m);
}

/// Mean wrench at rest, free.
Vector6 rest_wrench(const std::function<void(WorldDraw&)>& change) {
  LiteralCell bench(gantry_cell(), wall_task(), in_world(change));
  EXPECT_TRUE(bench.enable());
  bench.cycles_of(0x0F, 100);
  return bench.mean_wrench(300);
}

TEST(WorldEffectTest, TheSensorReadsThePayloadAsItReallyHangs) {
  constexpr double kNoise_N = 0.03;  // five of 0.1 N over the square root of 300
  constexpr double kNoise_Nm = 0.0015;
  constexpr double kWeight_N = 0.5 * 9.80665;
  const Vector6 nominal = rest_wrench([](WorldDraw&) {});
  const Vector6 heavier = rest_wrench([](WorldDraw& w) { w.payload_mass_error_kg = 0.1; });
  EXPECT_NEAR(heavier[2] - nominal[2], -0.1 * 9.80665, kNoise_N);
  const Vector6 off = rest_wrench([](WorldDraw& w) { w.payload_com_error_m = {0.0, 0.01, 0.0}; });
  EXPECT_NEAR(off[3] - nominal[3], -0.01 * kWeight_N, kNoise_Nm);  // r x F = (y Fz, ...)
  const Vector6 turned = rest_wrench([](WorldDraw& w) { w.sensor_in_flange_error[4] = 0.1; });
  EXPECT_NEAR(turned[0] - nominal[0], std::sin(0.1) * kWeight_N, kNoise_N);
  const Vector6 aside = rest_wrench([](WorldDraw& w) { w.sensor_in_flange_error[0] = 0.02; });
  EXPECT_NEAR(aside[4] - nominal[4], -0.02 * kWeight_N, kNoise_Nm);
}

// 0.2 mm into the wall.
TEST(WorldEffectTest, ASofterContactPushesBackLess) {
  const auto push_N = [](double stiffness_Npm) {
    LiteralCell bench(gantry_cell(), wall_task(),
                      in_world([&](WorldDraw& w) { w.contact_stiffness_Npm = stiffness_Npm; }));
    EXPECT_TRUE(bench.enable());
    bench.move(0, 100, 502);
    return -bench.mean_wrench(200)[0];
  };
  EXPECT_NEAR(push_N(5e4), 10.0, 0.3);
  EXPECT_NEAR(push_N(2e4), 4.0, 0.3);
}

// Pressed onto the table, dragged along y.
TEST(WorldEffectTest, FrictionHoldsTheDraggedPartBack) {
  const auto drag = [](double friction) {
    LiteralCell bench(gantry_cell(), wall_task(),
                      in_world([&](WorldDraw& w) { w.friction = friction; }));
    EXPECT_TRUE(bench.enable());
    bench.move(2, -20, 112);  // the table is 2 mm below; 0.24 mm into it
    bench.move(1, 50, 100);
    Vector6 sum = Vector6::Zero();
    for (int i = 0; i < 100; ++i) {
      bench.move(1, 50, 1);
      sum += bench.wrench;
    }
    const Vector6 mean = sum / 100.0;
    return -mean[1] / (mean[2] + 0.5 * 9.80665);
  };
  EXPECT_NEAR(drag(0.1), 0.1, 0.02);
  EXPECT_NEAR(drag(0.6), 0.6, 0.02);
}

TEST(WorldEffectTest, AnExtraDelayShowsAsLagAlongAMotion) {
  const auto lag_counts = [](double delay_s) {
    LiteralCell bench(gantry_cell(), wall_task(),
                      in_world([&](WorldDraw& w) { w.extra_delay_s = delay_s; }));
    EXPECT_TRUE(bench.enable());
    bench.move(1, 200, 300);  // 0.1 m/s
    return bench.target_counts[1] - bench.position_counts[1];
  };
  EXPECT_NEAR(lag_counts(0.010) - lag_counts(0.0), 0.010 * 1e5, 10.0);
}

TEST(WorldEffectTest, ASofterServoJerksLessWhenItStarts) {
  const auto peak_permille = [](double factor) {
    LiteralCell bench(gantry_cell(), wall_task(),
                      in_world([&](WorldDraw& w) { w.servo_stiffness_factor = factor; }));
    EXPECT_TRUE(bench.enable());
    int peak = 0;
    for (int i = 0; i < 50; ++i) {
      bench.move(1, 20, 1);  // 10 mm/s at once
      peak = std::max(peak, std::abs(bench.torque_permille[1]));
    }
    return peak;
  };
  EXPECT_LT(peak_permille(0.25), 0.75 * peak_permille(1.0));
}

TEST(WorldEffectTest, BacklashLetsALoadedAxisHangBelowItsEncoder) {
  LiteralCell bench(gantry_cell(), wall_task(),
                    in_world([](WorldDraw& w) { w.backlash_m = 0.001; }));
  ASSERT_TRUE(bench.enable());
  bench.cycles_of(0x0F, 200);
  const Truth truth = bench.cell.truth();
  EXPECT_NEAR(1e-6 * bench.position_counts[2] - truth.drives[2].position, 0.0005, 2e-6);
  EXPECT_NEAR(truth.error[2], -0.0005, 2e-6);
}

TEST(WorldEffectTest, ANoisierSensorScattersMoreAndADriftingOneWanders) {
  const auto scatter_N = [](double factor) {
    LiteralCell bench(gantry_cell(), wall_task(),
                      in_world([&](WorldDraw& w) { w.sensor_noise_factor = factor; }));
    EXPECT_TRUE(bench.enable());
    bench.cycles_of(0x0F, 100);
    double sum = 0.0;
    double squares = 0.0;
    for (int i = 0; i < 400; ++i) {
      bench.cycle();
      sum += bench.wrench[0];
      squares += bench.wrench[0] * bench.wrench[0];
    }
    return std::sqrt(squares / 400 - sum * sum / 160'000);
  };
  EXPECT_NEAR(scatter_N(1.0), 0.1, 0.02);
  EXPECT_NEAR(scatter_N(5.0), 0.5, 0.1);

  LiteralCell bench(gantry_cell(), wall_task(),
                    in_world([](WorldDraw& w) { w.force_drift_N_sqrts = 5.0; }));
  ASSERT_TRUE(bench.enable());
  const Vector6 before = bench.mean_wrench(200);
  bench.cycles_of(0x0F, 400);
  const Vector6 after = bench.mean_wrench(200);
  EXPECT_GT((after - before).head<3>().norm(), 0.5);
  EXPECT_LT((after - before).tail<3>().norm(), 0.005);
}

TEST(WorldEffectTest, NoFrameTellsTheDrawUntilItActs) {
  const auto log_of = [](const std::function<void(WorldDraw&)>& change, int cycles) {
    LiteralCell bench(gantry_cell(), wall_task(), in_world(change));
    EXPECT_TRUE(bench.enable());
    bench.move(0, 100, cycles);
    return bench.log;
  };
  const auto other = [](WorldDraw& w) {
    w.friction = 0.6;
    w.contact_stiffness_Npm = 1e4;
    w.clearance_m = 0.001;
    w.task_in_base_error[0] = -0.004;
  };
  EXPECT_EQ(log_of([](WorldDraw&) {}, 400), log_of(other, 400));
  EXPECT_NE(log_of([](WorldDraw&) {}, 500), log_of(other, 500));
}

}  // namespace
}  // namespace tenon::sim

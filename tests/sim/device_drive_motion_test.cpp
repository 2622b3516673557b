// The drive's axis: ramps and their decelerations, halt, following error, brake and its delays,
// torque limit, temperature, supply.

#include <gtest/gtest.h>

#include <cmath>

#include "tests/sim/device_bench.h"

namespace tenon::sim {
namespace {

/// How to stop, and the object whose deceleration the ramp follows.
struct Stop {
  const char* what;
  ObjectAddress option;
  int value;
  int controlword;
  std::uint16_t deceleration;
};

class DriveRampTest : public ::testing::TestWithParam<std::tuple<int, Stop>> {};

INSTANTIATE_TEST_SUITE_P(
    Stops, DriveRampTest,
    ::testing::Combine(::testing::Values(7, 8),
                       ::testing::Values(Stop{"quick stop 1", {0x605A}, 1, 0x02, 0x6084},
                                         Stop{"quick stop 2", {0x605A}, 2, 0x02, 0x6085},
                                         Stop{"quick stop 5", {0x605A}, 5, 0x02, 0x6084},
                                         Stop{"quick stop 6", {0x605A}, 6, 0x02, 0x6085},
                                         Stop{"shutdown", {0x605B}, 1, 0x06, 0x6084},
                                         Stop{"disable operation", {0x605C}, 1, 0x07, 0x6084})));

// v = 100,000 counts/s. With a = 1,000,000: 100 ms and v^2 / 2a = 5,000 counts; with 2,000,000
// half.
TEST_P(DriveRampTest, StopsWithinTheWayOfItsDeceleration) {
  const auto& [mode, stop] = GetParam();
  SCOPED_TRACE(stop.what);
  DriveBench bench(static_cast<std::int8_t>(mode));
  bench.configure();
  EXPECT_EQ(bench.write_u32({0x6085}, 2'000'000), 0U);
  EXPECT_EQ(bench.write_u16(stop.option, stop.value), 0U);
  bench.enable();
  bench.run_fast();
  const double expected = stop.deceleration == 0x6085 ? 2500.0 : 5000.0;
  const double start = bench.plant.position_counts;
  bench.control(stop.controlword);
  bench.pass(expected / 50.0 - 5.0);
  EXPECT_GT(bench.plant.velocity_countsps, 0.0);
  bench.pass(20);
  EXPECT_EQ(bench.plant.velocity_countsps, 0.0);
  EXPECT_NEAR(bench.plant.position_counts - start, expected, 50.0);  // half a step at full speed
}

TEST(DriveMotionTest, HaltStopsUnderPowerAndGoesOnWhenItsBitFalls) {
  for (const int option : {1, 2}) {
    DriveBench bench(7);
    bench.configure();
    EXPECT_EQ(bench.write_u32({0x6085}, 2'000'000), 0U);
    EXPECT_EQ(bench.write_u16({0x605D}, option), 0U);
    bench.enable();
    bench.run_fast();
    const double start = bench.plant.position_counts;
    bench.control(0x11F);
    EXPECT_EQ(bench.status() & 0x0400, 0) << "it still slows down";
    bench.pass(150);
    EXPECT_NEAR(bench.plant.position_counts - start, option == 2 ? 2500.0 : 5000.0, 50.0);
    EXPECT_EQ(bench.long_state(), 0x27);
    EXPECT_EQ(bench.status() & 0x0400, 0x0400) << "it stands";
    EXPECT_FALSE(bench.drive.brake_engaged());
    const double halted = bench.plant.position_counts;
    bench.run(5, 100);
    EXPECT_EQ(bench.plant.position_counts, halted) << "targets wait";
    bench.commanded = static_cast<int>(std::lround(halted));
    bench.control(0x1F);
    bench.run(5, 100);
    EXPECT_NEAR(bench.plant.position_counts, halted + 500.0, 1.0);
  }
}

TEST(DriveMotionTest, ModeEightHasNoHalt) {
  DriveBench bench(8);
  bench.configure();
  bench.enable();
  bench.control(0x10F);
  bench.run(5, 100);
  EXPECT_NEAR(bench.plant.position_counts, 500.0, 1.0);
}

TEST(DriveMotionTest, ModeSevenInterpolatesOnlyWithItsControlBit) {
  DriveBench bench(7);
  bench.configure();
  bench.enable();
  bench.control(0x0F);
  bench.run(5, 100);
  EXPECT_EQ(bench.plant.position_counts, 0.0);
  EXPECT_EQ(bench.status() & 0x1000, 0);
  bench.control(0x1F);
  EXPECT_EQ(bench.status() & 0x1000, 0x1000);
}

// SYNC ── half a target ── RPDO 0Fh ── the other half
TEST(DriveMotionTest, TheEnableWordOfEveryCycleDisturbsNothing) {
  DriveBench bench;
  bench.configure();
  bench.enable();
  for (int i = 1; i <= 20; ++i) {
    bench.write_u32({0x607A}, 100 * i);
    bench.sync();
    bench.pass(1);
    bench.tell({0x205, {0x0F, 0x00}});
    bench.pass(1);
    EXPECT_NEAR(bench.plant.position_counts, 100.0 * i, 1e-6);
    EXPECT_NEAR(bench.plant.velocity_countsps, 50'000.0, 1e-6);
  }
}

TEST(DriveMotionTest, PositionsAreReadWithoutASyncToo) {
  DriveBench bench;
  bench.plant.position_counts = -1234.0;
  bench.pass(1);
  EXPECT_EQ(bench.signed_value({0x6064}), -1234);
}

// Stuck at 0; the demand is beyond 6065h = 500 from the third cycle on, for longer than 6066h.
TEST(DriveMotionTest, AFollowingErrorBeyondItsWindowAndTimeIsAFault) {
  DriveBench bench;
  bench.configure();
  EXPECT_EQ(bench.write_u32({0x6065}, 500), 0U);
  EXPECT_EQ(bench.write_u16({0x6066}, 10), 0U);
  bench.enable();
  bench.stuck = true;
  bench.run(3, 200);
  EXPECT_EQ(bench.signed_value({0x60F4}), 600);
  EXPECT_EQ(bench.signed_value({0x6062}), 600);
  EXPECT_EQ(bench.status() & 0x2000, 0x2000);
  bench.run(4, 0);
  EXPECT_EQ(bench.long_state(), 0x27);
  bench.run(2, 0);
  EXPECT_EQ(bench.emergencies(), (Emergencies{{0x8611, 0x21}}));
  bench.pass(20);
  EXPECT_EQ(bench.short_state(), 0x08);
  EXPECT_EQ(bench.value({0x603F}), 0x8611U);
}

TEST(DriveMotionTest, AWindowOfZeroOrAllOnesWatchesNothing) {
  for (const std::uint32_t window : {0x0U, 0xFFFFFFFFU}) {
    DriveBench bench;
    bench.configure();
    EXPECT_EQ(bench.write_u32({0x6065}, window), 0U);
    bench.enable();
    bench.stuck = true;
    bench.run(50, 1000);
    EXPECT_EQ(bench.long_state(), 0x27);
  }
}

// enable ── output on ── 20 ms: brake open, operation enabled
TEST(DriveMotionTest, TheBrakeOpensAndClosesWithItsDelays) {
  DriveBench bench;
  bench.configure();
  bench.control(0x06);
  bench.control(0x07);
  bench.control(0x0F);
  EXPECT_FALSE(bench.drive.brake_engaged());
  bench.pass(20);
  EXPECT_TRUE(bench.demand.brake) << "not open yet";
  EXPECT_TRUE(bench.demand.powered) << "the servo holds already";
  bench.pass(1);
  EXPECT_FALSE(bench.demand.brake);
  // Disabling: the servo holds until the brake does.
  bench.control(0x07);
  bench.pass(1);
  EXPECT_TRUE(bench.drive.brake_engaged());
  bench.pass(8);
  EXPECT_TRUE(bench.demand.powered);
  EXPECT_FALSE(bench.demand.brake);
  EXPECT_EQ(bench.long_state(), 0x27);
  bench.pass(3);
  EXPECT_FALSE(bench.demand.powered);
  EXPECT_TRUE(bench.demand.brake);
  EXPECT_EQ(bench.long_state(), 0x23);
}

TEST(DriveMotionTest, WithoutVoltageTheAxisIsFreeUntilTheBrakeBites) {
  DriveBench bench;
  bench.configure();
  bench.enable();
  bench.control(0x00);
  bench.pass(9);
  EXPECT_FALSE(bench.demand.powered);
  EXPECT_FALSE(bench.demand.brake);
  bench.pass(2);
  EXPECT_TRUE(bench.demand.brake);
}

TEST(DriveMotionTest, TheTorqueLimitReachesTheServoAndItsBitTellsWhenItActs) {
  DriveBench bench;
  bench.configure();
  EXPECT_EQ(bench.value({0x6072}), 3000U);
  EXPECT_EQ(bench.write_u16({0x6072}, 500), 0U);
  bench.enable();
  EXPECT_EQ(bench.demand.torque_max_permille, 500.0);
  bench.torque_permille = -499.0;
  bench.pass(1);
  EXPECT_EQ(bench.signed_value({0x6077}), -499);
  EXPECT_EQ(bench.status() & 0x0800, 0);
  bench.torque_permille = -500.0;
  bench.pass(1);
  EXPECT_EQ(bench.status() & 0x0800, 0x0800);
}

// T(t) = T_a + rise load^2 (1 - exp(-t / tau)): 25 + 40 * 4 * (1 - exp(-1)) = 126.1 after tau.
TEST(DriveMotionTest, TheTemperatureRisesWithTheSquareOfTheLoad) {
  DriveBench bench({.node = 5,
                    .rise_K = 40.0,
                    .thermal_time_constant_s = 2.0,
                    .warning_degC = 200.0,
                    .fault_degC = 300.0});
  EXPECT_EQ(bench.value({0x2030}), 250U);
  bench.torque_permille = 2000.0;
  bench.pass(2000);
  EXPECT_NEAR(static_cast<double>(bench.value({0x2030})), 1261.4, 2.0);
  bench.torque_permille = 0.0;
  bench.pass(2000);
  EXPECT_NEAR(static_cast<double>(bench.value({0x2030})), 250.0 + 1011.4 * std::exp(-1.0), 2.0);
}

TEST(DriveMotionTest, AHotDriveWarnsThenFaultsAndStaysFaultedWhileItIsHot) {
  DriveBench bench({.node = 5, .rise_K = 100.0, .thermal_time_constant_s = 1.0});
  bench.configure();
  bench.enable();
  bench.torque_permille = 1000.0;
  bench.pass(700);  // 25 + 100 (1 - exp(-0.7)) = 75
  EXPECT_EQ(bench.status() & 0x0080, 0);
  bench.pass(200);  // 84: above 80
  EXPECT_EQ(bench.status() & 0x0080, 0x0080);
  EXPECT_EQ(bench.long_state(), 0x27);
  bench.pass(500);  // above 95
  EXPECT_EQ(bench.emergencies(), (Emergencies{{0x4310, 0x09}}));
  EXPECT_EQ(bench.short_state(), 0x08);
  bench.control(0x80);
  bench.pass(1);
  EXPECT_EQ(bench.short_state(), 0x08) << "still hot";
  bench.torque_permille = 0.0;
  bench.pass(1000);
  bench.control(0x00);
  bench.control(0x80);
  EXPECT_EQ(bench.short_state(), 0x40);
}

TEST(DriveMotionTest, WithoutSupplyAnEnabledDriveFaultsAndCannotRamp) {
  DriveBench bench;
  bench.configure();
  bench.enable();
  EXPECT_EQ(bench.value({0x6079}), 48000U);
  EXPECT_EQ(bench.status() & 0x0010, 0x0010);
  bench.run_fast();
  bench.drive.set_supply(20.0);
  bench.pass(1);
  EXPECT_EQ(bench.emergencies(), (Emergencies{{0x3220, 0x05}}));
  EXPECT_EQ(bench.short_state(), 0x08) << "no fault reaction without power";
  EXPECT_EQ(bench.status() & 0x0010, 0);
  EXPECT_TRUE(bench.drive.brake_engaged());
  bench.control(0x80);
  EXPECT_EQ(bench.short_state(), 0x40);
  bench.control(0x06);
  bench.control(0x07);
  bench.pass(1);
  EXPECT_EQ(bench.short_state(), 0x08) << "it does not switch on without";
}

}  // namespace
}  // namespace tenon::sim

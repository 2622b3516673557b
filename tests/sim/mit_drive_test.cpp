// A virtual motor in MIT mode behind frames written by hand. Ranges 12.5 rad, 30 rad/s, 10 Nm, so
// that 1 rad is 8A3Dh, 1 rad/s 844h, 10 Nm/rad 052h, 1 Nm s/rad 333h and 1 Nm 8CCh.

#include "sim/cell/devices/mit_drive.h"

#include <gtest/gtest.h>

#include <array>
#include <vector>

#include "shared/mit/robot_motors.h"

namespace tenon::sim {
namespace {

using FrameBytes = std::array<std::uint8_t, 8>;

constexpr double kCountsPerRad = 65535.0 / 25.0;
constexpr FrameBytes kEnableFrame = {0xFF, 0xFF, 0xFF, 0xFF, 0xFF, 0xFF, 0xFF, 0xFC};
constexpr FrameBytes kDisableFrame = {0xFF, 0xFF, 0xFF, 0xFF, 0xFF, 0xFF, 0xFF, 0xFD};
constexpr FrameBytes kClearFrame = {0xFF, 0xFF, 0xFF, 0xFF, 0xFF, 0xFF, 0xFF, 0xFB};
constexpr FrameBytes kCommandOfOnes = {0x8A, 0x3D, 0x84, 0x40, 0x52, 0x33, 0x38, 0xCC};
constexpr std::int64_t kMs_ns = 1'000'000;

class MitDriveTest : public ::testing::Test {
 protected:
  MitDriveTest() : drive(joint()) { drive.power_on(0); }

  static Joint joint() {
    Joint it;
    it.kind = Joint::Kind::kRevolute;
    it.node = 1;
    it.rated_effort = 4.0;
    it.counts_per_unit = kCountsPerRad;
    it.zero_counts = 32767.5;
    MitMotor motor;
    motor.feedback_id = 0x11;
    it.drive = motor;
    return it;
  }

  /// What it answers, one frame; empty bytes where it says nothing.
  CanFrame ask(std::uint32_t id, const FrameBytes& bytes) {
    CanFrame frame;
    frame.id = id;
    frame.length = 8;
    frame.data = bytes;
    drive.receive(frame, now_ns);
    std::vector<CanFrame> answers;
    drive.take(answers);
    return answers.empty() ? CanFrame{} : answers.front();
  }
  void pass(std::int64_t milliseconds) {
    now_ns += milliseconds * kMs_ns;
    drive.advance(now_ns);
  }
  void enable_in_mit_mode() {
    ask(0x7FF, {1, 0, 0x55, 0x0A, 1, 0, 0, 0});
    ask(0x001, kEnableFrame);
  }

  MitDrive drive;
  std::int64_t now_ns = 0;
};

TEST_F(MitDriveTest, AnswersEveryFrameWithWhatTheAxisDoes) {
  drive.measured({(1.0 + 12.5) * kCountsPerRad, 1.0 * kCountsPerRad, 250.0}, kMs_ns);
  // Off; 1 rad, 1 rad/s, 1 Nm of 4 rated; 25 degC twice.
  const CanFrame off = ask(0x001, kDisableFrame);
  EXPECT_EQ(off.id, 0x011U);
  EXPECT_EQ(off.data, (FrameBytes{0x01, 0x8A, 0x3D, 0x84, 0x48, 0xCC, 0x19, 0x19}));
  EXPECT_EQ(ask(0x001, kEnableFrame).data[0], 0x11);
  EXPECT_EQ(ask(0x002, kEnableFrame).length, 0) << "of another motor";
}

TEST_F(MitDriveTest, AFrozenEffortIsReportedAgainAndAgainAndNoiseWhileItIsOn) {
  const auto torque_counts = [](const CanFrame& frame) {
    return (frame.data[4] & 0x0FU) << 8U | frame.data[5];
  };
  const VirtualDrive::Measurement measured = {0.0, 0.0, 250.0, 50.0};
  drive.measured(measured, kMs_ns);
  const auto off = torque_counts(ask(0x001, kDisableFrame));
  enable_in_mit_mode();
  drive.measured(measured, kMs_ns);
  const auto on = torque_counts(ask(0x001, kCommandOfOnes));
  EXPECT_GT(on, off);
  drive.inject({.kind = FaultKind::kFrozenEffort, .node = 1});
  drive.measured({0.0, 0.0, -250.0, 0.0}, kMs_ns);
  EXPECT_EQ(torque_counts(ask(0x001, kCommandOfOnes)), on);
}

TEST_F(MitDriveTest, ObeysStiffnessDampingAndTorqueOfTheCommand) {
  enable_in_mit_mode();
  EXPECT_EQ(ask(0x001, kCommandOfOnes).data[0], 0x11);
  const VirtualDrive::Demand demand = drive.demand(kMs_ns);
  EXPECT_TRUE(demand.powered);
  EXPECT_FALSE(demand.brake);
  EXPECT_NEAR(demand.position_counts / kCountsPerRad - 12.5, 1.0, 2e-4);
  EXPECT_NEAR(demand.velocity_countsps / kCountsPerRad, 1.0, 8e-3);
  ASSERT_TRUE(demand.impedance);
  EXPECT_NEAR(demand.impedance->stiffness, 10.0, 0.07);
  EXPECT_DOUBLE_EQ(demand.impedance->damping, 1.0);
  EXPECT_NEAR(demand.impedance->effort, 1.0, 3e-3);
}

TEST_F(MitDriveTest, CommandsOfAnotherModeAreAnsweredAndNotObeyed) {
  ask(0x001, kEnableFrame);
  EXPECT_EQ(ask(0x001, kCommandOfOnes).data[0], 0x11);
  EXPECT_FALSE(drive.look().enabled);
}

TEST_F(MitDriveTest, StandHoldsItUntilItObeysAndNothingOnceItIsOff) {
  EXPECT_TRUE(drive.demand(kMs_ns).brake);
  enable_in_mit_mode();
  EXPECT_TRUE(drive.demand(kMs_ns).brake);
  ask(0x001, kCommandOfOnes);
  EXPECT_FALSE(drive.demand(kMs_ns).brake);
  ask(0x001, kDisableFrame);
  // Friction of 0.5 Nm is all that is left, of 4 rated.
  const VirtualDrive::Demand off = drive.demand(kMs_ns);
  EXPECT_FALSE(off.brake);
  EXPECT_EQ(off.impedance->stiffness, 0.0);
  EXPECT_EQ(off.impedance->effort, 0.0);
  EXPECT_DOUBLE_EQ(off.torque_max_permille, 125.0);
}

TEST_F(MitDriveTest, RegistersAreReadAndWrittenWhileItIsOff) {
  EXPECT_EQ(ask(0x7FF, {1, 0, 0x33, 0x07, 0, 0, 0, 0}).data,
            (FrameBytes{1, 0, 0x33, 0x07, 0x11, 0, 0, 0}));
  EXPECT_EQ(ask(0x7FF, {1, 0, 0x33, 0x15, 0, 0, 0, 0}).data,
            (FrameBytes{1, 0, 0x33, 0x15, 0x00, 0x00, 0x48, 0x41}));
  EXPECT_EQ(ask(0x7FF, {1, 0, 0x55, 0x09, 0x90, 1, 0, 0}).data,
            (FrameBytes{1, 0, 0x55, 0x09, 0x90, 1, 0, 0}));
  EXPECT_EQ(ask(0x7FF, {2, 0, 0x33, 0x07, 0, 0, 0, 0}).length, 0) << "of another motor";
  ask(0x001, kEnableFrame);
  EXPECT_EQ(ask(0x7FF, {1, 0, 0x55, 0x09, 0, 0, 0, 0}).data,
            (FrameBytes{1, 0, 0x55, 0x09, 0x90, 1, 0, 0}));
}

// TIMEOUT 400 x 50 us = 20 ms.
TEST_F(MitDriveTest, WithoutCommandsItLosesItsMasterAndGoesOffUntilThatIsCleared) {
  ask(0x7FF, {1, 0, 0x55, 0x09, 0x90, 1, 0, 0});
  enable_in_mit_mode();
  ask(0x001, kCommandOfOnes);
  pass(20);
  EXPECT_TRUE(drive.look().enabled);
  pass(1);
  EXPECT_TRUE(drive.look().faulted);
  EXPECT_EQ(drive.demand(kMs_ns).impedance->stiffness, 0.0);
  EXPECT_EQ(ask(0x001, kCommandOfOnes).data[0], 0xD1);
  EXPECT_EQ(ask(0x001, kEnableFrame).data[0], 0xD1);
  EXPECT_EQ(ask(0x001, kClearFrame).data[0], 0x01);
}

TEST_F(MitDriveTest, HasNoFaultsOfABrakeAndNoErrorsButItsOwn) {
  EXPECT_FALSE(drive.can_have({.kind = FaultKind::kBrakeFailure}));
  EXPECT_FALSE(drive.can_have({.kind = FaultKind::kSlowBrake}));
  EXPECT_FALSE(drive.can_have({.kind = FaultKind::kEmergency, .value = 0x3210}));
  const Fault hot = {.kind = FaultKind::kEmergency, .value = 0xB};
  ASSERT_TRUE(drive.can_have(hot));
  enable_in_mit_mode();
  drive.inject(hot);
  EXPECT_EQ(ask(0x001, kCommandOfOnes).data[0], 0xB1);
}

}  // namespace
}  // namespace tenon::sim

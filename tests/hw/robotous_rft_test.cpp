// A Robotous RFT sensor, the master's side: every frame as literal bytes, what becomes of lost
// ones, and its start. 50 counts a newton, 2000 a newton metre.

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "hw/arm/describe_fault.h"
#include "hw/sensors/robotous_rft_source.h"
#include "hw/sensors/robotous_rft_start.h"
#include "hw/sensors/wrench_intake.h"
#include "tests/hw/gantry_on_bus.h"

namespace tenon::hw {
namespace {

using Taken = WrenchSource::Taken;

constexpr std::int64_t kMs = 1'000'000;

ForceTorqueSensor rft() {
  return {.protocol = SensorProtocol::kRobotousRft,
          .profile = "robotous_rft",
          .request_id = 0x64,
          .sample_ids = {0x01, 0x02},
          .rate_hz = 200,
          .force_per_count_N = 0.02,
          .torque_per_count_Nm = 0.0005,
          .force_range_N = 200.0,
          .torque_range_Nm = 4.0,
          .cycles_per_sample = 3};
}

Robot robot_with_rft() {
  Robot robot = gantry_robot();
  robot.sensor = rft();
  return robot;
}

// fx -1000, fy 50, fz 5000, tx -300 counts: its high byte FEh here, its low one D4h there.
const CanFrame kFirst{0x01, false, false, 8, {0x0B, 0xFC, 0x18, 0x00, 0x32, 0x13, 0x88, 0xFE}};
// ty 2000, tz -1; no overload.
const CanFrame kSecond{0x02, false, false, 8, {0xD4, 0x07, 0xD0, 0xFF, 0xFF, 0x00, 0x00, 0x00}};

class RobotousRft : public testing::Test {
 protected:
  Taken take(const CanFrame& frame, std::int64_t time_ns) { return intake.take(frame, time_ns); }

  RobotousRftSource source{rft()};
  WrenchIntake intake{source, rft()};
};

TEST_F(RobotousRft, TwoFramesAreOneWrenchWhoseTxStraddlesThem) {
  EXPECT_EQ(take(kFirst, 0), Taken::kHalf);
  ASSERT_TRUE(intake.force_N());
  EXPECT_TRUE(intake.force_N()->isApprox(Vector3(-20.0, 1.0, 100.0)));
  EXPECT_FALSE(intake.sample());
  EXPECT_EQ(take(kSecond, kMs), Taken::kHalf);
  ASSERT_TRUE(intake.sample());
  Vector6 wrench;
  wrench << -20.0, 1.0, 100.0, -0.15, 1.0, -0.0005;
  EXPECT_TRUE(intake.sample()->wrench.isApprox(wrench)) << intake.sample()->wrench.transpose();
  EXPECT_FALSE(intake.saturated());
  EXPECT_FALSE(intake.unwell());
  EXPECT_EQ(intake.torn(), 0U);
}

TEST_F(RobotousRft, NoHalfIsJoinedWithAnotherSamples) {
  // The second frame of one is lost, and the first of the next.
  (void)take(kFirst, 0);
  (void)take(kSecond, 5 * kMs);
  EXPECT_FALSE(intake.sample());
  EXPECT_EQ(intake.torn(), 1U);
  // The next is whole.
  (void)take(kFirst, 10 * kMs);
  (void)take(kSecond, 10 * kMs);
  EXPECT_TRUE(intake.sample());
  EXPECT_EQ(intake.torn(), 2U);
  // One second frame too many.
  (void)take(kSecond, 10 * kMs);
  EXPECT_FALSE(intake.sample());
  // The other way round.
  (void)take(kSecond, 15 * kMs);
  (void)take(kFirst, 15 * kMs);
  EXPECT_FALSE(intake.sample());
  // A first frame twice: the later one is it.
  (void)take(kFirst, 20 * kMs);
  (void)take(kSecond, 20 * kMs);
  EXPECT_TRUE(intake.sample());
}

TEST_F(RobotousRft, EachWholeSampleIsNew) {
  std::uint16_t before = 0;
  for (int i = 1; i < 70'000; ++i) {
    (void)take(kFirst, 5 * i * kMs);
    (void)take(kSecond, 5 * i * kMs);
    ASSERT_TRUE(intake.sample()) << i;
    ASSERT_NE(intake.sample()->counter, before);
    before = intake.sample()->counter;
  }
}

TEST_F(RobotousRft, AnOverloadIsToldWhateverTheValuesAre) {
  CanFrame overloaded = kSecond;
  overloaded.data[5] = 0b000101;
  (void)take(kFirst, 0);
  (void)take(overloaded, 0);
  ASSERT_TRUE(intake.unwell());
  EXPECT_EQ(*intake.unwell(), 5U);
  const ArmFault fault = {ArmFaultKind::kSensorInvalid, 0, 0x200200, 5};
  EXPECT_EQ(describe(fault, robot_with_rft()),
            "force/torque sensor robotous_rft: reports overload 0x05 (fx fz); the load is too high "
            "or the sensor is damaged");
}

TEST_F(RobotousRft, WhatItAnswersToCommandsAndWhatOthersSendIsNoWrench) {
  CanFrame answer = kFirst;
  answer.data[0] = 0x0F;
  (void)take(kFirst, 0);
  EXPECT_EQ(take(answer, 0), Taken::kForeign);
  (void)take(kSecond, 0);  // of that answer
  EXPECT_FALSE(intake.sample());
  CanFrame other = kFirst;
  other.id = 0x03;
  EXPECT_EQ(take(other, 0), Taken::kForeign);
  for (const bool remote : {false, true}) {
    other = kFirst;
    other.remote = remote;
    other.extended = !remote;
    EXPECT_EQ(take(other, 0), Taken::kForeign);
  }
  other = kFirst;
  other.length = 7;
  EXPECT_EQ(take(other, 0), Taken::kMalformed);
}

TEST_F(RobotousRft, NoCycleWaitsForIt) {
  for (int cycle = 0; cycle < 10; ++cycle) {
    EXPECT_FALSE(intake.begin_cycle());
    EXPECT_TRUE(intake.answered());
  }
}

// --- its start ---

/// The start on a bus whose other end the test is.
class RobotousRftStarts : public testing::Test {
 protected:
  /// What the sensor is sent until then.
  std::vector<CanFrame> sent(int until_ms) {
    std::vector<CanFrame> frames;
    for (; now_ms < until_ms; ++now_ms) {
      start.update(now_ms * kMs, master);
      ReceivedFrame received;
      while (sensor.receive(received)) frames.push_back(received.frame);
    }
    return frames;
  }
  void hear(const CanFrame& frame) { start.process(frame); }

  sim::VirtualBus bus{{.bitrate_bps = 0}};
  CanBus& master = bus.attach();
  CanBus& sensor = bus.attach();
  RobotousRftStart start{rft()};
  int now_ms = 0;
};

const CanFrame kStop{0x64, false, false, 8, {0x0C}};
const CanFrame kRate{0x64, false, false, 8, {0x0F, 0x05}};
const CanFrame kStart{0x64, false, false, 8, {0x0B}};
const CanFrame kRateSet{0x01, false, false, 8, {0x0F, 0x01}};

TEST_F(RobotousRftStarts, StopsItSetsItsRateAndStartsIt) {
  EXPECT_EQ(sent(20), std::vector<CanFrame>{kStop});
  hear(kFirst);  // still on its way
  EXPECT_EQ(sent(30), std::vector<CanFrame>{kRate});
  hear(kRateSet);
  hear({0x02, false, false, 8, {}});  // the other half of that
  EXPECT_EQ(sent(40), std::vector<CanFrame>{kStart});
  hear(kSecond);
  hear(kFirst);
  EXPECT_EQ(start.state(), SensorStart::State::kAsking);
  hear(kSecond);
  EXPECT_EQ(start.state(), SensorStart::State::kDone);
  EXPECT_TRUE(sent(1000).empty());
}

TEST_F(RobotousRftStarts, ASlowAnswerIsAskedForAgain) {
  (void)sent(20);
  EXPECT_EQ(sent(130), (std::vector<CanFrame>{kRate, kRate}));
  hear(kRateSet);
  EXPECT_EQ(sent(300), (std::vector<CanFrame>{kStart, kStart}));
  hear(kFirst);
  hear(kSecond);
  EXPECT_EQ(start.state(), SensorStart::State::kDone);
}

TEST_F(RobotousRftStarts, SilenceIsNamedWithinASecond) {
  const auto frames = sent(1000);
  EXPECT_EQ(frames, (std::vector<CanFrame>{kStop, kRate, kRate, kRate}));
  EXPECT_EQ(start.state(), SensorStart::State::kFailed);
  EXPECT_EQ(start.fault().kind, ArmFaultKind::kNoAnswer);
  EXPECT_EQ(
      describe(start.fault(), robot_with_rft()),
      "force/torque sensor robotous_rft: no answer to set rate (0Fh) on 0x001 in three tries, "
      "sent on 0x064; check power, wiring, that the bus runs at 1 Mbit/s, and that the sensor "
      "has these identifiers");
}

TEST_F(RobotousRftStarts, OneThatConfirmsAndThenStreamsNothingIsSilentToo) {
  (void)sent(21);
  hear(kRateSet);
  (void)sent(1000);
  EXPECT_EQ(start.fault().kind, ArmFaultKind::kNoAnswer);
  EXPECT_NE(describe(start.fault(), robot_with_rft()).find("no answer to start (0Bh)"),
            std::string::npos);
}

TEST_F(RobotousRftStarts, ARefusedRateIsAWrongConfiguration) {
  (void)sent(21);
  hear({0x01, false, false, 8, {0x0F, 0x00, 0x03}});
  EXPECT_EQ(start.fault().kind, ArmFaultKind::kConfiguration);
  EXPECT_EQ(
      describe(start.fault(), robot_with_rft()),
      "force/torque sensor robotous_rft: refused its rate of 200 Hz (0Fh, error code 3); take "
      "another rate_hz, and see its manual for the code");
  EXPECT_TRUE(sent(1000).empty());
}

TEST_F(RobotousRftStarts, GarbageIsNoAnswer) {
  (void)sent(21);
  for (unsigned i = 0; i < 256; ++i) {
    if (i == 0x0F) continue;
    hear({0x01, false, false, 8, {static_cast<std::uint8_t>(i), 0x01}});
  }
  hear({0x01, false, false, 7, {0x0F, 0x01}});
  hear({0x01, true, false, 8, {0x0F, 0x01}});
  hear({0x02, false, false, 8, {0x0F, 0x01}});
  (void)sent(1000);
  EXPECT_EQ(start.fault().kind, ArmFaultKind::kNoAnswer);
}

TEST_F(RobotousRftStarts, StartsOver) {
  (void)sent(1000);
  ASSERT_EQ(start.state(), SensorStart::State::kFailed);
  start.restart();
  EXPECT_EQ(sent(1010), std::vector<CanFrame>{kStop});
}

}  // namespace
}  // namespace tenon::hw

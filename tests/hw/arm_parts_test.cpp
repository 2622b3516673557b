// The parts of a CanopenArm, each by itself: what it hears, what it is, what it says.

#include <gtest/gtest.h>

#include <deque>
#include <vector>

#include "hw/arm/arm_intake.h"
#include "hw/arm/arm_output.h"
#include "hw/arm/arm_supervision.h"
#include "hw/arm/describe_fault.h"
#include "hw/arm/saturation_fault.h"
#include "hw/sensors/canopen_wrench_source.h"
#include "sim/cell/bus/virtual_bus.h"
#include "tests/hw/gantry_on_bus.h"
#include "tests/support/frame_filter.h"

namespace tenon::hw {
namespace {

constexpr std::int64_t kNow_ns = 1'000'000'000;
constexpr std::int64_t kMillisecond_ns = 1'000'000;

constexpr std::uint16_t kReady = 0x0231;
constexpr std::uint16_t kEnabled = 0x0237;
constexpr std::uint16_t kFaulty = 0x0218;

/// TPDO1 of joint i at position 0.
CanFrame feedback_frame(std::uint32_t i, std::uint16_t statusword) {
  return {
      0x190 + i,
      false,
      false,
      8,
      {static_cast<std::uint8_t>(statusword & 0xFF), static_cast<std::uint8_t>(statusword >> 8)}};
}

CanFrame wrench_half(std::uint32_t id, std::uint8_t counts, std::uint8_t counter) {
  return {id, false, false, 8, {counts, 0, 0, 0, 0, 0, counter, 0}};
}

/// Three joints (nodes 1, 2, 3) and a sensor (node 4), and nobody on the bus.
class ArmParts : public testing::Test {
 protected:
  void hear_all(std::uint16_t statusword) {
    for (std::uint32_t i = 0; i < 3; ++i) intake.take(feedback_frame(i, statusword), kNow_ns);
  }
  /// Frames that left, by identifier.
  std::vector<std::uint32_t> said() {
    std::vector<std::uint32_t> ids;
    for (ReceivedFrame received; listener.receive(received);) ids.push_back(received.frame.id);
    return ids;
  }

  const Robot robot = gantry_robot();
  sim::VirtualBus bus{{.bitrate_bps = 0}};
  CanBus& master = bus.attach();
  CanBus& listener = bus.attach();
  ArmCounters counters;
  std::vector<JointChannel> joints = [this] {
    std::vector<JointChannel> channels;
    for (const Joint& joint : robot.joints) channels.emplace_back(joint, robot.cycle_us);
    return channels;
  }();
  ArmSupervision supervision{robot, joints, counters};
  CanopenWrenchSource wrench_source{robot.sensor, {0x181, 0x182}};
  ArmIntake intake{robot, joints, wrench_source, supervision, counters};
  ArmOutput output{robot, master, joints, supervision, counters};
};

using ArmIntakeAlone = ArmParts;
using ArmSupervisionAlone = ArmParts;
using ArmOutputAlone = ArmParts;

TEST_F(ArmIntakeAlone, ACycleIsCompleteWithEveryJointAndBothHalvesOfTheWrench) {
  (void)intake.open_cycle(kNow_ns, master);
  hear_all(kReady);
  intake.take(wrench_half(0x181, 100, 1), kNow_ns);
  EXPECT_FALSE(intake.complete());
  EXPECT_FALSE(intake.feedback().wrench_fresh);
  intake.take(wrench_half(0x182, 100, 1), kNow_ns);
  EXPECT_TRUE(intake.complete());
  EXPECT_EQ(intake.feedback().joints_fresh, 0b111U);
  EXPECT_TRUE(intake.feedback().wrench_fresh);
  EXPECT_DOUBLE_EQ(intake.feedback().wrench[0], 1.0);
  EXPECT_DOUBLE_EQ(intake.feedback().wrench[3], 0.05);
  EXPECT_EQ(intake.feedback().sync_ns, kNow_ns);
}

TEST_F(ArmIntakeAlone, WhatComesAfterACycleIsLateAndAJointsIsNotTheNextOnes) {
  (void)intake.open_cycle(kNow_ns, master);
  EXPECT_TRUE(intake.close_cycle());
  EXPECT_FALSE(intake.close_cycle()) << "none is open any more";
  hear_all(kReady);
  EXPECT_EQ(counters.late_frames, 3U);
  ASSERT_EQ(listener.send(wrench_half(0x181, 1, 1)), SendResult::kSent);
  ASSERT_EQ(listener.send(wrench_half(0x182, 1, 1)), SendResult::kSent);
  (void)intake.open_cycle(kNow_ns,
                          master);  // takes both in: a wrench that came late is still the newest
  EXPECT_EQ(counters.late_frames, 5U);
  EXPECT_EQ(intake.feedback().joints_fresh, 0U);
  EXPECT_TRUE(intake.feedback().wrench_fresh);
}

TEST_F(ArmIntakeAlone, AForceAtTheEndOfItsRangeGoesToTheSupervisionWithItsFrame) {
  supervision.begin(kNow_ns);
  CanFrame force = wrench_half(0x181, 0, 7);
  force.data[2] = 0x30;  // y: 30000 counts, 300 N
  force.data[3] = 0x75;
  intake.take(force, kNow_ns);
  EXPECT_EQ(supervision.state(), ArmState::kFault);
  EXPECT_EQ(supervision.fault().kind, ArmFaultKind::kSensorInvalid);
  EXPECT_EQ(supervision.fault().node, 4);
  EXPECT_EQ(saturated_reading(supervision.fault()), 300.0);
}

TEST_F(ArmSupervisionAlone, ANodeThatIsSilentForLongerThanTheTimeoutIsNamed) {
  supervision.begin(kNow_ns);
  for (const std::uint8_t node : {std::uint8_t{1}, std::uint8_t{2}, std::uint8_t{4}}) {
    supervision.take_heartbeat({node, 0x05}, kNow_ns + 100 * kMillisecond_ns);
  }
  supervision.check_heartbeats(kNow_ns + 300 * kMillisecond_ns);
  EXPECT_EQ(supervision.fault().kind, ArmFaultKind::kNone);
  supervision.check_heartbeats(kNow_ns + 301 * kMillisecond_ns);
  EXPECT_EQ(supervision.fault().kind, ArmFaultKind::kHeartbeatLost);
  EXPECT_EQ(supervision.fault().node, 3);
}

TEST_F(ArmSupervisionAlone, TheFirstFaultStaysAndTheErrorCodeOfTheSameDriveSaysMore) {
  supervision.begin(kNow_ns);
  hear_all(kEnabled);
  supervision.advance(kNow_ns, ArmRequest::kEnabled);
  ASSERT_EQ(supervision.state(), ArmState::kEnabled);
  intake.take(feedback_frame(1, kFaulty), kNow_ns);
  supervision.advance(kNow_ns, ArmRequest::kEnabled);
  EXPECT_EQ(supervision.fault().object, 0x604100U);
  supervision.take_emergency({3, 0x2310, 0, {}});  // another drive's
  EXPECT_EQ(supervision.fault().node, 2);
  EXPECT_EQ(supervision.fault().code, kFaulty);
  supervision.take_emergency({2, 0x8611, 0, {}});
  EXPECT_EQ(supervision.fault().kind, ArmFaultKind::kDriveFault);
  EXPECT_EQ(supervision.fault().object, 0x603F00U);
  EXPECT_EQ(supervision.fault().code, 0x8611U);
  EXPECT_EQ(counters.emergencies, 2U);
}

TEST_F(ArmSupervisionAlone, FeedbackMayBeMissingFiveTimesInARowAndNotSix) {
  supervision.begin(kNow_ns);
  ArmFeedback feedback;
  feedback.wrench_fresh = true;
  const auto cycles = [&](std::uint32_t joints_fresh, int count) {
    feedback.joints_fresh = joints_fresh;
    for (int i = 0; i < count; ++i) supervision.check_feedback(feedback);
  };
  cycles(0b101, 5);
  cycles(0b111, 1);
  cycles(0b101, 5);
  EXPECT_EQ(supervision.state(), ArmState::kDisabled);
  cycles(0b101, 1);
  EXPECT_EQ(supervision.fault().kind, ArmFaultKind::kFeedbackMissing);
  EXPECT_EQ(supervision.fault().node, 2);
  EXPECT_EQ(counters.joint_frames_missing, 11U);
}

TEST_F(ArmSupervisionAlone, InAFaultDrivesAreStoppedOrDisabledAndNeverEnabled) {
  supervision.begin(kNow_ns);
  for (const ArmRequest request :
       {ArmRequest::kDisabled, ArmRequest::kEnabled, ArmRequest::kQuickStop}) {
    EXPECT_EQ(supervision.granted(request), request);
  }
  supervision.raise({ArmFaultKind::kBusDown, 0, 0, 0});
  EXPECT_EQ(supervision.granted(ArmRequest::kDisabled), ArmRequest::kDisabled);
  EXPECT_EQ(supervision.granted(ArmRequest::kEnabled), ArmRequest::kQuickStop);
  EXPECT_EQ(supervision.granted(ArmRequest::kQuickStop), ArmRequest::kQuickStop);
  supervision.reset();
  EXPECT_EQ(supervision.state(), ArmState::kUnconfigured);
  EXPECT_EQ(supervision.fault().kind, ArmFaultKind::kNone);
}

TEST_F(ArmOutputAlone, AJointThatWasNotHeardOfIsSentNothing) {
  intake.take(feedback_frame(1, kReady), kNow_ns);
  output.send_setpoints(ArmRequest::kEnabled, false, {});
  EXPECT_EQ(said(), (std::vector<std::uint32_t>{0x202}));
}

TEST_F(ArmOutputAlone, HeartbeatsLeaveWhenDueAndAreNotMadeUpFor) {
  output.begin(kNow_ns);
  std::vector<std::int64_t> left_ms;
  for (const std::int64_t time_ms : {0, 99, 100, 150, 199, 200, 550, 551, 649, 650}) {
    output.send_heartbeat(kNow_ns + time_ms * kMillisecond_ns);
    if (!said().empty()) left_ms.push_back(time_ms);
  }
  EXPECT_EQ(left_ms, (std::vector<std::int64_t>{0, 100, 200, 550, 650}));
}

/// A transmit queue that refuses what a node is to do.
class RefusesSetpoints final : public sim::Disturbance {
 public:
  [[nodiscard]] SendResult admit(const CanFrame& frame, std::int64_t /*now_ns*/) noexcept override {
    return frame.id == refused_id ? SendResult::kQueueFull : SendResult::kSent;
  }
  std::uint32_t refused_id = 0;
};

// Never three cycles in a row: the queue as a whole is not what is wrong.
TEST_F(ArmOutputAlone, ASetpointThatNeverLeavesAgainAndAgainIsNamedByItsNode) {
  RefusesSetpoints refuses;
  bus.set_disturbance(&refuses);
  hear_all(kEnabled);
  supervision.begin(kNow_ns);
  int refused = 0;
  for (int cycle = 0; supervision.state() != ArmState::kFault && cycle < 100; ++cycle) {
    refuses.refused_id = cycle % 2 == 0 ? 0x202 : 0;
    refused += cycle % 2 == 0 ? 1 : 0;
    output.send_setpoints(ArmRequest::kDisabled, false, {});
    supervision.check_sending(master.status());
  }
  EXPECT_EQ(supervision.fault().kind, ArmFaultKind::kSetpointUnsent);
  EXPECT_EQ(supervision.fault().node, 2);
  EXPECT_EQ(refused, 6);
}

TEST_F(ArmOutputAlone, OneSetpointInAHundredMayStayBehindForEver) {
  RefusesSetpoints refuses;
  bus.set_disturbance(&refuses);
  hear_all(kEnabled);
  supervision.begin(kNow_ns);
  for (int cycle = 0; cycle < 10'000; ++cycle) {
    refuses.refused_id = cycle % 101 == 0 ? 0x202 : 0;
    output.send_setpoints(ArmRequest::kDisabled, false, {});
    supervision.check_sending(master.status());
    ASSERT_NE(supervision.state(), ArmState::kFault) << cycle;
  }
}

// An adapter that reads too slowly: what it took it dropped.
TEST_F(ArmSupervisionAlone, FramesThatATransportDropsLaterCountAsRefused) {
  supervision.begin(kNow_ns);
  CanBusStatus status;
  supervision.check_sending(status);
  for (int cycle = 0; cycle < 3; ++cycle) {
    EXPECT_NE(supervision.state(), ArmState::kFault);
    status.send_failures += 4;
    supervision.check_sending(status);
  }
  EXPECT_EQ(supervision.fault().kind, ArmFaultKind::kQueueFull);
}

TEST_F(ArmOutputAlone, ABusThatIsGoneIsAFaultAtOnce) {
  supervision.begin(kNow_ns);
  bus.set_up(false);
  output.send_sync();
  EXPECT_EQ(counters.send_failures, 1U);
  EXPECT_EQ(supervision.state(), ArmState::kFault);
  EXPECT_EQ(supervision.fault().kind, ArmFaultKind::kBusDown);
}

TEST_F(ArmOutputAlone, ControllerThatIsBusOffIsNamedRatherThanTheBusThatIsDownForIt) {
  supervision.bus_lost({.up = false, .bus_off = true});
  EXPECT_EQ(supervision.fault().kind, ArmFaultKind::kBusOff);
}

// Every answer of the sensor is kept back for three cycles: none is missing after the first three.
TEST(CanopenArm, WrenchesThatAreLateByWholeCyclesAreNamed) {
  GantryOnBus gantry;
  ASSERT_TRUE(gantry.prepare_and_enable());
  for (int i = 0; i < 250; ++i) EXPECT_TRUE(gantry.cycle(ArmRequest::kEnabled));
  std::deque<CanFrame> kept;
  const tests::FrameFilter filter(gantry.bus, [&](CanFrame& frame, std::size_t) {
    if (frame.id != 0x181 && frame.id != 0x182) return true;
    kept.push_back(frame);
    if (kept.size() <= 6) return false;
    frame = kept.front();
    kept.pop_front();
    return true;
  });
  int cycles = 0;
  while (gantry.arm.state() == ArmState::kEnabled && cycles < 100) {
    gantry.cycle(ArmRequest::kEnabled);
    ++cycles;
  }
  EXPECT_EQ(cycles, 6);
  EXPECT_EQ(gantry.arm.fault().kind, ArmFaultKind::kSensorStale);
  EXPECT_EQ(describe(gantry.arm.fault(), gantry.robot),
            "node 4 (force/torque sensor): its samples are 3 SYNCs old by their counter (2001h), "
            "and have been so, or missing, for more than 5 samples; check what else is on its bus, "
            "the adapter, and "
            "whether the sensor hears every SYNC");
}

}  // namespace
}  // namespace tenon::hw

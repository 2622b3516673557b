// A force beyond its limit: one frame stops all drives, in the cycle or between two, and nothing
// enables them again; how long that takes on the bus.

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <cstdio>
#include <optional>
#include <string>
#include <vector>

#include "hw/arm/arm_intake.h"
#include "hw/arm/arm_output.h"
#include "hw/arm/arm_supervision.h"
#include "hw/sensors/canopen_wrench_source.h"
#include "shared/base/random.h"
#include "shared/config/load.h"
#include "sim/cell/bus/virtual_bus.h"
#include "tests/hw/gantry_on_bus.h"
#include "tests/support/places.h"

namespace tenon::hw {
namespace {

constexpr std::uint32_t kForceId = 0x181;
constexpr std::uint32_t kStopId = 0x183;

std::vector<JointChannel> channels_of(const Robot& robot) {
  std::vector<JointChannel> channels;
  for (const Joint& joint : robot.joints) channels.emplace_back(joint, robot.cycle_us);
  return channels;
}

/// The parts of an arm.
struct Parts {
  Parts(const Robot& of, CanBus& bus) : robot(of), master(bus), joints(channels_of(robot)) {}

  void hear_all(std::uint8_t statusword_low) {
    for (std::uint32_t i = 0; i < joints.size(); ++i) {
      intake.take({0x190 + i, false, false, 8, {statusword_low, 0x02}}, 0);
    }
  }
  void enable(std::int64_t now_ns) {
    supervision.reset();
    intake.reset();
    hear_all(0x37);
    supervision.begin(now_ns);
    supervision.advance(now_ns, ArmRequest::kEnabled);
  }

  const Robot robot;
  CanBus& master;
  ArmCounters counters;
  std::vector<JointChannel> joints;
  ArmSupervision supervision{robot, joints, counters};
  CanopenWrenchSource wrench_source{robot.sensor, {0x181, 0x182}};
  ArmIntake intake{robot, joints, wrench_source, supervision, counters};
  ArmOutput output{robot, master, joints, supervision, counters};
};

// --- what is decided -----------------------------------------------------------------------------

/// Force x of 0.01 N a count.
CanFrame force_frame(std::uint8_t counts) {
  return {kForceId, false, false, 8, {counts, 0, 0, 0, 0, 0, 1, 0}};
}

class ForceStop : public testing::Test {
 protected:
  ForceStop() {
    parts_.enable(0);
    intake.limit_force({Vector3(0.2, 0.0, 0.0), 0.5});
  }
  void hear_all(std::uint8_t statusword_low) { parts_.hear_all(statusword_low); }

 private:
  sim::VirtualBus bus_{{.bitrate_bps = 0}};
  Parts parts_{gantry_robot(), bus_.attach()};

 protected:
  ArmSupervision& supervision = parts_.supervision;
  ArmIntake& intake = parts_.intake;
};

TEST_F(ForceStop, TheForceIsJudgedInItsFrameAgainstWhatTheSensorReadsOfItself) {
  ASSERT_EQ(supervision.state(), ArmState::kEnabled);
  intake.take(force_frame(69), 0);
  EXPECT_FALSE(supervision.take_stop()) << "0.49 N beyond the 0.2 N";
  intake.take(force_frame(71), 0);
  EXPECT_TRUE(supervision.take_stop());
  EXPECT_FALSE(supervision.take_stop()) << "once";
  EXPECT_NEAR(supervision.force_stopped_N(), 0.51, 1e-9);
}

TEST_F(ForceStop, NothingEnablesTheDrivesBeforeAllAreOff) {
  intake.take(force_frame(100), 0);
  supervision.advance(0, ArmRequest::kEnabled);
  EXPECT_EQ(supervision.granted(ArmRequest::kEnabled), ArmRequest::kQuickStop);
  EXPECT_EQ(supervision.state(), ArmState::kStopping);
  hear_all(0x17);  // quick stop active
  supervision.advance(0, ArmRequest::kEnabled);
  EXPECT_EQ(supervision.state(), ArmState::kStopping) << "and no fault of a drive";
  hear_all(0x50);  // switch on disabled
  supervision.advance(0, ArmRequest::kEnabled);
  EXPECT_EQ(supervision.granted(ArmRequest::kEnabled), ArmRequest::kQuickStop);
  supervision.advance(0, ArmRequest::kDisabled);
  EXPECT_EQ(supervision.state(), ArmState::kDisabled);
  EXPECT_EQ(supervision.granted(ArmRequest::kEnabled), ArmRequest::kEnabled);
}

TEST_F(ForceStop, ADriveThatIsOffIsNotStopped) {
  hear_all(0x50);
  supervision.advance(0, ArmRequest::kDisabled);
  intake.take(force_frame(100), 0);
  EXPECT_FALSE(supervision.take_stop());
}

// --- on the bus
// -----------------------------------------------------------------------------------

// Setpoints that have left act with the next SYNC. Between two cycles they are overwritten.
TEST(ForceStopOnTheBus, BetweenTwoCyclesTheStopLeavesAtOnceAndSetpointsAreOverwritten) {
  GantryOnBus gantry;
  ASSERT_TRUE(gantry.prepare_and_enable());
  gantry.arm.limit_force({Vector3::Zero(), 1.0});
  gantry.cycle(ArmRequest::kEnabled, {0.25, 0.0, 0.0});
  for (const auto& node : gantry.nodes) node->commands.clear();
  CanBus& listener = gantry.bus.attach();
  gantry.nodes[3]->send(kForceId, {200, 0, 0, 0, 0, 0, 9, 0});
  EXPECT_TRUE(gantry.arm.attend(gantry.now_ns));
  std::vector<std::uint32_t> ids;
  for (ReceivedFrame received; listener.receive(received);) {
    ids.push_back(received.frame.id);
    if (received.frame.id != kForceId) {
      EXPECT_EQ(received.frame.data[0], 0x02);
    }
  }
  EXPECT_EQ(ids, (std::vector<std::uint32_t>{kForceId, kStopId, 0x201, 0x202, 0x203}));
  EXPECT_FALSE(gantry.arm.attend(gantry.now_ns));
}

// The same where it is heard as the next cycle opens: SYNC comes last.
TEST(ForceStopOnTheBus, AsACycleOpensSetpointsAreOverwrittenBeforeItsSync) {
  GantryOnBus gantry;
  ASSERT_TRUE(gantry.prepare_and_enable());
  gantry.arm.limit_force({Vector3::Zero(), 1.0});
  gantry.cycle(ArmRequest::kEnabled, {0.25, 0.0, 0.0});
  CanBus& listener = gantry.bus.attach();
  gantry.nodes[3]->send(kForceId, {200, 0, 0, 0, 0, 0, 9, 0});
  gantry.arm.start_cycle(gantry.now_ns);
  std::vector<std::uint32_t> ids;
  for (ReceivedFrame received; listener.receive(received);) ids.push_back(received.frame.id);
  EXPECT_EQ(ids, (std::vector<std::uint32_t>{kForceId, kStopId, 0x201, 0x202, 0x203, 0x080}));
}

// Taken in between two cycles it is the newest all the same.
TEST(ForceStopOnTheBus, AWrenchThatIsHeardBetweenTwoCyclesIsTheNextOnesNewest) {
  GantryOnBus gantry;
  ASSERT_TRUE(gantry.prepare_and_enable());
  gantry.nodes[3]->send(kForceId, {7, 0, 0, 0, 0, 0, 0x39, 0x30});
  gantry.nodes[3]->send(0x182, {0, 0, 0, 0, 0, 0, 0x39, 0x30});
  EXPECT_TRUE(gantry.arm.attend(gantry.now_ns));
  gantry.arm.start_cycle(gantry.now_ns);
  (void)gantry.arm.receive(gantry.now_ns, gantry.feedback);
  EXPECT_TRUE(gantry.feedback.wrench_fresh);
  EXPECT_EQ(gantry.feedback.wrench_counter, 0x3039);
}

// --- how long it takes
// ----------------------------------------------------------------------------

/// Of all payloads tried, the one that takes most bits with this identifier: runs of four and five
/// equal bits, shifted, and 20,000 at random.
CanFrame longest(std::uint32_t id, Random& random) {
  CanFrame best{id, false, false, 8, {}};
  CanFrame tried = best;
  const auto keep = [&] {
    if (sim::classic_frame_bits(tried).nominal > sim::classic_frame_bits(best).nominal)
      best = tried;
  };
  for (const unsigned pattern : {0x0F0FU, 0x1E1EU, 0x3C3CU, 0x7878U, 0xF0F0U, 0x07C1U, 0x0F83U}) {
    for (std::uint8_t last = 0; last < 255; ++last) {
      for (std::size_t i = 0; i < 8; ++i) {
        tried.data[i] = static_cast<std::uint8_t>(pattern >> 8 * (i % 2));
      }
      tried.data[7] = last;
      keep();
    }
  }
  for (int i = 0; i < 20'000; ++i) {
    for (std::uint8_t& byte : tried.data)
      byte = static_cast<std::uint8_t>(256.0 * random.uniform());
    keep();
  }
  return best;
}

/// What the devices answer, all of it at its longest.
std::vector<CanFrame> longest_answers(const Robot& robot, Random& random) {
  std::vector<CanFrame> frames = {longest(kForceId, random), longest(0x182, random)};
  for (std::uint32_t i = 0; i < robot.joints.size(); ++i) {
    frames.push_back(longest(0x190 + i, random));
  }
  return frames;
}

// The sensor's torque, which wins the bus against the stop, and one frame more that is in flight
// when the master comes to answer:
//
//   181h ▇▇▇▇|182h ▇▇▇▇ 190h ▇▇▇▇ 183h ▇▇|
//            ^ end of the force           ^ end of the stop
std::int64_t longest_way_ns(const std::string& name) {
  const Robot robot = load_robot(tests::in_tree("hw/robots/" + name + "/robot.yaml"));
  sim::VirtualBus bus{{.bitrate_bps = robot.bitrate_bps}};
  CanBus& master = bus.attach();
  CanBus& devices = bus.attach({.order = sim::VirtualBus::Order::kByIdentifier});
  std::optional<std::int64_t> force_ns;
  std::optional<std::int64_t> stop_ns;
  bus.set_observer([&](const sim::VirtualBus::Transmission& sent) {
    if (sent.frame.id == kForceId) force_ns = sent.end_ns;
    if (sent.frame.id == kStopId) stop_ns = sent.end_ns;
  });
  Parts arm(robot, master);
  Random random(1);
  const std::vector<CanFrame> answers = longest_answers(robot, random);
  const std::int64_t torque_ns = 1000 * sim::classic_frame_bits(answers[1]).nominal;
  std::int64_t most_ns = 0;
  for (int stop = 0; stop < 100'000; ++stop) {
    arm.enable(bus.now_ns());
    arm.intake.limit_force({Vector3::Zero(), 0.0});
    force_ns.reset();
    stop_ns.reset();
    for (const CanFrame& frame : answers) (void)devices.send(frame);
    while (!force_ns) bus.advance(bus.next_event_ns());
    // The master answers at once, or as the next frame has just begun.
    const std::int64_t latest_ns = torque_ns + 2 * sim::kIntermissionBits * 1000 + 1000;
    bus.advance(*force_ns +
                static_cast<std::int64_t>(static_cast<double>(latest_ns) * random.uniform()));
    (void)arm.intake.drain(bus.now_ns(), master);
    if (arm.supervision.take_stop()) arm.output.send_stop();
    bus.advance(bus.now_ns() + std::int64_t{1000} * robot.cycle_us);
    for (ReceivedFrame received; devices.receive(received) || master.receive(received);) {
    }
    if (!stop_ns) return -1;
    most_ns = std::max(most_ns, *stop_ns - *force_ns);
  }
  return most_ns;
}

TEST(ForceStopOnTheBus, FromTheEndOfTheForceToTheEndOfTheStopIsAtMost350Microseconds) {
  for (const char* robot : {"gantry3", "csp6"}) {
    const std::int64_t most_ns = longest_way_ns(robot);
    std::printf("%s: 100000 stops, at most %.0f us from the end of the force's frame\n", robot,
                1e-3 * static_cast<double>(most_ns));
    EXPECT_GT(most_ns, 0) << "the stop never left";
    EXPECT_LE(most_ns, 350'000);
  }
}

}  // namespace
}  // namespace tenon::hw

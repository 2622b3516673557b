// Two buses as one port, how a command line names them, what goes where on them and what they take
// of a cycle.

#include <gtest/gtest.h>

#include <string>
#include <utility>
#include <vector>

#include "hw/arm/arm_bus.h"
#include "hw/bus_load/bus_load.h"
#include "hw/bus_load/response_times.h"
#include "hw/can/open_bus.h"
#include "hw/can/slcan_server.h"
#include "hw/check/device_check.h"
#include "shared/bus/bus_pair.h"
#include "shared/config/load.h"
#include "tests/hw/gantry_on_bus.h"
#include "tests/support/places.h"
#include "tests/support/refusal.h"

namespace tenon::hw {
namespace {

using tests::refusal;

CanFrame frame_of(std::uint32_t id, std::uint8_t bus = kArmBus) {
  CanFrame frame{id, false, false, 2, {0x01, 0x02}};
  frame.bus = bus;
  return frame;
}

std::vector<std::pair<int, std::uint32_t>> heard(CanBus& bus) {
  std::vector<std::pair<int, std::uint32_t>> all;
  for (ReceivedFrame received; bus.receive(received);) {
    all.emplace_back(received.frame.bus, received.frame.id);
  }
  return all;
}

using Heard = std::vector<std::pair<int, std::uint32_t>>;

/// Two virtual buses with an end each for us and for the devices.
struct Wires {
  explicit Wires(std::uint32_t bitrate_bps = 0)
      : arm({.bitrate_bps = bitrate_bps}), sensor({.bitrate_bps = bitrate_bps}) {}
  sim::VirtualBus arm;
  sim::VirtualBus sensor;
  CanBus& arm_device = arm.attach();
  CanBus& sensor_device = sensor.attach();
  BusPair pair{arm.attach(), sensor.attach()};
};

TEST(BusPair, AFrameLeavesByTheBusItNamesAndNamesTheOneItCameBy) {
  Wires wires;
  EXPECT_EQ(wires.pair.send(frame_of(0x201)), SendResult::kSent);
  EXPECT_EQ(wires.pair.send(frame_of(0x064, kSensorBus)), SendResult::kSent);
  EXPECT_EQ(heard(wires.arm_device), (Heard{{0, 0x201}}));
  // An end of one bus knows of no other.
  ReceivedFrame received;
  ASSERT_TRUE(wires.sensor_device.receive(received));
  EXPECT_EQ(received.frame.id, 0x064U);

  EXPECT_EQ(wires.sensor_device.send(frame_of(0x191)), SendResult::kSent);
  EXPECT_EQ(wires.arm_device.send(frame_of(0x191)), SendResult::kSent);
  EXPECT_EQ(heard(wires.pair), (Heard{{0, 0x191}, {1, 0x191}}));
}

TEST(BusPair, WhatCameFirstIsReadFirstWhicheverBusItCameBy) {
  Wires wires(1'000'000);
  EXPECT_EQ(wires.sensor_device.send(frame_of(1)), SendResult::kSent);
  wires.sensor.advance(10'000'000);
  wires.arm.advance(10'000'000);
  EXPECT_EQ(wires.arm_device.send(frame_of(2)), SendResult::kSent);
  wires.arm.advance(20'000'000);
  wires.sensor.advance(20'000'000);
  EXPECT_EQ(wires.sensor_device.send(frame_of(3)), SendResult::kSent);
  wires.sensor.advance(30'000'000);
  EXPECT_EQ(heard(wires.pair), (Heard{{1, 1}, {0, 2}, {1, 3}}));
}

TEST(BusPair, IsUpWhereBothAreAndSaysWhichIsNot) {
  Wires wires;
  EXPECT_TRUE(wires.pair.status().up);
  wires.sensor.set_up(false);
  EXPECT_FALSE(wires.pair.status().up);
  EXPECT_EQ(wires.pair.status().failed_bus, kSensorBus);
  EXPECT_EQ(wires.pair.send(frame_of(1, kSensorBus)), SendResult::kDown);
  EXPECT_EQ(wires.pair.send(frame_of(1)), SendResult::kSent);
  wires.sensor.set_up(true);
  wires.arm.set_up(false);
  EXPECT_EQ(wires.pair.status().failed_bus, kArmBus);
  // A controller that has left its bus says more than one that is down.
  wires.sensor.set_bus_off(1, true);
  EXPECT_TRUE(wires.pair.status().bus_off);
  EXPECT_EQ(wires.pair.status().failed_bus, kSensorBus);
}

TEST(TwoBuses, AreNamedOnTheCommandLineInEitherOrder) {
  const BusUris one = parse_bus_uris("socketcan:can0");
  EXPECT_EQ(one.arm, "socketcan:can0");
  EXPECT_EQ(one.sensor, "");
  for (const char* text : {"arm=socketcan:can0,sensor=slcan:/dev/ttyACM0",
                           "sensor=slcan:/dev/ttyACM0,arm=socketcan:can0"}) {
    const BusUris two = parse_bus_uris(text);
    EXPECT_EQ(two.arm, "socketcan:can0");
    EXPECT_EQ(two.sensor, "slcan:/dev/ttyACM0");
  }
  for (const std::string text :
       {"arm=socketcan:can0", "sensor=socketcan:can0", "arm=a:,arm=b:", "arm=,sensor=",
        "arm=socketcan:can0,socketcan:can1", "arm=socketcan:can0,"}) {
    EXPECT_EQ(refusal([&] { (void)parse_bus_uris(text); }),
              "--can '" + text +
                  "': two buses are named as arm=URI,sensor=URI, such as "
                  "arm=socketcan:can0,sensor=socketcan:can1");
  }
  EXPECT_EQ(refusal([] { (void)parse_bus_uris("arm=socketcan:can0,sensor=socketcan:can0"); }),
            "--can 'arm=socketcan:can0,sensor=socketcan:can0': names one bus twice; where the "
            "sensor is on the arm's, name it once");
}

TEST(TwoBuses, ARobotWhoseSensorHasOneOfItsOwnMustBeGivenBoth) {
  Robot robot = gantry_robot();
  settle_buses({"socketcan:can0", ""}, robot);
  EXPECT_FALSE(robot.sensor.has_own_bus());
  settle_buses({"socketcan:can0", "socketcan:can1"}, robot);
  EXPECT_EQ(robot.sensor.own_bitrate_bps, robot.bitrate_bps);
  robot.sensor.own_bitrate_bps = 250'000;
  settle_buses({"socketcan:can0", "socketcan:can1"}, robot);
  EXPECT_EQ(robot.sensor.own_bitrate_bps, 250'000U) << "its file's word goes first";
  EXPECT_EQ(refusal([&] {
              settle_buses({"socketcan:can0", ""}, robot);
            }),
            "--can 'socketcan:can0': the force/torque sensor of robot 'gantry' has a bus of its "
            "own; name both, as arm=socketcan:can0,sensor=socketcan:can1");
}

TEST(TwoBuses, EitherWakesWhoWaitsForBoth) {
  Robot robot = gantry_robot();
  robot.sensor.own_bitrate_bps = 1'000'000;
  Buses servers({"slcan-listen://127.0.0.1:0", "slcan-listen://127.0.0.1:0"}, robot);
  const auto uri = [](const CanBus& bus) {
    return "slcan://127.0.0.1:" + std::to_string(listening_port(bus));
  };
  Buses clients({uri(servers.arm()), uri(*servers.sensor())}, robot);
  // Each waits far longer than the test may take, were it not woken.
  constexpr std::int64_t kLong_ns = 60'000'000'000;
  for (const std::uint8_t bus : {kArmBus, kSensorBus, kArmBus}) {
    ASSERT_EQ(clients.all().send(frame_of(0x100U + bus, bus)), SendResult::kSent);
    clients.all().flush();
    Heard at_server;
    while (at_server.empty()) {
      servers.all().wait(kLong_ns);
      at_server = heard(servers.all());
    }
    EXPECT_EQ(at_server, (Heard{{bus, 0x100U + bus}}));
    ASSERT_EQ(servers.all().send(frame_of(0x180U + bus, bus)), SendResult::kSent);
    servers.all().flush();
    Heard at_client;
    while (at_client.empty()) {
      clients.all().wait(kLong_ns);
      at_client = heard(clients.all());
    }
    EXPECT_EQ(at_client, (Heard{{bus, 0x180U + bus}}));
  }
}

// --- what goes where -----------------------------------------------------------------------------

struct ApartBench {
  explicit ApartBench(const Robot& wanted) : robot(apart(wanted)) {}
  static Robot apart(Robot robot) {
    robot.sensor.own_bitrate_bps = 1'000'000;
    return robot;
  }
  const Robot robot;
  Wires wires;
  ArmCounters counters;
  ArmBus bus{robot, wires.pair, counters};

  /// The buses that a frame leaves by: "arm", "sensor", "both".
  std::string way(const CanFrame& frame) {
    EXPECT_EQ(bus.send(frame), SendResult::kSent);
    const bool arm = !heard(wires.arm_device).empty();
    const bool sensor = !heard(wires.sensor_device).empty();
    return arm && sensor ? "both" : arm ? "arm" : sensor ? "sensor" : "nowhere";
  }
};

CanFrame nmt_to(std::uint8_t node) { return {0x000, false, false, 2, {0x01, node}}; }

TEST(ArmBus, ACanopenSensorGetsItsOwnAndWhatIsForAll) {
  ApartBench bench(gantry_robot());
  const std::uint32_t node = bench.robot.sensor.node;
  EXPECT_EQ(bench.way(frame_of(0x080)), "both");
  EXPECT_EQ(bench.way(frame_of(0x700U + bench.robot.master_node)), "both");
  EXPECT_EQ(bench.way(nmt_to(0)), "both");
  EXPECT_EQ(bench.way(nmt_to(static_cast<std::uint8_t>(node))), "sensor");
  EXPECT_EQ(bench.way(nmt_to(1)), "arm");
  EXPECT_EQ(bench.way(frame_of(0x600 + node)), "sensor");
  EXPECT_EQ(bench.way(frame_of(0x601)), "arm");
  EXPECT_EQ(bench.way(frame_of(0x201)), "arm");
}

TEST(ArmBus, AFrameOfTheOtherBusIsNobodysAnswer) {
  ApartBench bench(gantry_robot());
  const std::uint32_t node = bench.robot.sensor.node;
  for (const std::uint32_t id : {0x181U, 0x080 + node, 0x580 + node, 0x700 + node}) {
    EXPECT_EQ(bench.wires.sensor_device.send(frame_of(id)), SendResult::kSent);
    EXPECT_EQ(heard(bench.bus), (Heard{{1, id}})) << id;
    EXPECT_EQ(bench.wires.arm_device.send(frame_of(id)), SendResult::kSent);
    EXPECT_EQ(heard(bench.bus), Heard{}) << id;
  }
  EXPECT_EQ(bench.counters.unexpected_frames, 4U);
  for (const std::uint32_t id : {0x190U, 0x701U, 0x581U, 0x081U}) {
    EXPECT_EQ(bench.wires.sensor_device.send(frame_of(id)), SendResult::kSent);
    EXPECT_EQ(heard(bench.bus), Heard{}) << id;
    EXPECT_EQ(bench.wires.arm_device.send(frame_of(id)), SendResult::kSent);
    EXPECT_EQ(heard(bench.bus), (Heard{{0, id}})) << id;
  }
  EXPECT_EQ(bench.counters.unexpected_frames, 8U);
  // Another master on the sensor's bus is one, too.
  EXPECT_EQ(bench.wires.sensor_device.send(frame_of(0x080)), SendResult::kSent);
  EXPECT_EQ(heard(bench.bus), (Heard{{1, 0x080}}));
}

TEST(ArmBus, ASensorThatIsNoNodeIsLeftAloneByCanopen) {
  ApartBench bench(load_cell(tests::in_tree("tests/plans/ati_gantry3/cell.yaml")).robot);
  EXPECT_EQ(bench.way(frame_of(0x080)), "arm");
  EXPECT_EQ(bench.way(frame_of(0x77F)), "arm");
  EXPECT_EQ(bench.way(frame_of(bench.robot.sensor.request_id, kSensorBus)), "sensor");
}

// --- what they take of a cycle -------------------------------------------------------------------

TEST(TwoBuses, EachHasItsLoadAndItsQueue) {
  const Robot together = gantry_robot();
  Robot apart = together;
  apart.sensor.own_bitrate_bps = 250'000;
  const std::uint32_t all = bus_load(together).frames_per_cycle;
  // The wrench has gone, SYNC is on both.
  EXPECT_EQ(bus_load(apart, kArmBus).frames_per_cycle, all - 2);
  EXPECT_EQ(bus_load(apart, kSensorBus).frames_per_cycle, 3U);
  EXPECT_EQ(bus_load(apart, kSensorBus).nominal_bits, 47U + 2 * 111U);
  EXPECT_DOUBLE_EQ(bus_load(apart, kSensorBus).nominal,
                   (47.0 + 2 * 111.0) / (250e3 * 1e-6 * apart.cycle_us));
  EXPECT_EQ(master_frames(apart, kSensorBus), 2U) << "SYNC and the heartbeat";
  EXPECT_DOUBLE_EQ(response_times(apart, kSensorBus).feedback_nominal_us, 4 * (47.0 + 2 * 111.0));
  const std::string text = check_report(apart, {}).text;
  EXPECT_NE(text.find("the arm's bus: "), std::string::npos) << text;
  EXPECT_NE(text.find("the sensor's bus: 3 frames every"), std::string::npos) << text;
}

TEST(TwoBuses, OneThatIsTooSlowForTheSensorIsRefusedByItsName) {
  Robot robot = gantry_robot();
  robot.sensor.own_bitrate_bps = 125'000;
  const std::string line = refusal([&] { check_bus_load(robot); });
  EXPECT_NE(line.find("robot 'gantry': the sensor's bus: 3 frames every"), std::string::npos)
      << line;
}

TEST(TwoBuses, IdentifiersMayMeetWhereBusesDoNot) {
  Robot robot = load_cell(tests::in_tree("tests/plans/ati_gantry3/cell.yaml")).robot;
  robot.sensor.request_id = 0x190;
  robot.sensor.sample_ids = {0x190, 0x191};
  EXPECT_NE(refusal([&] { (void)check_report(robot, {}); }).find("is given to both"),
            std::string::npos);
  robot.sensor.own_bitrate_bps = 500'000;
  EXPECT_NO_THROW((void)check_report(robot, {}));
}

}  // namespace
}  // namespace tenon::hw

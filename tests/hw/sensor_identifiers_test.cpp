// Identifiers of a sensor that is no CANopen node against everybody else's on its bus: refused when
// the arm is made and by tenon-can check, with both owners named.

#include <gtest/gtest.h>

#include <string>

#include "hw/arm/canopen_arm.h"
#include "hw/arm/describe_fault.h"
#include "hw/arm/identifiers.h"
#include "hw/arm/other_master.h"
#include "hw/check/device_check.h"
#include "hw/mit/mit_arm.h"
#include "shared/config/load.h"
#include "tests/hw/gantry_on_bus.h"
#include "tests/support/places.h"
#include "tests/support/refusal.h"

namespace tenon::hw {
namespace {

using tests::refusal;

Robot gantry_with_rft(std::uint32_t command, std::uint32_t first, std::uint32_t second) {
  Robot robot = gantry_robot();
  robot.sensor.protocol = SensorProtocol::kRobotousRft;
  robot.sensor.profile = "robotous_rft";
  robot.sensor.node = 0;
  robot.sensor.request_id = command;
  robot.sensor.sample_ids = {first, second};
  robot.sensor.rate_hz = 200;
  robot.sensor.cycles_per_sample = 3;
  return robot;
}

TEST(SensorIdentifiers, AsSoldTheyMeetNobodyOnAGantry) {
  const Robot robot = gantry_with_rft(0x64, 1, 2);
  sim::VirtualBus bus{{.bitrate_bps = 0}};
  EXPECT_NO_THROW(CanopenArm(robot, bus.attach()));
  const std::string text = check_report(robot, {}).text;
  EXPECT_NE(text.find("force/torque sensor robotous_rft: stopped (0Ch), set to 200 Hz (0Fh), "
                      "started (0Bh) on 0x064; answers on 0x001 and 0x002\n"),
            std::string::npos)
      << text;
}

TEST(SensorIdentifiers, EachThatSomebodyHasIsRefusedWithBoth) {
  const std::string of = " of the force/torque sensor robotous_rft and ";
  const auto refused = [](std::uint32_t command, std::uint32_t first, std::uint32_t second) {
    const Robot robot = gantry_with_rft(command, first, second);
    sim::VirtualBus bus{{.bitrate_bps = 0}};
    const std::string at_start = refusal([&] { CanopenArm(robot, bus.attach()); });
    EXPECT_EQ(refusal([&] { (void)check_report(robot, {}); }), at_start);
    return at_start;
  };
  EXPECT_EQ(refused(0x64, 0x191, 2),
            "robot 'gantry': identifier 0x191 is given to both the first "
            "frame" +
                of + "feedback of y (node 2); give one of them another");
  EXPECT_NE(refused(0x64, 1, 0x203)
                .find("0x203 is given to both the second frame" + of + "command of z (node 3)"),
            std::string::npos);
  EXPECT_NE(refused(0x080, 1, 2).find("0x080 is given to both the commands" + of + "SYNC"),
            std::string::npos);
  EXPECT_NE(refused(0x77F, 1, 2).find("the master's heartbeat"), std::string::npos);
  EXPECT_NE(refused(0x183, 1, 2).find("the stop of all drives"), std::string::npos);
  EXPECT_NE(refused(0x081, 1, 2).find("EMCY of x"), std::string::npos);
  EXPECT_NE(refused(0x582, 1, 2).find("SDO answer of y"), std::string::npos);
  EXPECT_NE(refused(0x602, 1, 2).find("SDO request of y"), std::string::npos);
  EXPECT_NE(refused(0x703, 1, 2).find("heartbeat of z"), std::string::npos);
}

TEST(SensorIdentifiers, AsSoldTheyAreThoseOfMotorsOneAndTwo) {
  Cell cell = load_cell(tests::in_tree("hw/cells/mit6.yaml"));
  cell.robot.sensor = gantry_with_rft(0x64, 1, 2).sensor;
  sim::VirtualBus bus{{.bitrate_bps = 0}};
  EXPECT_EQ(refusal([&] { mit::MitArm(cell, bus.attach()); }),
            "robot 'mit6': identifier 0x001 is given to both the first frame of the force/torque "
            "sensor robotous_rft and the motor of " +
                cell.robot.joints[0].name + " (ESC_ID); give one of them another");
  cell.robot.sensor = gantry_with_rft(0x64, 0x41, 0x42).sensor;
  EXPECT_NO_THROW(mit::MitArm(cell, bus.attach()));
}

TEST(SensorIdentifiers, WhoeverElseAsksTheSensorIsAnotherMaster) {
  const CanFrame stop{0x64, false, false, 8, {0x0C}};
  const CanFrame poll{0x170, false, false, 0, {}};
  CanFrame answer = poll;
  answer.length = 8;
  Robot robot = gantry_with_rft(0x64, 1, 2);
  EXPECT_TRUE(OtherMaster(robot).sent(stop));
  EXPECT_FALSE(OtherMaster(robot).sent(poll));
  robot.sensor.protocol = SensorProtocol::kAtiNetcanoem;
  robot.sensor.request_id = 0x170;
  robot.sensor.sample_ids = {0x170, 0x171};
  EXPECT_TRUE(OtherMaster(robot).sent(poll));
  EXPECT_FALSE(OtherMaster(robot).sent(answer));
  EXPECT_FALSE(OtherMaster(robot).sent(stop));
  EXPECT_EQ(describe({ArmFaultKind::kOtherMaster, 0, 0, 0x170}, robot),
            "another master runs on this bus: 0x170 (what asks the force/torque sensor) came from "
            "it; stop it first");
}

}  // namespace
}  // namespace tenon::hw

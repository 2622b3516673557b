#include "hw/robot_arm/open_arm.h"

#include <algorithm>

#include "hw/arm/canopen_arm.h"
#include "hw/arm/describe_fault.h"
#include "hw/arm/describe_sensor.h"
#include "hw/arm/drive_settings.h"
#include "hw/mit/describe_motor.h"
#include "hw/mit/mit_arm.h"
#include "shared/base/text.h"
#include "shared/mit/robot_motors.h"

namespace tenon::hw {

std::unique_ptr<DeviceArm> open_arm(const Cell& cell, CanBus& bus) {
  if (speaks_mit(cell.robot)) return std::make_unique<mit::MitArm>(cell, bus);
  return std::make_unique<CanopenArm>(cell.robot, bus);
}

std::string fault_text(const ArmFault& fault, const Robot& robot) {
  return speaks_mit(robot) ? mit::describe_fault(fault, robot) : describe(fault, robot);
}

namespace {

std::vector<std::string> motor_remarks(const Robot& robot) {
  std::uint32_t watchdog_ms = 0;
  for (const Joint& joint : robot.joints) {
    watchdog_ms = std::max(watchdog_ms, mit_motor(joint).watchdog_ms);
  }
  return {"robot '" + robot.name +
          format("' has no brakes: at the end of a run, in a fault of a motor, and %u ms after the "
                 "executor has died, the motors go off and the arm falls; the cell must bear that "
                 "(falls_without_power)",
                 watchdog_ms)};
}

}  // namespace

std::vector<std::string> start_remarks(const Robot& robot) {
  std::vector<std::string> remarks =
      speaks_mit(robot) ? motor_remarks(robot) : drive_remarks(robot);
  if (!robot.sensor.unverified.empty()) {
    remarks.push_back(
        sensor_name(robot.sensor) +
        format("%zu things of its profile are unverified; tenon-can check lists them, "
               "and --identify-payload shows whether it measures as it should",
               robot.sensor.unverified.size()));
  }
  return remarks;
}

}  // namespace tenon::hw

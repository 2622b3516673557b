#include "hw/mit/describe_motor.h"

#include <algorithm>
#include <bit>

#include "hw/arm/describe_fault.h"
#include "hw/mit/mit_supervision.h"
#include "hw/mit/motor_bring_up.h"
#include "shared/base/text.h"
#include "shared/mit/constants.h"
#include "shared/mit/robot_motors.h"

namespace tenon::hw::mit {
namespace {

namespace wire = tenon::mit;

std::string register_text(std::uint8_t number) {
  return register_name(number) + format(" (register %u)", unsigned{number});
}

std::string no_answer(const ArmFault& fault, const MitMotor& motor) {
  return "no answer to " + register_text(static_cast<std::uint8_t>(fault.object)) +
         format(
             " on 0x%03X in three tries; check power, wiring, bit rate, its ESC_ID %u, and that "
             "its MST_ID is 0x%03X",
             motor.feedback_id, unsigned{fault.node}, motor.feedback_id);
}

std::string configuration(const ArmFault& fault, const Joint& joint) {
  const auto number = static_cast<std::uint8_t>(fault.object);
  std::string wanted;
  bool writable = false;
  for (const RegisterSetting& setting : motor_settings(joint)) {
    if (setting.number != number) continue;
    wanted = register_value(number, setting.value);
    writable = setting.writable;
  }
  return "holds " + register_text(number) + " = " + register_value(number, fault.code) + " where " +
         wanted +
         (writable ? " was written; check the motor's firmware"
                   : " is in the robot file; set one like the other, and save it in the "
                     "motor");
}

std::string motor_fault(const ArmFault& fault, const Joint& joint) {
  if (fault.code == wire::kErrorLostMaster) {
    return format(
        "error 0xD (lost communication): no command for %u ms, its TIMEOUT; check bus "
        "load and wiring",
        mit_motor(joint).watchdog_ms);
  }
  return format("error 0x%X (%s); see the motor's manual", fault.code, state_text(fault.code));
}

}  // namespace

std::string register_value(std::uint8_t number, std::uint32_t value) {
  if (is_float(number)) return format("%g", double{std::bit_cast<float>(value)});
  const bool id = number == wire::kMasterId || number == wire::kMotorId;
  return format(id ? "0x%03X" : "%u", value);
}

const char* state_text(std::uint32_t state) {
  switch (state) {
    case wire::kStateOff:
      return "off";
    case wire::kStateOn:
      return "on";
    case wire::kErrorOverVoltage:
      return "over-voltage";
    case wire::kErrorUnderVoltage:
      return "under-voltage";
    case wire::kErrorOverCurrent:
      return "over-current";
    case wire::kErrorHotBoard:
      return "board too hot";
    case wire::kErrorHotCoil:
      return "coil too hot";
    case wire::kErrorLostMaster:
      return "lost communication";
    case wire::kErrorOverload:
      return "overload";
  }
  return "unknown to this program";
}

std::string describe_fault(const ArmFault& fault, const Robot& robot) {
  const auto found = std::find_if(robot.joints.begin(), robot.joints.end(),
                                  [&](const Joint& joint) { return joint.node == fault.node; });
  if (found == robot.joints.end() || fault.node == 0) return hw::describe(fault, robot);
  const std::string who = format("motor %u (", unsigned{fault.node}) + found->name + "): ";
  if (fault.kind == ArmFaultKind::kNoAnswer) return who + no_answer(fault, mit_motor(*found));
  if (fault.kind == ArmFaultKind::kConfiguration) return who + configuration(fault, *found);
  if (fault.kind == ArmFaultKind::kDriveFault) return who + motor_fault(fault, *found);
  if (fault.kind == ArmFaultKind::kDriveState) {
    return who + format(
                     "is %s where it should be on; check its supply, and that nobody else "
                     "switches it off",
                     state_text(fault.code));
  }
  if (fault.kind == ArmFaultKind::kFeedbackMissing) {
    return who + format(
                     "no feedback (0x%03X) in %u cycles in a row, at most %u are allowed; check "
                     "bus load and wiring",
                     mit_motor(*found).feedback_id, fault.code, MitSupervision::kMissingCycles);
  }
  return hw::describe(fault, robot);
}

std::string describe_settings(const Robot& robot) {
  std::string text;
  for (const Joint& joint : robot.joints) {
    text += format("motor %u (", unsigned{joint.node}) + joint.name + "), answers on " +
            format("0x%03X\n", mit_motor(joint).feedback_id);
    for (const RegisterSetting& setting : motor_settings(joint)) {
      text += "  " + register_text(setting.number) + " = " +
              register_value(setting.number, setting.value) +
              (setting.writable ? ", written where it is another\n" : ", must be so already\n");
    }
  }
  return text;
}

}  // namespace tenon::hw::mit

#include "sim/cell/faults/fault_check.h"

#include <algorithm>
#include <string>

#include "shared/base/error.h"
#include "sim/cell/faults/fault_spec.h"

namespace tenon::sim {
namespace {

[[noreturn]] void refuse(const Fault& fault, const std::string& why) {
  throw InputError(std::string("fault ") + to_string(fault.kind) + ": " + why);
}

std::string node_text(const Fault& fault) { return "node " + std::to_string(fault.node); }

const Joint* joint_of(const Robot& robot, std::uint8_t node) {
  const auto found = std::find_if(robot.joints.begin(), robot.joints.end(),
                                  [&](const Joint& joint) { return joint.node == node; });
  return found == robot.joints.end() ? nullptr : &*found;
}

bool is_sensor(const Robot& robot, std::uint8_t node) {
  return node != 0 && !robot.sensor.absent() && node == robot.sensor.node;
}

/// By the predefined frames of each; a number may be anybody's.
void check_frames(const Fault& fault, const Robot& robot) {
  const bool master = fault.node == robot.master_node;
  const bool of_devices =
      fault.frames == FrameKind::kAnswers || fault.frames == FrameKind::kEmergency;
  if (master && of_devices) {
    refuse(fault, node_text(fault) +
                      " is the master, which sends no answers and no emcy; name a "
                      "device, or no node");
  }
  if (!master && fault.frames == FrameKind::kSync) {
    refuse(fault, node_text(fault) + " sends no sync; name the master's node " +
                      std::to_string(robot.master_node) + ", or none");
  }
  if (is_sensor(robot, fault.node) && fault.frames == FrameKind::kSetpoints) {
    refuse(fault, node_text(fault) +
                      " is the force/torque sensor, for which there is no rpdo; "
                      "name a joint's node");
  }
}

void check_bus_fault(const Fault& fault, const Robot& robot) {
  if (fault.node == 0) return;
  if (joint_of(robot, fault.node) == nullptr && !is_sensor(robot, fault.node) &&
      fault.node != robot.master_node) {
    refuse(fault, node_text(fault) +
                      " is neither a joint, nor the sensor, nor the master of robot " + robot.name +
                      "; see its robot file");
  }
  if (chooses_frames(fault.kind)) check_frames(fault, robot);
}

void check_device_fault(const Fault& fault, const Robot& robot) {
  const FaultTarget target = target_of(fault.kind);
  const Joint* joint = joint_of(robot, fault.node);
  if (target == FaultTarget::kSensor && robot.sensor.absent()) {
    refuse(fault, "robot " + robot.name + " has no force/torque sensor");
  }
  const bool sensor =
      (target == FaultTarget::kSensor && fault.node == 0) || is_sensor(robot, fault.node);
  if (joint == nullptr && !sensor) {
    refuse(fault, node_text(fault) + " is neither a joint nor the sensor of robot " + robot.name);
  }
  if (target == FaultTarget::kDrive && joint == nullptr) {
    refuse(fault, node_text(fault) + " is the force/torque sensor of robot " + robot.name +
                      "; name a joint's node");
  }
  if (target == FaultTarget::kSensor && !sensor) {
    refuse(fault, node_text(fault) + " is the joint " + joint->name + " of robot " + robot.name +
                      "; leave node out for the force/torque sensor");
  }
  const bool turns = joint != nullptr && joint->kind == Joint::Kind::kRevolute;
  if (fault.unit != FaultUnit::kAny && turns != (fault.unit == FaultUnit::kRadian)) {
    refuse(fault, node_text(fault) + " is the joint " + joint->name + ", which " +
                      (turns ? "turns; give jump_rad" : "slides; give jump_m"));
  }
}

}  // namespace

void check_faults(std::span<const Fault> faults, const Robot& robot) {
  for (const Fault& fault : faults) {
    if (is_bus_fault(fault.kind)) {
      check_bus_fault(fault, robot);
    } else {
      check_device_fault(fault, robot);
    }
  }
}

}  // namespace tenon::sim

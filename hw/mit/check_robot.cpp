#include <algorithm>
#include <set>
#include <string>
#include <vector>

#include "hw/arm/cob_ids.h"
#include "hw/arm/identifiers.h"
#include "hw/mit/mit_arm.h"
#include "shared/base/error.h"
#include "shared/base/text.h"
#include "shared/canopen/constants.h"
#include "shared/mit/constants.h"
#include "shared/mit/robot_motors.h"

namespace tenon::hw::mit {
namespace {

/// Cycles without a command that a motor must bear: one lost frame, and a late cycle.
constexpr std::uint32_t kWatchdogCycles = 3;

[[noreturn]] void refuse(const Robot& robot, const std::string& why) {
  throw InputError("robot '" + robot.name + "': " + why);
}

/// What the sensor and its master use.
std::set<std::uint32_t> sensors_own(const Robot& robot) {
  namespace canopen = tenon::canopen;
  const std::uint32_t node = robot.sensor.node;
  std::set<std::uint32_t> own = {canopen::kNmt, canopen::kSync, kStopCobId,
                                 canopen::kHeartbeat + robot.master_node, tenon::mit::kRegisterId};
  if (robot.sensor.protocol == SensorProtocol::kNode) {
    own.insert({canopen::kEmergency + node, kForceCobId, kTorqueCobId, canopen::kSdoResponse + node,
                canopen::kSdoRequest + node, canopen::kHeartbeat + node});
  }
  return own;
}

/// Who else is on the bus, for a sensor that is no CANopen node.
std::vector<IdentifierOwner> motors_own(const Robot& robot) {
  namespace canopen = tenon::canopen;
  std::vector<IdentifierOwner> owners = {
      {canopen::kNmt, "NMT"},
      {canopen::kSync, "SYNC"},
      {canopen::kHeartbeat + robot.master_node, "the master's heartbeat"},
      {tenon::mit::kRegisterId, "the registers of all motors"}};
  for (const Joint& joint : robot.joints) {
    owners.push_back({joint.node, "the motor of " + joint.name + " (ESC_ID)"});
    owners.push_back({mit_motor(joint).feedback_id, "the motor of " + joint.name + " (MST_ID)"});
  }
  return owners;
}

}  // namespace

void check_robot(const Robot& robot) {
  if (robot.joints.empty() || robot.joints.size() > kMaxJoints) {
    refuse(robot, format("%zu joints, must be 1..%zu", robot.joints.size(), kMaxJoints));
  }
  check_sensor_identifiers(robot, motors_own(robot));
  std::set<std::uint32_t> taken = sensors_own(robot);
  for (const Joint& joint : robot.joints) {
    const MitMotor& motor = mit_motor(joint);
    if (joint.node < 1 || joint.node > tenon::mit::kMotorIdMax) {
      refuse(robot, "joint " + joint.name +
                        format(": motor %u, must be 1..%u, which its feedback can carry",
                               unsigned{joint.node}, unsigned{tenon::mit::kMotorIdMax}));
    }
    for (const std::uint32_t id : {std::uint32_t{joint.node}, motor.feedback_id}) {
      if (taken.insert(id).second) continue;
      refuse(robot, "joint " + joint.name +
                        format(": identifier 0x%03X is used by something else on this bus; give "
                               "the motor another ESC_ID or MST_ID",
                               id));
    }
    const std::uint32_t least_ms = kWatchdogCycles * robot.cycle_us / 1000;
    if (motor.watchdog_ms < least_ms) {
      refuse(robot, "joint " + joint.name +
                        format(": watchdog_ms = %u, must be at least %u, three cycles",
                               motor.watchdog_ms, least_ms));
    }
  }
  if (robot.heartbeat_ms == 0 || robot.heartbeat_timeout_ms < 2 * robot.heartbeat_ms) {
    refuse(robot,
           format("the sensor's heartbeat of %u ms with a timeout of %u ms; the timeout must "
                  "be at least twice the heartbeat",
                  robot.heartbeat_ms, robot.heartbeat_timeout_ms));
  }
}

}  // namespace tenon::hw::mit

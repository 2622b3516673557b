#include "hw/arm/identifiers.h"

#include "hw/arm/cob_ids.h"
#include "shared/base/error.h"
#include "shared/base/text.h"
#include "shared/canopen/constants.h"
#include "shared/sensors/ati_netcanoem.h"

namespace tenon::hw {

std::vector<IdentifierOwner> canopen_identifiers(const Robot& robot) {
  using namespace tenon::canopen;
  std::vector<IdentifierOwner> owners = {
      {kNmt, "NMT"},
      {kSync, "SYNC"},
      {kStopCobId, "the stop of all drives"},
      {kHeartbeat + robot.master_node, "the master's heartbeat"}};
  for (std::size_t i = 0; i < robot.joints.size(); ++i) {
    const Joint& joint = robot.joints[i];
    const std::string of = " of " + joint.name + format(" (node %u)", unsigned{joint.node});
    owners.push_back({kEmergency + joint.node, "EMCY" + of});
    owners.push_back({joint_feedback_cob_id(robot, i), "feedback" + of});
    owners.push_back({joint_command_cob_id(joint.node), "command" + of});
    owners.push_back({joint_controlword_cob_id(joint.node), "controlword" + of});
    owners.push_back({kSdoResponse + joint.node, "SDO answer" + of});
    owners.push_back({kSdoRequest + joint.node, "SDO request" + of});
    owners.push_back({kHeartbeat + joint.node, "heartbeat" + of});
  }
  return owners;
}

std::vector<IdentifierOwner> sensor_identifiers(const ForceTorqueSensor& sensor) {
  const std::string of = " of the force/torque sensor " + sensor.profile;
  switch (sensor.protocol) {
    case SensorProtocol::kNode:
    case SensorProtocol::kNone:
      break;
    case SensorProtocol::kRobotousRft:
      return {{sensor.request_id, "the commands" + of},
              {sensor.sample_ids[0], "the first frame" + of},
              {sensor.sample_ids[1], "the second frame" + of}};
    case SensorProtocol::kAtiNetcanoem: {
      // Whatever it is asked one day: all sixteen are its.
      std::vector<IdentifierOwner> owners;
      for (std::uint32_t operation = 0; operation < ati::kOperations; ++operation) {
        owners.push_back({sensor.request_id | operation, format("operation %u", operation) + of});
      }
      return owners;
    }
  }
  return {};
}

void check_sensor_identifiers(const Robot& robot, std::span<const IdentifierOwner> others) {
  if (robot.sensor.has_own_bus()) return;
  for (const IdentifierOwner& own : sensor_identifiers(robot.sensor)) {
    for (const IdentifierOwner& other : others) {
      if (own.id != other.id) continue;
      throw InputError("robot '" + robot.name +
                       format("': identifier 0x%03X is given to both ", own.id) + own.owner +
                       " and " + other.owner + "; give one of them another");
    }
  }
}

}  // namespace tenon::hw

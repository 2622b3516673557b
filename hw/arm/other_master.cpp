#include "hw/arm/other_master.h"

#include "hw/arm/cob_ids.h"
#include "shared/canopen/constants.h"

namespace tenon::hw {
namespace {

/// Client command specifiers, the three highest bits of the first byte (CiA 301, 7.2.4.3).
constexpr unsigned kInitiateDownload = 1;
constexpr unsigned kBlockDownload = 6;

}  // namespace

OtherMaster::OtherMaster(const Robot& robot) {
  for (Betrayals& bus : of_bus_) {
    bus.masters_own.set(tenon::canopen::kNmt);
    bus.masters_own.set(tenon::canopen::kSync);
    bus.masters_own.set(tenon::canopen::kHeartbeat + robot.master_node);
  }
  Betrayals& arm = of_bus_[kArmBus];
  arm.masters_own.set(kStopCobId);
  for (const Joint& joint : robot.joints) {
    arm.masters_own.set(joint_command_cob_id(joint.node));
    arm.masters_own.set(joint_controlword_cob_id(joint.node));
    arm.sdo_requests.set(tenon::canopen::kSdoRequest + joint.node);
  }
  Betrayals& sensor = of_bus_[robot.sensor.bus()];
  if (robot.sensor.node != 0) {
    sensor.sdo_requests.set(tenon::canopen::kSdoRequest + robot.sensor.node);
  } else if (robot.sensor.protocol == SensorProtocol::kRobotousRft) {
    sensor.masters_own.set(robot.sensor.request_id);
  } else if (!robot.sensor.absent()) {
    sensor.polled_id = robot.sensor.request_id;
    // Nothing of CANopen is on its own bus, and any of these may be its answer.
    if (robot.sensor.has_own_bus()) sensor.masters_own.reset();
  }
}

bool OtherMaster::sent(const CanFrame& frame) const noexcept {
  if (frame.extended || frame.remote || frame.id >= kIdentifiers) return false;
  const Betrayals& bus = of_bus_[frame.bus < of_bus_.size() ? frame.bus : kArmBus];
  if (bus.masters_own[frame.id]) return true;
  // Its answers have the same identifier, and data.
  if (frame.id == bus.polled_id && frame.length == 0) return true;
  if (!bus.sdo_requests[frame.id] || frame.length == 0) return false;
  const unsigned command = frame.data[0] >> 5U;
  return command == kInitiateDownload || command == kBlockDownload;
}

}  // namespace tenon::hw

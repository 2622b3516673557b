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
  masters_own_.set(tenon::canopen::kNmt);
  masters_own_.set(tenon::canopen::kSync);
  masters_own_.set(tenon::canopen::kHeartbeat + robot.master_node);
  masters_own_.set(kStopCobId);
  for (const Joint& joint : robot.joints) {
    masters_own_.set(joint_command_cob_id(joint.node));
    masters_own_.set(joint_controlword_cob_id(joint.node));
    sdo_requests_.set(tenon::canopen::kSdoRequest + joint.node);
  }
  if (robot.sensor.node != 0) {
    sdo_requests_.set(tenon::canopen::kSdoRequest + robot.sensor.node);
  } else if (robot.sensor.protocol == SensorProtocol::kRobotousRft) {
    masters_own_.set(robot.sensor.request_id);
  } else {
    polled_id_ = robot.sensor.request_id;
  }
}

bool OtherMaster::sent(const CanFrame& frame) const noexcept {
  if (frame.extended || frame.remote || frame.id >= kIdentifiers) return false;
  if (masters_own_[frame.id]) return true;
  // Its answers have the same identifier, and data.
  if (frame.id == polled_id_ && frame.length == 0) return true;
  if (!sdo_requests_[frame.id] || frame.length == 0) return false;
  const unsigned command = frame.data[0] >> 5U;
  return command == kInitiateDownload || command == kBlockDownload;
}

}  // namespace tenon::hw

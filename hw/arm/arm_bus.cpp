#include "hw/arm/arm_bus.h"

#include <algorithm>

#include "hw/arm/cob_ids.h"
#include "hw/arm/identifiers.h"
#include "shared/canopen/constants.h"

namespace tenon::hw {

ArmBus::ArmBus(const Robot& robot, CanBus& bus, ArmCounters& counters)
    : bus_(bus),
      counters_(counters),
      apart_(robot.sensor.has_own_bus()),
      sensor_node_(robot.sensor.node),
      master_node_(robot.master_node) {
  using namespace tenon::canopen;
  for (const IdentifierOwner& owner : sensor_identifiers(robot.sensor)) sensors_.set(owner.id);
  if (sensor_node_ == 0) return;
  for (const std::uint32_t id :
       {kForceCobId, kTorqueCobId, kEmergency + sensor_node_, kSdoRequest + sensor_node_,
        kSdoResponse + sensor_node_, kHeartbeat + sensor_node_}) {
    sensors_.set(id);
  }
  for (const std::uint32_t id :
       {std::uint32_t{kNmt}, std::uint32_t{kSync}, std::uint32_t{kHeartbeat} + master_node_}) {
    common_.set(id);
  }
}

ArmBus::Way ArmBus::way_of(const CanFrame& frame) const noexcept {
  if (!apart_ || sensor_node_ == 0 || frame.extended || frame.id >= kIdentifiers) {
    return Way::kAsNamed;
  }
  if (frame.id == tenon::canopen::kNmt) {
    const bool to_all = frame.data[1] == 0;
    if (!to_all) return frame.data[1] == sensor_node_ ? Way::kSensor : Way::kAsNamed;
  }
  if (common_[frame.id]) return Way::kBoth;
  return sensors_[frame.id] ? Way::kSensor : Way::kAsNamed;
}

SendResult ArmBus::send(const CanFrame& frame) noexcept {
  const Way way = way_of(frame);
  if (way == Way::kAsNamed) return bus_.send(frame);
  CanFrame there = frame;
  there.bus = kSensorBus;
  const SendResult at_sensor = bus_.send(there);
  if (way == Way::kSensor) return at_sensor;
  return std::max(bus_.send(frame), at_sensor);  // the worse of the two
}

bool ArmBus::belongs(const CanFrame& frame) const noexcept {
  // Of no identifier of ours: whoever reads it says so.
  if (frame.extended || frame.id >= kIdentifiers) return true;
  if (frame.bus == kSensorBus) return sensors_[frame.id] || common_[frame.id];
  return sensor_node_ == 0 || !sensors_[frame.id];
}

bool ArmBus::receive(ReceivedFrame& received) noexcept {
  while (bus_.receive(received)) {
    if (!apart_ || belongs(received.frame)) return true;
    ++counters_.unexpected_frames;
  }
  return false;
}

}  // namespace tenon::hw

#include "hw/arm/sensor_device.h"

#include <utility>

#include "hw/arm/cob_ids.h"
#include "hw/sensors/ati_netcanoem_source.h"
#include "hw/sensors/ati_netcanoem_start.h"
#include "hw/sensors/canopen_wrench_source.h"
#include "hw/sensors/no_wrench_source.h"
#include "hw/sensors/robotous_rft_source.h"
#include "hw/sensors/robotous_rft_start.h"

namespace tenon::hw {

SensorDevice open_sensor(const ForceTorqueSensor& sensor) {
  switch (sensor.protocol) {
    case SensorProtocol::kNode:
      break;
    case SensorProtocol::kNone:
      return {std::make_unique<NoWrenchSource>(), nullptr};
    case SensorProtocol::kRobotousRft:
      return {std::make_unique<RobotousRftSource>(sensor),
              std::make_unique<RobotousRftStart>(sensor)};
    case SensorProtocol::kAtiNetcanoem: {
      auto source = std::make_unique<AtiNetcanoemSource>(sensor);
      auto start = std::make_unique<AtiNetcanoemStart>(sensor, *source);
      return {std::move(source), std::move(start)};
    }
  }
  return {std::make_unique<CanopenWrenchSource>(
              sensor, CanopenWrenchSource::CobIds{kForceCobId, kTorqueCobId}),
          nullptr};
}

}  // namespace tenon::hw

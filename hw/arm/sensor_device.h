#pragma once
// The force/torque sensor that a robot file names: the one place that tells sensors apart for the
// arms. Set-up code.

#include <memory>

#include "hw/sensors/sensor_start.h"
#include "shared/cell/robot.h"
#include "shared/ports/wrench_source.h"

namespace tenon::hw {

struct SensorDevice {
  std::unique_ptr<WrenchSource> source;
  /// What it needs before it measures; null: hw/arm/bring_up.h does all.
  std::unique_ptr<SensorStart> start;

  [[nodiscard]] bool started() const {
    return start == nullptr || start->state() == SensorStart::State::kDone;
  }
  [[nodiscard]] bool failed() const {
    return start != nullptr && start->state() == SensorStart::State::kFailed;
  }
  void restart() {
    if (start != nullptr) start->restart();
  }
};

[[nodiscard]] SensorDevice open_sensor(const ForceTorqueSensor& sensor);

}  // namespace tenon::hw

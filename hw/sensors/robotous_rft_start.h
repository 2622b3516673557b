#pragma once
// The start of a Robotous RFT sensor: it is stopped, whatever it did before; its rate is set, which
// it must confirm; it is started, and a whole sample must come.

#include "hw/sensors/sensor_start.h"
#include "shared/cell/robot.h"

namespace tenon::hw {

class RobotousRftStart final : public SensorStart {
 public:
  explicit RobotousRftStart(const ForceTorqueSensor& sensor)
      : SensorStart(sensor.bus()), sensor_(sensor) {}

 private:
  [[nodiscard]] std::size_t questions() const override { return 3; }
  [[nodiscard]] Question question(std::size_t which) const override;
  void begin(std::size_t /*which*/) override { half_ = false; }
  [[nodiscard]] Heard hear(std::size_t which, const CanFrame& frame, ArmFault& fault) override;

  const ForceTorqueSensor sensor_;
  bool half_ = false;  ///< the first frame of a sample has come
};

}  // namespace tenon::hw

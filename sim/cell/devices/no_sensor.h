#pragma once
// In the place of a force/torque sensor where a cell has none.

#include "sim/cell/devices/virtual_sensor.h"

namespace tenon::sim {

class NoSensor : public VirtualSensor {
 public:
  void power_on(std::int64_t /*now_ns*/) override {}
  void receive(const CanFrame& /*frame*/, std::int64_t /*now_ns*/) override {}
  void take(std::vector<CanFrame>& /*frames*/) override {}
  void advance(std::int64_t /*now_ns*/) override {}
  [[nodiscard]] bool is_asked_by(const CanFrame& /*frame*/) const override { return false; }
  void measured(const Vector6& /*wrench*/, std::int64_t /*step_ns*/) override {}
  void inject(const Fault& /*fault*/) override {}
};

}  // namespace tenon::sim

#pragma once
// The virtual cell's view of a force/torque sensor, whatever it speaks: frames in and out, when it
// samples, and the wrench that it then measures. One thread; time is an argument.

#include <cstdint>
#include <vector>

#include "shared/math/pose.h"
#include "shared/ports/can_bus.h"
#include "sim/cell/faults/fault.h"

namespace tenon::sim {

class VirtualSensor {
 public:
  VirtualSensor() = default;
  VirtualSensor(const VirtualSensor&) = delete;
  VirtualSensor& operator=(const VirtualSensor&) = delete;
  virtual ~VirtualSensor() = default;

  virtual void power_on(std::int64_t now_ns) = 0;
  virtual void receive(const CanFrame& frame, std::int64_t now_ns) = 0;
  /// Moves what is to be sent to the end of `frames`.
  virtual void take(std::vector<CanFrame>& frames) = 0;
  /// Its timers, drift, and faults.
  virtual void advance(std::int64_t now_ns) = 0;

  /// Whether this frame makes it sample: it wants to have measured by then.
  [[nodiscard]] virtual bool is_asked_by(const CanFrame& frame) const = 0;
  /// By its own clock; it wants to have measured by then, and streams on with stream().
  [[nodiscard]] virtual bool is_due(std::int64_t /*now_ns*/) const { return false; }
  virtual void stream(std::int64_t /*now_ns*/) {}
  /// The true wrench at the sensor, in its axes, over the last `step_ns`.
  virtual void measured(const Vector6& wrench, std::int64_t step_ns) = 0;

  /// Begins a fault now, that is at the time of the last advance(). Others than it can have are
  /// ignored.
  virtual void inject(const Fault& fault) = 0;
};

}  // namespace tenon::sim

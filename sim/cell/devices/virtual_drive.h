#pragma once
// The virtual cell's view of a drive, whatever it speaks: frames in and out, what it demands of the
// axis, and what there is to see of it. What turns the axis, and how far it really got, is the
// plant's: it reads demand() and writes measured(). One thread; time is an argument.

#include <cstdint>
#include <optional>
#include <vector>

#include "shared/ports/can_bus.h"
#include "sim/cell/faults/fault.h"

namespace tenon::sim {

class VirtualDrive {
 public:
  /// A spring and a damper from the demand to the axis, and an effort beside them.
  struct Impedance {
    double stiffness = 0.0;  ///< N/m or Nm/rad
    double damping = 0.0;    ///< N s/m or Nm s/rad
    double effort = 0.0;     ///< N or Nm, in the joint's direction
  };

  /// What brake and servo are to do. Neither: the axis is free.
  struct Demand {
    bool brake = true;     ///< holds the axis, whatever the servo does
    bool powered = false;  ///< the servo follows the demand with what torque it has
    double position_counts = 0.0;
    double velocity_countsps = 0.0;
    double torque_max_permille = 0.0;  ///< of rated
    /// Of a drive whose master sets it; unset: a servo as stiff as the joint.
    std::optional<Impedance> impedance = std::nullopt;
  };

  struct Measurement {
    double position_counts = 0.0;
    double velocity_countsps = 0.0;
    double torque_permille = 0.0;  ///< of rated
    /// By which a drive under power misreads that, of rated. What it does goes by the true one.
    double torque_off_permille = 0.0;
  };

  /// What there is to see of it.
  struct Look {
    const char* state = "";    ///< of its own machine; the same text for the same state
    bool switched_on = false;  ///< power has come on, it does not follow yet
    bool enabled = false;      ///< follows its master
    bool stopping = false;     ///< ramps down under power, or its brake closes
    bool faulted = false;
    bool brake_engaged = false;  ///< its output
    bool operational = false;    ///< its node takes part in the cycle
    std::uint16_t error_code = 0;
  };

  VirtualDrive() = default;
  VirtualDrive(const VirtualDrive&) = delete;
  VirtualDrive& operator=(const VirtualDrive&) = delete;
  virtual ~VirtualDrive() = default;

  /// Its number on the bus.
  [[nodiscard]] virtual std::uint8_t number() const = 0;
  virtual void power_on(std::int64_t now_ns) = 0;
  virtual void receive(const CanFrame& frame, std::int64_t now_ns) = 0;
  /// Moves what is to be sent to the end of `frames`.
  virtual void take(std::vector<CanFrame>& frames) = 0;
  /// Its timers.
  virtual void advance(std::int64_t now_ns) = 0;

  /// The demand at the end of the next `step_ns`, in which the plant then moves.
  [[nodiscard]] virtual Demand demand(std::int64_t step_ns) = 0;
  /// The plant after that step.
  virtual void measured(const Measurement& measurement, std::int64_t step_ns) = 0;

  /// Whether such a device can have that fault.
  [[nodiscard]] virtual bool can_have(const Fault& fault) const = 0;
  /// Begins a fault now, that is at the time of the last advance(). Others than it can have are
  /// ignored.
  virtual void inject(const Fault& fault) = 0;

  [[nodiscard]] virtual Look look() const = 0;
};

}  // namespace tenon::sim

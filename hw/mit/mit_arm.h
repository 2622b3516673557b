#pragma once
// An arm of motors in MIT mode and a force/torque sensor on one CAN bus, or on one each, behind the
// arm port.
//
// prepare() brings up the sensor (hw/arm/bring_up.h, hw/sensors/sensor_start.h), then the motors
// (motor_bring_up.h). After that a cycle is
//
//   start_cycle   SYNC, and what the sensor is asked by more; to each motor what command() decided
//                 last, which it answers with its feedback
//   receive       the feedback of every motor, the two halves of the wrench
//   command       supervision, state machine, what the motors are sent as the next cycle begins,
//                 the master's heartbeat
//
// So a setpoint waits for the next cycle as in hw/arm/canopen_arm.h, and position and wrench are of
// one time. What stops leaves at once. A force beyond its limit makes all motors stand as its frame
// is heard. A motor that is sent nothing for its TIMEOUT stops by itself, so that a hung program
// looks dead; it has no brake, and what it carries falls.
//
// Real-time but for the constructor and prepare(). One thread. Owns everything but the bus, which
// must outlive it.

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "hw/arm/arm_bus.h"
#include "hw/arm/arm_counters.h"
#include "hw/arm/bring_up.h"
#include "hw/arm/device_arm.h"
#include "hw/arm/sensor_device.h"
#include "hw/mit/mit_supervision.h"
#include "hw/mit/motor_bring_up.h"
#include "hw/mit/motor_channel.h"
#include "hw/mit/motor_recheck.h"
#include "hw/sensors/wrench_intake.h"
#include "shared/cell/cell.h"
#include "shared/kinematics/inverse_dynamics.h"
#include "shared/ports/arm.h"
#include "shared/ports/can_bus.h"

namespace tenon::hw::mit {

/// Throws InputError with one line where such motors and their sensor cannot share a bus: a number
/// that feedback cannot carry, an identifier that something else uses, a heartbeat slower than half
/// its timeout, a watchdog that a cycle or two of lost frames would set off.
void check_robot(const Robot& robot);

class MitArm : public DeviceArm {
 public:
  /// @param cell its masses are what is held against gravity  @throws InputError, see check_robot()
  MitArm(const Cell& cell, CanBus& bus);

  [[nodiscard]] std::size_t joint_count() const noexcept override { return motors_.size(); }
  [[nodiscard]] bool prepare(std::int64_t now_ns) override;
  void start_cycle(std::int64_t now_ns) noexcept override;
  [[nodiscard]] bool receive(std::int64_t now_ns, ArmFeedback& feedback) noexcept override;
  void command(std::int64_t now_ns, ArmRequest request,
               const JointVector& position) noexcept override;
  void limit_force(const ForceLimit& limit) noexcept override { limit_ = limit; }
  void rely_on_sensor(bool relied) noexcept override { supervision_.rely_on_sensor(relied); }
  bool attend(std::int64_t now_ns) noexcept override;
  void wait(std::int64_t at_most_ns) noexcept override { bus_.wait(at_most_ns); }
  [[nodiscard]] ArmState state() const noexcept override { return supervision_.state(); }
  [[nodiscard]] ArmFault fault() const noexcept override { return supervision_.fault(); }

  [[nodiscard]] const ArmCounters& counters() const noexcept override { return counters_; }
  [[nodiscard]] std::vector<std::string> notes() const override;

 private:
  /// Bounds a cycle's work however much arrives.
  static constexpr int kMostFrames = 256;

  void bring_up(std::int64_t now_ns);
  void begin(std::int64_t now_ns);
  int drain(std::int64_t now_ns) noexcept;
  void take(const ReceivedFrame& received, std::int64_t now_ns) noexcept;
  [[nodiscard]] bool take_motor(const CanFrame& frame) noexcept;
  void check_motors() noexcept;
  [[nodiscard]] bool take_wrench(const ReceivedFrame& received) noexcept;
  [[nodiscard]] bool others_own(const CanFrame& frame) const noexcept;
  void decide(ArmRequest request, bool follow, const JointVector& position) noexcept;
  void send(const CanFrame& frame) noexcept;
  void send_to_motors() noexcept;
  void send_heartbeat(std::int64_t now_ns) noexcept;

  const Robot robot_;
  ArmCounters counters_;
  ArmBus bus_;
  const InverseDynamics gravity_;  ///< motors without an integral part would sag
  BringUp sensor_bring_up_;
  MotorBringUp motor_bring_up_;
  OtherMaster other_master_;
  MotorRecheck recheck_;
  std::vector<MotorChannel> motors_;  ///< of a fixed size: the supervision looks into it
  SensorDevice sensor_;
  WrenchIntake wrench_intake_;
  MitSupervision supervision_;

  ForceLimit limit_;
  ArmFeedback feedback_;
  ArmRequest granted_ = ArmRequest::kDisabled;  ///< in the last cycle
  bool cycle_open_ = false;
  bool wrench_late_ = false;  ///< one has come since the last cycle closed
  std::int64_t next_heartbeat_ns_ = 0;
};

}  // namespace tenon::hw::mit

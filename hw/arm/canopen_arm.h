#pragma once
// An arm of CiA 402 drives and a force/torque sensor on one CAN bus, or on one each, behind the arm
// port.
//
// prepare() brings all nodes up (hw/arm/bring_up.h), then a sensor that is none
// (hw/sensors/sensor_start.h). After that a cycle is
//
//   start_cycle   takes in what came late, then SYNC: drives act on their targets and answer; then
//                 what the sensor is asked, where it is asked by more
//   receive       TPDO1 of every joint, the two halves of the wrench
//   command       supervision, state machine, RPDOs of every joint, the master's heartbeat
//
// A force beyond its limit stops all drives as its frame is heard, in the cycle or between two, by
// one frame; nothing enables them again before all are off.
//
//   bus --> ArmIntake --> ArmSupervision --> ArmOutput --> bus
//
// The state machine stands in hw/arm/arm_supervision.h; prepare() leads out of kUnconfigured and
// out of kFault. In kFault drives are quick-stopped, or disabled where the caller asks for that.
// The master's first heartbeat leaves with the first command(); from then on the drives stop by
// themselves when it stays away for the robot's heartbeat timeout.
//
// Real-time but for the constructor and prepare(). One thread. Owns everything but the bus, which
// must outlive it.

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "hw/arm/arm_bus.h"
#include "hw/arm/arm_counters.h"
#include "hw/arm/arm_intake.h"
#include "hw/arm/arm_output.h"
#include "hw/arm/arm_supervision.h"
#include "hw/arm/bring_up.h"
#include "hw/arm/device_arm.h"
#include "hw/arm/joint_channel.h"
#include "hw/arm/sensor_device.h"
#include "shared/cell/robot.h"
#include "shared/ports/arm.h"
#include "shared/ports/can_bus.h"

namespace tenon::hw {

class CanopenArm : public DeviceArm {
 public:
  using Counters = ArmCounters;

  /// Throws InputError where check_robot() refuses.
  CanopenArm(const Robot& robot, CanBus& bus);

  [[nodiscard]] std::size_t joint_count() const noexcept override { return joints_.size(); }
  [[nodiscard]] bool prepare(std::int64_t now_ns) override;
  void start_cycle(std::int64_t now_ns) noexcept override;
  [[nodiscard]] bool receive(std::int64_t now_ns, ArmFeedback& feedback) noexcept override;
  void command(std::int64_t now_ns, ArmRequest request,
               const JointVector& position) noexcept override;
  void limit_force(const ForceLimit& limit) noexcept override { intake_.limit_force(limit); }
  void rely_on_sensor(bool relied) noexcept override { supervision_.rely_on_sensor(relied); }
  bool attend(std::int64_t now_ns) noexcept override;
  void wait(std::int64_t at_most_ns) noexcept override { bus_.wait(at_most_ns); }
  [[nodiscard]] ArmState state() const noexcept override { return supervision_.state(); }
  [[nodiscard]] ArmFault fault() const noexcept override { return supervision_.fault(); }

  [[nodiscard]] const Counters& counters() const noexcept override { return counters_; }
  [[nodiscard]] std::vector<std::string> notes() const override;
  /// What the devices say they are; filled by prepare().
  [[nodiscard]] const BringUp& bring_up() const { return bring_up_; }

 private:
  void run_bring_up(std::int64_t now_ns);
  /// @param setpoints_wait setpoints have left that act with the next SYNC
  void stop_if_due(bool setpoints_wait) noexcept;

  const Robot robot_;
  Counters counters_;
  ArmBus bus_;
  BringUp bring_up_;
  std::vector<JointChannel> joints_;  ///< of a fixed size: the parts below look into it
  SensorDevice sensor_;
  ArmSupervision supervision_;
  ArmIntake intake_;
  ArmOutput output_;
};

}  // namespace tenon::hw

#pragma once
// What an arm of motors in MIT mode is: its state, and the first fault. It is told what was heard
// and what could not be sent, looks at the motors once a cycle, and sends nothing itself. The
// states are those of hw/arm/arm_supervision.h:
//
//   kUnconfigured --begin()--> kDisabled --enabled--> kEnabling --all on--> kEnabled
//                                  ^                                           |
//                                  +-- all off -- kStopping <-- off, quick stop-+
//   any --raise()--> kFault, until reset(). The first fault stays.
//
// Motors send no sign of life but their answers: what is missing for more than kMissingCycles
// cycles in a row is their silence. The sensor is a CANopen node, and watched as one.
//
// Real-time but for the constructor, no clock; one thread. Motors and counters outlive it.

#include <array>
#include <cstdint>
#include <optional>
#include <span>

#include "hw/arm/arm_counters.h"
#include "hw/canopen/emergency.h"
#include "hw/canopen/heartbeat.h"
#include "hw/canopen/heartbeat_watch.h"
#include "hw/mit/motor_channel.h"
#include "hw/sensors/wrench_staleness.h"
#include "shared/cell/robot.h"
#include "shared/ports/arm.h"
#include "shared/ports/can_bus.h"

namespace tenon::hw::mit {

class MitSupervision {
 public:
  static constexpr std::uint32_t kMissingCycles = 5;
  static constexpr std::uint32_t kSilentCycles = 3;   ///< without any answer at all
  static constexpr std::uint32_t kRefusedCycles = 2;  ///< with frames that were not taken
  static constexpr std::int64_t kEnablingTimeout_ns = 2'000'000'000;

  MitSupervision(const Robot& robot, std::span<const MotorChannel> motors, ArmCounters& counters);

  [[nodiscard]] ArmState state() const noexcept { return state_; }
  [[nodiscard]] const ArmFault& fault() const noexcept { return fault_; }
  /// Faults of the sensor's node are raised only where it is relied on.
  void rely_on_sensor(bool relied) noexcept { sensor_relied_on_ = relied; }
  /// All motors are on, which is not yet to be enabled.
  [[nodiscard]] bool all_on() const noexcept;
  /// And are as bring-up has made them: then the arm is enabled.
  void motors_as_set(bool as_set) noexcept { as_set_ = as_set; }
  /// The force at which the motors were stopped; 0: they were not.
  [[nodiscard]] double force_stopped_N() const noexcept { return force_stopped_N_; }

  void reset() noexcept;
  /// All devices are configured.
  void begin(std::int64_t now_ns) noexcept;

  // Told as it happens.
  void raise(const ArmFault& fault) noexcept;
  void look_at_bus(const CanBusStatus& status) noexcept;
  /// Their states, as they answered what they were asked last.
  void look_at_motors(ArmRequest asked) noexcept;
  void heard(const canopen::Heartbeat& heartbeat, std::int64_t now_ns) noexcept;
  void heard(const canopen::Emergency& emergency) noexcept;
  void frame_refused() noexcept { refused_ = true; }
  /// True: the motors are to be stopped now.
  [[nodiscard]] bool force_exceeded(double force_N) noexcept;

  // Once a cycle, in this order.
  void look_at_answers(const ArmFeedback& feedback, std::int64_t now_ns) noexcept;
  void look_at_setpoints(const JointVector& position) noexcept;
  void advance(std::int64_t now_ns, ArmRequest wanted) noexcept;
  void look_at_sending(const CanBusStatus& status) noexcept;

  /// What the motors are asked instead: in a fault, and beyond the limit of the force, they stand.
  [[nodiscard]] ArmRequest granted(ArmRequest wanted) const noexcept;

 private:
  void enter_state(ArmState state, std::int64_t now_ns) noexcept;
  void enable(std::int64_t now_ns) noexcept;

  const std::span<const MotorChannel> motors_;
  ArmCounters& counters_;
  const std::uint8_t sensor_node_;
  const std::int64_t heartbeat_timeout_ns_;

  ArmFault fault_;
  ArmState state_ = ArmState::kUnconfigured;
  std::int64_t entered_ns_ = 0;
  bool sensor_relied_on_ = true;
  bool as_set_ = false;
  double force_stopped_N_ = 0.0;
  canopen::HeartbeatWatch sensor_watch_;
  std::array<std::uint32_t, kMaxJoints> missing_{};  ///< in a row
  WrenchStaleness wrench_;
  std::uint32_t silent_cycles_ = 0;
  std::uint32_t refused_cycles_ = 0;
  bool refused_ = false;
  std::optional<std::uint64_t> send_failures_;  ///< of the bus, as of the last cycle
};

}  // namespace tenon::hw::mit

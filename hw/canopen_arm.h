#pragma once
// An arm of CiA 402 drives and a force/torque node on one CAN bus, behind the arm port.
//
// prepare() brings all nodes up (hw/bring_up.h). After that a cycle is
//
//   start_cycle   takes in what came late, then SYNC: drives act on their targets and answer
//   receive       TPDO1 of every joint, the two halves of the wrench
//   command       supervision, state machine, RPDOs of every joint, the master's heartbeat
//
//   kUnconfigured --prepare()--> kDisabled --enabled--> kEnabling --all enabled--> kEnabled
//                                    ^                                                |
//                                    +-- all off -- kStopping <-- disabled, quick stop-+
//   any but kUnconfigured --supervision--> kFault: drives are quick-stopped, or disabled where the
//   caller asks for that, until prepare() starts over. The first fault stays.
//
// Supervised: bus, heartbeat of every node, boot-ups and other NMT states of running nodes, EMCY,
// statuswords, feedback and wrench missing for more than kMissingCycles cycles in a row, saturated
// wrench. The master's first heartbeat leaves with the first command(); from then on the drives
// stop by themselves when it stays away for the robot's heartbeat timeout.
//
// Real-time but for the constructor and prepare(). One thread. Owns everything but the bus, which
// must outlive it.

#include <array>
#include <cstddef>
#include <cstdint>

#include "hw/bring_up.h"
#include "hw/canopen/emergency.h"
#include "hw/canopen/heartbeat_watch.h"
#include "hw/joint_channel.h"
#include "hw/wrench_pairing.h"
#include "shared/cell/robot.h"
#include "shared/ports/arm.h"
#include "shared/ports/can_bus.h"

namespace tenon::hw {

class CanopenArm : public Arm {
 public:
  /// Only grow; for telemetry.
  struct Counters {
    std::uint64_t cycles = 0;
    std::uint64_t joint_frames_missing = 0;  ///< joint cycles that closed without feedback
    std::uint64_t wrenches_missing = 0;      ///< cycles that closed without a new wrench
    std::uint64_t wrench_halves_torn = 0;
    std::uint64_t late_frames = 0;       ///< process data that came after its cycle had closed
    std::uint64_t malformed_frames = 0;  ///< known identifier, wrong length
    std::uint64_t unexpected_frames = 0;
    std::uint64_t emergencies = 0;
    std::uint64_t send_failures = 0;
    std::uint64_t invalid_setpoints = 0;  ///< not finite: the last target was sent again
  };

  static constexpr std::uint32_t kMissingCycles = 5;
  static constexpr std::int64_t kEnablingTimeout_ns = 2'000'000'000;
  /// Bounds a cycle's work however much arrives.
  static constexpr int kMaxFramesPerCall = 256;

  /// Throws InputError where check_robot() refuses.
  CanopenArm(const Robot& robot, CanBus& bus);

  [[nodiscard]] std::size_t joint_count() const noexcept override { return joint_count_; }
  [[nodiscard]] bool prepare(std::int64_t now_ns) override;
  void start_cycle(std::int64_t now_ns) noexcept override;
  [[nodiscard]] bool receive(std::int64_t now_ns, ArmFeedback& feedback) noexcept override;
  void command(std::int64_t now_ns, ArmRequest request,
               const JointVector& position) noexcept override;
  void wait(std::int64_t at_most_ns) noexcept override { bus_.wait(at_most_ns); }
  [[nodiscard]] ArmState state() const noexcept override { return state_; }
  [[nodiscard]] ArmFault fault() const noexcept override { return fault_; }

  [[nodiscard]] const Counters& counters() const noexcept { return counters_; }
  /// What the devices say they are; filled by prepare().
  [[nodiscard]] const BringUp& bring_up() const { return bring_up_; }

 private:
  void begin_operation(std::int64_t now_ns);

  // Taking in.
  void drain(std::int64_t now_ns) noexcept;
  void take(const CanFrame& frame, std::int64_t now_ns) noexcept;
  [[nodiscard]] bool take_process_data(const CanFrame& frame) noexcept;
  void take_wrench_half(WrenchPairing::Half half, const CanFrame& frame) noexcept;
  void take_heartbeat(const canopen::Heartbeat& heartbeat, std::int64_t now_ns) noexcept;
  void take_emergency(const canopen::Emergency& emergency) noexcept;
  [[nodiscard]] bool complete() const noexcept;

  // Supervision and state.
  void supervise(std::int64_t now_ns) noexcept;
  void supervise_bus() noexcept;
  void supervise_feedback() noexcept;
  void supervise_drives(ArmRequest request) noexcept;
  void advance(std::int64_t now_ns, ArmRequest request) noexcept;
  void enter_state(ArmState state, std::int64_t now_ns) noexcept;
  void raise(ArmFaultKind kind, std::uint8_t node, std::uint32_t object,
             std::uint32_t code) noexcept;
  [[nodiscard]] bool all_enabled() const noexcept;
  [[nodiscard]] bool none_energised() const noexcept;

  // Sending.
  void send(const CanFrame& frame) noexcept;
  void send_setpoints(ArmRequest request, bool follow, const JointVector& position) noexcept;
  void send_packed_setpoints() noexcept;
  void send_heartbeat(std::int64_t now_ns) noexcept;

  CanBus& bus_;
  const std::size_t joint_count_;
  const ForceTorqueSensor sensor_;
  const std::uint8_t master_node_;
  const bool packed_;  ///< two targets a frame
  const std::int64_t heartbeat_ns_;
  const std::int64_t heartbeat_timeout_ns_;

  BringUp bring_up_;
  std::array<JointChannel, kMaxJoints> joints_;
  WrenchPairing pairing_;
  canopen::HeartbeatWatch watch_;

  ArmState state_ = ArmState::kUnconfigured;
  std::int64_t entered_ns_ = 0;
  ArmFault fault_;
  ArmFeedback feedback_;
  Counters counters_;
  bool cycle_open_ = false;
  std::uint8_t halves_seen_ = 0;  ///< this cycle: bit 0 force, bit 1 torque
  std::uint32_t stale_cycles_ = 0;
  std::int64_t next_heartbeat_ns_ = 0;
};

}  // namespace tenon::hw

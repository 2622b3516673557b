#pragma once
// What an arm is: its state, and the first fault. It is told what was heard and what could not be
// sent, asks the joints' statuswords once a cycle, and sends nothing itself.
//
//   kUnconfigured --begin()--> kDisabled --enabled--> kEnabling --all enabled--> kEnabled
//                                  ^                                                |
//                                  +-- all off -- kStopping <-- disabled, quick stop-+
//   any --raise()--> kFault, until reset(). The first fault stays.
//
// Supervised: bus, heartbeat of every node, boot-ups and other NMT states of running nodes, EMCY,
// statuswords, feedback missing for more than kMissingCycles cycles in a row, the wrench for as
// many samples (hw/sensors/wrench_staleness.h), everything missing and our own frames refused for
// fewer.
//
// Real-time but for the constructor, no clock; one thread. Joints and counters outlive it.

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "hw/arm/arm_counters.h"
#include "hw/arm/joint_channel.h"
#include "hw/canopen/emergency.h"
#include "hw/canopen/heartbeat.h"
#include "hw/canopen/heartbeat_watch.h"
#include "hw/sensors/wrench_staleness.h"
#include "shared/canopen/drive_profile.h"
#include "shared/cell/robot.h"
#include "shared/ports/arm.h"
#include "shared/ports/can_bus.h"

namespace tenon::hw {

class ArmSupervision {
 public:
  static constexpr std::uint32_t kMissingCycles = 5;
  /// Without any answer at all, and with frames of our own that were refused. Fewer, so that the
  /// cause is named before what it leads to: drives that stand and then catch up with the command
  /// feel like a contact.
  static constexpr std::uint32_t kSilentCycles = 3;
  static constexpr std::uint32_t kRefusedCycles = 2;
  /// Of a joint's setpoints that never left, while one in a hundred may be so for ever.
  static constexpr double kUnsentMost = 5.0;
  static constexpr double kUnsentShare = 0.01;
  static constexpr std::int64_t kEnablingTimeout_ns = 2'000'000'000;

  ArmSupervision(const Robot& robot, std::span<const JointChannel> joints, ArmCounters& counters);

  [[nodiscard]] ArmState state() const noexcept { return state_; }
  [[nodiscard]] const ArmFault& fault() const noexcept { return fault_; }

  /// As before all configuration: no state, no fault.
  void reset() noexcept;
  /// All nodes are operational, and their silence counts from now.
  void begin(std::int64_t now_ns) noexcept;

  // Told as it happens.
  void raise(const ArmFault& fault) noexcept;
  void check_bus(const CanBusStatus& status) noexcept;
  /// A frame could not be sent because the bus is gone. @param status of that bus
  void bus_lost(const CanBusStatus& status) noexcept;
  /// A frame of this cycle found the transmit queue full.
  void frame_refused() noexcept {
    refused_ = true;
    ++refusals_;
  }
  /// It was this joint's setpoint. @param joint its place
  void setpoint_refused(std::size_t joint) noexcept { unsent_[joint] = true; }
  /// Beyond the limit: the drives stop, and are not enabled again before all are off.
  void force_exceeded(double force_N) noexcept;
  void take_heartbeat(const canopen::Heartbeat& heartbeat, std::int64_t now_ns) noexcept;
  void take_emergency(const canopen::Emergency& emergency) noexcept;
  /// This joint's drive waits in pre-operational since it has missed this master, and has lost
  /// nothing else; once for each of its heartbeats that say so.
  [[nodiscard]] bool take_missed_us(std::size_t joint) noexcept;
  /// Process data of another length than their mapping's. @param data_bytes that came
  void take_wrong_length(std::uint8_t node, std::uint8_t data_bytes) noexcept;

  // Once a cycle.
  void check_heartbeats(std::int64_t now_ns) noexcept;
  /// @param feedback of the cycle that has closed
  void check_feedback(const ArmFeedback& feedback) noexcept;
  /// What the joints are about to be told, m or rad.
  void check_setpoints(const JointVector& position) noexcept;
  /// After all of the cycle's frames. @param status of the bus: what it took and then dropped, too
  void check_sending(const CanBusStatus& status) noexcept;
  /// Holds the drives against what is asked, and goes on towards it.
  void advance(std::int64_t now_ns, ArmRequest wanted) noexcept;
  /// Once after force_exceeded(): the stop is to leave now.
  [[nodiscard]] bool take_stop() noexcept;
  /// Faults of the sensor's node are raised only where it is relied on.
  void rely_on_sensor(bool relied) noexcept { sensor_relied_on_ = relied; }
  /// The force for which all drives are stopped, N; 0: they are not.
  [[nodiscard]] double force_stopped_N() const noexcept { return force_stopped_N_; }
  /// What the drives are asked instead: in a fault, and beyond the limit of the force, they stop,
  /// and are not enabled.
  [[nodiscard]] ArmRequest granted(ArmRequest request) const noexcept;

 private:
  void enter_state(ArmState state, std::int64_t now_ns) noexcept;
  void check_drives(ArmRequest request) noexcept;
  void check_silence(const ArmFeedback& feedback) noexcept;
  void check_wrench(const ArmFeedback& feedback) noexcept;
  void check_unsent(bool dropped) noexcept;
  void enable(std::int64_t now_ns) noexcept;
  void note_left(const canopen::Heartbeat& heartbeat) noexcept;
  [[nodiscard]] std::size_t joint_of(std::uint8_t node) const noexcept;
  void forget_warning(const canopen::Emergency& emergency) noexcept;
  void raise_of_drive(ArmFaultKind kind, std::size_t joint) noexcept;
  void raise_missing(ArmFaultKind kind, std::uint8_t node, std::uint32_t cycles,
                     std::uint8_t wrong_length) noexcept;
  [[nodiscard]] bool all_enabled() const noexcept;
  [[nodiscard]] bool none_energised() const noexcept;

  const std::span<const JointChannel> joints_;
  const std::vector<DriveProfile> drives_;  ///< of the joints
  const std::uint8_t sensor_node_;
  const std::int64_t heartbeat_timeout_ns_;
  ArmCounters& counters_;

  ArmState state_ = ArmState::kUnconfigured;
  std::int64_t entered_ns_ = 0;
  bool was_enabled_ = false;  ///< since begin()
  ArmFault fault_;
  bool cause_guessed_ = false;  ///< its code is one that the drive had warned of
  bool sensor_relied_on_ = true;
  double force_stopped_N_ = 0.0;
  bool stop_due_ = false;
  canopen::HeartbeatWatch watch_;
  std::array<std::uint32_t, kMaxJoints> missing_cycles_{};  ///< in a row
  std::array<std::uint16_t, kMaxJoints> warned_{};          ///< last error code that only warned
  /// What a drive has said of why it has left operational.
  struct Departure {
    bool missed_us = false;  ///< it has missed our heartbeat
    bool reset = false;      ///< what it was told in bring-up is gone
    bool waits = false;      ///< in pre-operational, by its last heartbeat
  };
  std::array<Departure, kMaxJoints> departures_{};  ///< since begin()
  bool other_master_ = false;                       ///< has been heard since begin()
  WrenchStaleness wrench_;
  std::uint32_t silent_cycles_ = 0;   ///< in a row without any answer
  std::uint32_t refused_cycles_ = 0;  ///< in a row with a refused frame
  bool refused_ = false;              ///< in this cycle
  /// Per joint, and of the sensor behind them: 1 + the length of a frame that was dropped since the
  /// last good one.
  std::array<std::uint8_t, kMaxJoints + 1> wrong_length_{};
  std::optional<std::uint64_t> send_failures_;     ///< of the bus, as of the last cycle
  std::uint64_t refusals_ = 0;                     ///< of them, told as they happened
  std::array<bool, kMaxJoints> unsent_{};          ///< in this cycle
  std::array<double, kMaxJoints> unsent_level_{};  ///< leaky
};

}  // namespace tenon::hw

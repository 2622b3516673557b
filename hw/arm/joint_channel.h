#pragma once
// One joint's process data: frames to SI and back, and its drive's place in the state machine.
// Real-time, no clock, no I/O; one thread; owns its memory.
//
//   TPDO1 190h + i: | 0-1 u16 statusword  | 2-3 i16 effort, per mille | 4-7 i32 position, counts |
//   RPDO1 200h + n: | 0-1 u16 controlword | 2-5 i32 target, counts    |
//
// and where targets are packed, n being the node of the first of two joints (the last of an odd
// number of joints has a frame of four bytes for itself)
//
//   RPDO1 200h + n: | 0-3 i32 target of the first, counts | 4-7 i32 target of the second |
//   RPDO2 300h + n: | 0-1 u16 controlword | of each node n, acts when it arrives

#include <cstdint>
#include <optional>

#include "hw/arm/braking_watch.h"
#include "hw/cia402/drive_state.h"
#include "shared/cell/robot.h"
#include "shared/ports/arm.h"
#include "shared/ports/can_bus.h"

namespace tenon::hw {

class JointChannel {
 public:
  /// More than a stop and a brake take, and less than the executor waits for drives to be off.
  static constexpr double kStopPatience_s = 1.0;

  JointChannel() = default;
  /// @param cycle_us from one update() to the next
  JointChannel(const Joint& joint, std::uint32_t cycle_us);

  /// As after a reset of the drive.
  void reset();

  /// False: not 8 bytes, dropped.
  [[nodiscard]] bool take_feedback(const CanFrame& frame);
  /// Once a cycle. Target and controlword for what is asked: `setpoint` (m or rad) once the whole
  /// arm is enabled, before that the actual position. False: the setpoint is no number, the last
  /// target stays.
  ///
  /// A drive in its quick stop that is to be disabled goes on ramping down and closes its brake by
  /// itself; disable voltage would let the axis go before. The same for a drive that may be on and
  /// did not answer in this cycle. What is not off after kStopPatience_s loses its voltage all the
  /// same, and an axis that runs_on() at once: its brake is what can still stop it.
  [[nodiscard]] bool update(ArmRequest request, bool follow, double setpoint);
  /// Whether a setpoint (m or rad) is a number, in counts too.
  [[nodiscard]] bool is_target(double setpoint) const;
  /// RPDO1 with both.
  [[nodiscard]] CanFrame command_frame() const;
  /// RPDO1 of packed targets. @param second of the pair, nullptr where there is none
  [[nodiscard]] CanFrame targets_frame(const JointChannel* second) const;
  /// RPDO2: empty where the drive was sent this controlword and has obeyed. So a change leaves at
  /// once, and what was lost on the way is repeated every cycle.
  [[nodiscard]] std::optional<CanFrame> due_controlword_frame();

  [[nodiscard]] std::uint8_t node() const { return node_; }
  [[nodiscard]] bool seen() const { return seen_; }  ///< since reset()
  [[nodiscard]] double position() const;             ///< m or rad
  [[nodiscard]] double effort() const;               ///< N or Nm
  [[nodiscard]] std::uint16_t statusword() const { return statusword_; }
  [[nodiscard]] cia402::DriveState state() const { return cia402::decode_statusword(statusword_); }
  /// Whether the drive has been in operation enabled since it was last asked to be so.
  [[nodiscard]] bool reached_enabled() const { return reached_enabled_; }
  /// Told to stop, its drive does not brake.
  [[nodiscard]] bool runs_on() const { return braking_.runs_on(); }

 private:
  std::uint8_t node_ = 0;
  bool interpolated_ = false;
  double counts_per_unit_ = 1.0;
  double zero_counts_ = 0.0;
  double rated_effort_ = 0.0;
  int stop_patience_ = 0;  ///< cycles
  BrakingWatch braking_;

  void watch_braking(ArmRequest request);
  [[nodiscard]] std::uint16_t next_controlword(ArmRequest request);

  bool seen_ = false;
  bool answered_ = false;  ///< since the last update()
  int stop_cycles_ = 0;    ///< in a row that it is left to its quick stop
  ArmRequest request_ = ArmRequest::kDisabled;
  std::optional<std::uint16_t> sent_controlword_;  ///< by RPDO2
  bool reached_enabled_ = false;
  std::uint16_t statusword_ = 0;
  std::uint16_t controlword_ = 0;
  std::int32_t position_counts_ = 0;
  std::int32_t target_counts_ = 0;
  std::int16_t effort_permille_ = 0;
};

}  // namespace tenon::hw

#pragma once
// One joint's process data: frames to SI and back, and its drive's place in the state machine.
// Real-time, no clock, no I/O; one thread; owns its memory.
//
//   TPDO1 190h + i: | 0-1 u16 statusword  | 2-5 i32 position, counts | 6-7 i16 effort, per mille |
//   RPDO1 200h + n: | 0-1 u16 controlword | 2-5 i32 target, counts   |

#include <cstddef>
#include <cstdint>

#include "hw/cia402/drive_state.h"
#include "shared/cell/robot.h"
#include "shared/ports/arm.h"
#include "shared/ports/can_bus.h"

namespace tenon::hw {

class JointChannel {
 public:
  JointChannel() = default;
  /// @param index 0.. in the robot's order
  JointChannel(const Joint& joint, std::size_t index);

  /// As after a reset of the drive.
  void reset();

  /// False: not 8 bytes, dropped.
  [[nodiscard]] bool take_feedback(const CanFrame& frame);
  /// The RPDO for what is asked: with `setpoint` (m or rad) once the whole arm is enabled, before
  /// that with the actual position. A setpoint that is no number keeps the last target and clears
  /// `valid`.
  [[nodiscard]] CanFrame command(ArmRequest request, bool follow, double setpoint, bool& valid);

  [[nodiscard]] std::uint8_t node() const { return node_; }
  [[nodiscard]] std::uint32_t feedback_cob_id() const { return feedback_cob_id_; }
  [[nodiscard]] bool seen() const { return seen_; }  ///< since reset()
  [[nodiscard]] double position() const;             ///< m or rad
  [[nodiscard]] double effort() const;               ///< N or Nm
  [[nodiscard]] std::uint16_t statusword() const { return statusword_; }
  [[nodiscard]] cia402::DriveState state() const { return cia402::decode_statusword(statusword_); }
  /// Whether the drive has been in operation enabled since it was last asked to be so.
  [[nodiscard]] bool reached_enabled() const { return reached_enabled_; }

  std::uint32_t missing_cycles = 0;  ///< in a row, kept by CanopenArm

 private:
  std::uint8_t node_ = 0;
  std::uint32_t feedback_cob_id_ = 0;
  bool interpolated_ = false;
  double counts_per_unit_ = 1.0;
  double zero_counts_ = 0.0;
  double rated_effort_ = 0.0;

  bool seen_ = false;
  bool reached_enabled_ = false;
  std::uint16_t statusword_ = 0;
  std::uint16_t controlword_ = 0;
  std::int32_t position_counts_ = 0;
  std::int32_t target_counts_ = 0;
  std::int16_t effort_permille_ = 0;
};

}  // namespace tenon::hw

#pragma once
// Which identifiers Tenon gives to the process data of an arm. The lower the identifier, the
// earlier the frame wins the bus:
//
//   | COB-ID     | frame                                            |
//   | 181h       | force, first because contact is decided from it  |
//   | 182h       | torque                                           |
//   | 183h       | controlword of all drives at once, acts when it arrives |
//   | 190h + i   | TPDO1 of joint i = 0, 1, ...: what it does       |
//   | 200h + n   | RPDO1 of node n, as predefined: what it shall do |
//   | 300h + n   | RPDO2 of node n, as predefined: controlword      |
//
// RPDO2 is used where targets are packed: then 200h + n, with the node of the first of two joints,
// carries the targets of both, and no controlword.
//
// A drive whose identifiers are fixed keeps 180h + n for its TPDO1. Other joints leave their
// predefined 180h + n because nodes 1 and 2 would meet the force/torque frames there. SYNC, EMCY,
// SDO, NMT and heartbeat are as predefined by CiA 301.

#include <cstddef>
#include <cstdint>

#include "shared/canopen/constants.h"
#include "shared/canopen/robot_drives.h"
#include "shared/cell/robot.h"

namespace tenon::hw {

inline constexpr std::uint32_t kForceCobId = 0x181;
inline constexpr std::uint32_t kTorqueCobId = 0x182;
inline constexpr std::uint32_t kStopCobId = 0x183;
inline constexpr std::uint32_t kJointFeedbackCobId = 0x190;

/// @param joint its place in the robot's order
[[nodiscard]] inline std::uint32_t joint_feedback_cob_id(const Robot& robot, std::size_t joint) {
  const Joint& it = robot.joints[joint];
  if (canopen_drive(it).profile.fixed_identifiers) return tenon::canopen::kTpdo1 + it.node;
  return kJointFeedbackCobId + static_cast<std::uint32_t>(joint);
}
[[nodiscard]] constexpr std::uint32_t joint_command_cob_id(std::uint8_t node) {
  return tenon::canopen::kRpdo1 + node;
}
[[nodiscard]] constexpr std::uint32_t joint_controlword_cob_id(std::uint8_t node) {
  return tenon::canopen::kRpdo2 + node;
}

}  // namespace tenon::hw

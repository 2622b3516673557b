#pragma once
// What each node of an arm is configured to, as a list that bring-up writes and reads back. Set-up
// code, allocates, pure.

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "hw/canopen/object_setting.h"
#include "shared/canopen/drive_profile.h"
#include "shared/cell/robot.h"

namespace tenon::hw {

/// How long a node may take from NMT reset to its boot-up message.
[[nodiscard]] double boot_s(const Robot& robot, std::uint8_t node);

/// The first setting of every node, because bring-up needs to hear it: heartbeat producer time.
[[nodiscard]] canopen::ObjectSetting heartbeat_setting(const Robot& robot);

/// Whether a drive's PDOs can be set, so that one of them takes the stop of all drives.
[[nodiscard]] bool takes_stop(const DriveProfile& drive);

/// @param index of the joint in the robot's order
[[nodiscard]] std::vector<canopen::ObjectSetting> joint_settings(const Robot& robot,
                                                                 std::size_t index);
[[nodiscard]] std::vector<canopen::ObjectSetting> sensor_settings(const Robot& robot);

/// 60C2h for a SYNC period: value * 10^exponent seconds. Empty where no u8 value fits.
struct InterpolationPeriod {
  std::uint8_t value = 0;
  std::int8_t exponent = 0;
};
[[nodiscard]] std::optional<InterpolationPeriod> interpolation_period(std::uint32_t cycle_us);

/// Throws InputError with one line where the robot cannot be driven: no joint or too many, a node
/// outside 1..127 or used twice, a period that 60C2h cannot hold, gears or times that are not
/// positive, a master heartbeat slower than half its timeout, targets that no frame holds, drives
/// whose fixed PDOs do not go with the others, an identifier of the sensor that is another's.
void check_robot(const Robot& robot);

}  // namespace tenon::hw

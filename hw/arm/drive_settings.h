#pragma once
// The objects of a drive beyond its PDOs, as its profile allows to set them, and what a cell must
// know where it does not. Set-up code, allocates, pure.

#include <cstdint>
#include <string>
#include <vector>

#include "hw/canopen/object_setting.h"
#include "shared/canopen/drive_profile.h"
#include "shared/cell/robot.h"

namespace tenon::hw {

/// What Tenon wants an object to hold.
[[nodiscard]] std::uint32_t wanted_value(const Robot& robot, const Joint& joint,
                                         DriveObject object);

/// Appends objects first..last in the order of the enumeration.
void append_drive_objects(std::vector<canopen::ObjectSetting>& settings, const Robot& robot,
                          const Joint& joint, DriveObject first, DriveObject last);

/// The device's own objects that its profile sets.
void append_extra_objects(std::vector<canopen::ObjectSetting>& settings, const Joint& joint);

/// One line for each thing that matters and that a robot's drives cannot be told: what follows, and
/// what the cell has to provide. Empty for drives by the book.
[[nodiscard]] std::vector<std::string> drive_remarks(const Robot& robot);

}  // namespace tenon::hw

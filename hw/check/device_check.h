#pragma once
// What bring-up would do to a drive of which there is only its description file, and what that says
// to each object. Without a bus. Set-up code, allocates, pure.

#include <cstddef>
#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "hw/canopen/object_setting.h"
#include "shared/cell/robot.h"
#include "shared/eds/device_file.h"

namespace tenon::hw {

/// One object of bring-up.
struct CheckLine {
  enum class Verdict : std::uint8_t {
    kGood,     ///< done, or left out as the profile allows
    kOther,    ///< the device keeps another value, which is taken
    kUnknown,  ///< the file does not say
    kRefused,  ///< bring-up ends here
  };
  canopen::ObjectSetting setting;
  std::string device;  ///< what it has and does
  Verdict verdict = Verdict::kUnknown;
};

/// The settings of a joint in the order of bring-up. @param file nullptr: none is known
[[nodiscard]] std::vector<CheckLine> check_joint(const Robot& robot, std::size_t joint,
                                                 const DeviceFile* file);

struct CheckReport {
  std::string text;  ///< for people, several lines
  bool good = true;  ///< nothing is refused, and the frames fit the bus
};

/// Every joint, the bus, what cannot be set, and the verdict. Throws InputError where check_robot()
/// does. @param files by node
[[nodiscard]] CheckReport check_report(const Robot& robot,
                                       const std::map<std::uint8_t, DeviceFile>& files);

}  // namespace tenon::hw

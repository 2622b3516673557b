#pragma once
// What this cell lets nobody notice, for people.

#include <string>

#include "shared/base/text.h"
#include "shared/cell/cell.h"

namespace tenon::executor {

/// A line, or nothing where a tare is compared with what the sensor is known to read of itself. Its
/// bias may be many times the payload's weight, so that this alone says nothing of a tare.
[[nodiscard]] inline std::string unnoticed_while_taring(const Cell& cell) {
  if (cell.joint_torque || cell.sensor_bias) return {};
  return format(
      "cell '%s' has no sensor_bias: nobody notices what pushes while the sensor is tared, nor a "
      "sensor of another unit; --identify-payload prints one\n",
      cell.name.c_str());
}

}  // namespace tenon::executor

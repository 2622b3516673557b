#pragma once
// What faults of a force/torque sensor are called when the box demo meets them, and how soon.

#include <string>
#include <vector>

#include "shared/cell/cell.h"

namespace tenon::tests {

struct SensorFault {
  std::string spec;  ///< "stale-force"; begins at 4 s, in the midst of the plan
  std::string name;  ///< as the table of faults has it: "arm_fault: sensor_stale"
  std::string says;  ///< a part of the line for people
};

/// Expects each to end the shared plan for this cell by its name, within its bound of the table of
/// faults, with the arm braked.
void expect_sensor_faults(const Cell& cell, const std::vector<SensorFault>& faults);

}  // namespace tenon::tests

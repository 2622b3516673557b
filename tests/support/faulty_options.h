#pragma once
// Whole runs of the box task with things going wrong.

#include <string>
#include <vector>

#include "tests/support/whole_run.h"

namespace tenon::tests {

/// Start 1 of the box task, the table 10 mm off along x and y, with faults as tenon-sim --fault
/// takes them.
[[nodiscard]] WholeRun::Options with_faults(const std::vector<std::string>& specs);

}  // namespace tenon::tests

#pragma once
// The starts of a task file, and how wrong their poses may be. Offline; throws InputError.

#include <vector>

#include "shared/config/yaml_value.h"
#include "shared/task/task.h"

namespace tenon::config {

/// [x, y, rz] as a mask.
[[nodiscard]] CoordinateMask read_axes(const Value& value);

/// All starts, whose keys say how errors are distributed: the first one's for all. After the goal
/// and the search coordinates.
void read_starts(const Value& value, const Value& goal, Task& task);

/// How far the errors that a plan has to hold reach. After the starts.
void read_reach(const Map& task_file, Task& task);

}  // namespace tenon::config

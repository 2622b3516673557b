#pragma once
// A corner of what a task leaves open, as the world of all runs: where plans fail that are judged
// by even draws alone. Pure; any thread.

#include <string>
#include <vector>

#include "shared/experiment/world_ranges.h"
#include "shared/task/task.h"

namespace tenon::sim {

/// "low,drawn", "low,largest", "high,drawn", "high,largest": friction, and the size of the held
/// part.
[[nodiscard]] const std::vector<std::string>& corner_names();

/// The ranges with friction at that end of the task's range, and with every size of the held part
/// as drawn or larger by the task's oversize_m; nothing else of them changes but the name.
/// @throws InputError for another name, and for the largest part of a task that knows none
[[nodiscard]] WorldRanges at_corner(WorldRanges ranges, const std::string& corner,
                                    const Task& task);

}  // namespace tenon::sim

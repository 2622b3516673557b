#pragma once
// Where the environment really stands: a draw from a start's uncertainty, or as it was told.
// Offline.

#include <cstdint>
#include <string>

#include "shared/task/task.h"

namespace tenon::sim {

/// Displacement of the environment in task axes, m and rad: independent draws with the start's
/// standard deviations, normal or uniform as the task says, zero off the search coordinates. The
/// same on every platform.
[[nodiscard]] Vector6 draw_offset(const Task& task, const Start& start, std::uint64_t seed);

/// "x_m=0.02,y_m=-0.01": axes x_m y_m z_m rx_rad ry_rad rz_rad, each at most once.
/// @throws InputError for anything else, and for axes that are no search coordinates of the task
[[nodiscard]] Vector6 parse_offset(const std::string& text, CoordinateMask coordinates);

}  // namespace tenon::sim

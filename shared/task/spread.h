#pragma once
// How far out a start is, for either distribution of its errors.

#include <string>

#include "shared/task/task.h"

namespace tenon {

/// In standard deviations: Mahalanobis' distance of normal errors; of uniform ones that of the
/// coordinate that is farthest out. An offset is within the plan's promise where that is at most
/// task.particle_sigmas. @param offset m or rad; what has no standard deviation does not count
[[nodiscard]] double sigmas_out(const Task& task, const Start& start, const Vector6& offset);

/// How far drawn starts go, in standard deviations: one farther than the promise, or to the bounds.
[[nodiscard]] double drawn_sigmas(const Task& task);

/// "3 standard deviations out", "at the bounds".
[[nodiscard]] std::string reach_text(const Task& task);

/// Of a start: "1.73 sigma out", "at 87 % of the bounds".
[[nodiscard]] std::string out_text(const Task& task, double sigmas);

/// The task file's key of a coordinate's error, "sigma_m" or "uniform_rad", and what it says there.
[[nodiscard]] const char* error_key(const Task& task, int axis);
[[nodiscard]] double stated_error(const Task& task, const Start& start, int axis);

/// "within 3 sigma", "within the bounds".
[[nodiscard]] std::string within_text(const Task& task, double sigmas);

}  // namespace tenon

#pragma once
// A task's shapes as the pages read them; page/README.md has the keys. Pure; any thread.

#include <string>

#include "shared/math/pose.h"
#include "shared/plan/plan.h"
#include "shared/task/task.h"

namespace tenon::drawing {

/// One JSON object: held part and environment as triangles, meshes decimated so that all of them
/// together fit a page.
[[nodiscard]] std::string scene_json(const Task& task);

/// One JSON array of what views_of() says.
[[nodiscard]] std::string views_json(CoordinateMask coordinates);

/// "[x, y, z, qw, qx, qy, qz]", m, to a hundredth of a millimetre.
[[nodiscard]] std::string pose_json(const Pose& pose);

}  // namespace tenon::drawing

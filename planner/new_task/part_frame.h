#pragma once
// The axes of a task for two parts. Pure; any thread.

#include <Eigen/Geometry>

#include "shared/geometry/triangle_mesh.h"
#include "shared/math/pose.h"

namespace tenon::planner {

/// In the frame of the socket's file. z is the way out. x and y go straight out of as much of the
/// parts' flat sides as can be, whatever axes their files have: a push along them presses a side
/// flat. Where nothing is won by that, as with round parts, they are what is left of the file's own
/// axes.
/// @param plug as it stands assembled  @param plug_turn of the plug's file in the socket's
/// @param way a unit vector
[[nodiscard]] Eigen::Quaterniond part_frame(const Vector3& way, const TriangleMesh& plug,
                                            const Eigen::Quaterniond& plug_turn,
                                            const TriangleMesh& socket);

}  // namespace tenon::planner

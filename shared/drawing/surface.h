#pragma once
// Shapes as triangles, for pictures in space: as coarse as a screen allows. Pure; any thread.

#include <cstddef>

#include "shared/geometry/triangle_mesh.h"
#include "shared/task/task.h"

namespace tenon::drawing {

/// The shape's surface in the frame that its pose is in, facing outwards.
/// @param round_sides of a cylinder, >= 3  @param triangles_max of a solid, see decimated()
[[nodiscard]] TriangleMesh surface_of(const Shape& shape, int round_sides,
                                      std::size_t triangles_max);

/// A mesh of at most so many triangles (>= 1) that looks like it: points in one cell of a cubic
/// grid become their mean (vertex clustering; Rossignac and Borrel, "Multi-resolution 3D
/// approximations for rendering complex scenes", 1993). For pictures alone: it may be open or touch
/// itself.
[[nodiscard]] TriangleMesh decimated(const TriangleMesh& mesh, std::size_t triangles_max);

}  // namespace tenon::drawing

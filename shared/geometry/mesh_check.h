#pragma once
// Whether triangles enclose a body. Offline; throws InputError that says what is wrong with the
// surface, where, how much of it, and what to do.

#include "shared/geometry/triangle_mesh.h"

namespace tenon {

/// Refuses a mesh, its equal points already one, that is empty, larger than 100 m, made of
/// triangles too thin to have a side, open, of more than two triangles at an edge, turned about in
/// part or as a whole, pinched in a point, in itself, or through itself.
void check_mesh(const TriangleMesh& mesh);

}  // namespace tenon

#pragma once
// STL and OBJ files as triangles. Pure; throws InputError that says where in the file it stumbled.

#include <string_view>

#include "shared/geometry/triangle_mesh.h"

namespace tenon {

/// An STL file, binary or ASCII: told apart by the length that a binary file's own count of
/// triangles demands. Normals, colours and names are passed over: the order of a triangle's corners
/// says which side is outside.
/// @param scale_m what the file's unit measures, m
[[nodiscard]] TriangleMesh read_stl(std::string_view bytes, double scale_m);

/// A Wavefront OBJ file: `v` and `f`, the corners of a face by positive or negative index, with or
/// without texture and normal. A face with more than three corners must be flat and convex. Names,
/// groups, materials, normals, texture places, lines and points are passed over.
[[nodiscard]] TriangleMesh read_obj(std::string_view text, double scale_m);

}  // namespace tenon

#pragma once
// The parts of the tasks that ship with meshes, made from numbers: what lies in planner/tasks/parts
// is what this writes.

#include <map>
#include <string>

#include "shared/geometry/triangle_mesh.h"

namespace tenon::tests {

/// By the file's name: a round peg with a key along it, and the block that it goes into; the plug
/// of a mains lead, and the inlet that it goes into.
[[nodiscard]] std::map<std::string, TriangleMesh> example_parts();

}  // namespace tenon::tests

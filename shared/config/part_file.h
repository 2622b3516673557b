#pragma once
// A part's own file, an STL or an OBJ, before any task names it. Offline; throws InputError.

#include <filesystem>
#include <memory>
#include <string>

#include "shared/geometry/solid.h"
#include "shared/geometry/triangle_mesh.h"

namespace tenon::config {

/// By what the file's name ends in, checked (mesh_check.h).
/// @param scale_m what the file's unit measures, m  @throws InputError without the file's name
[[nodiscard]] TriangleMesh parse_part(const std::filesystem::path& file, const std::string& bytes,
                                      double scale_m);

struct PartFile {
  std::shared_ptr<const Solid> solid;
  double scale_m = 1.0;      ///< what the file's unit must be
  double longest_raw = 0.0;  ///< the longest side of the box around it, in the file's numbers
};
/// No such file says its unit. A part that measures 1 or more is taken to be in millimetres, any
/// other in metres: hands and arms assemble what lies between a millimetre and a metre.
[[nodiscard]] PartFile load_part(const std::filesystem::path& file);

}  // namespace tenon::config

#pragma once
// The connected pieces of a surface whose every edge has two triangles. Pure.

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "shared/geometry/triangle_mesh.h"

namespace tenon {

struct Shell {
  std::uint32_t point = 0;  ///< one of its points
  double volume_m3 = 0.0;   ///< negative where its triangles face inwards
  int depth = 0;  ///< so many others are around it, hollows counted against it: 0 in the open, 1 in
                  ///< the flesh of a part
};

[[nodiscard]] std::vector<Shell> shells_of(const TriangleMesh& mesh);

/// A point whose triangles do not all hang together by edges at it.
[[nodiscard]] std::optional<std::uint32_t> pinched_point(const TriangleMesh& mesh);

}  // namespace tenon

// A mesh file of arbitrary bytes. The first byte says whether it is read as STL or as OBJ.

#include "shared/geometry/mesh_file.h"

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <string_view>

#include "shared/geometry/mesh_check.h"
#include "shared/geometry/solid.h"
#include "tests/fuzz/support/refused.h"

// NOLINTNEXTLINE(readability-identifier-naming): libFuzzer's name
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace tenon;
  if (size == 0) return 0;
  const std::string_view bytes = fuzz::text_of(data + 1, size - 1);
  TriangleMesh mesh;
  const bool closed = fuzz::accepted([&] {
    mesh = data[0] == 'o' ? read_obj(bytes, 1e-3) : read_stl(bytes, 1e-3);
    check_mesh(mesh);
  });
  if (!closed) return 0;
  const Solid solid(mesh);
  fuzz::must(solid.size_m().allFinite() && (solid.size_m().array() > 0.0).all(),
             "a body has a size");
  // No place is farther from the surface than a corner is.
  const Vector3 far_m = solid.size_m() * 2.0;
  const Solid::Place place = solid.place(far_m);
  fuzz::must(std::isfinite(place.distance_m) && place.distance_m > 0.0 &&
                 place.distance_m <= (far_m - solid.mesh().points_m.front()).norm() * (1.0 + 1e-9),
             "a place beside a body has its distance");
  return 0;
}

#include "shared/config/part_file.h"

#include <algorithm>
#include <utility>

#include "shared/base/error.h"
#include "shared/config/files.h"
#include "shared/geometry/mesh_check.h"
#include "shared/geometry/mesh_file.h"
#include "shared/geometry/mesh_needles.h"

namespace tenon::config {
namespace {

constexpr double kMillimetre_m = 1e-3;

TriangleMesh read_part(const std::filesystem::path& file, const std::string& bytes,
                       double scale_m) {
  std::string kind = file.extension().string();
  for (char& c : kind) c = static_cast<char>(c >= 'A' && c <= 'Z' ? c - 'A' + 'a' : c);
  if (kind == ".stl") return read_stl(bytes, scale_m);
  if (kind == ".obj") return read_obj(bytes, scale_m);
  throw InputError("must be an STL or OBJ file: its name must end in .stl or .obj");
}

double longest_side(const TriangleMesh& mesh) {
  if (mesh.points_m.empty()) return 0.0;
  Vector3 low = mesh.points_m.front();
  Vector3 high = low;
  for (const Vector3& point : mesh.points_m) {
    low = low.cwiseMin(point);
    high = high.cwiseMax(point);
  }
  return (high - low).maxCoeff();
}

}  // namespace

TriangleMesh parse_part(const std::filesystem::path& file, const std::string& bytes,
                        double scale_m) {
  TriangleMesh mesh = without_needles(read_part(file, bytes, scale_m));
  check_mesh(mesh);
  return mesh;
}

PartFile load_part(const std::filesystem::path& file) {
  const std::string bytes = read_file(file);
  PartFile part;
  try {
    part.longest_raw = longest_side(read_part(file, bytes, 1.0));
    part.scale_m = part.longest_raw >= 1.0 ? kMillimetre_m : 1.0;
    part.solid = std::make_shared<const Solid>(parse_part(file, bytes, part.scale_m));
  } catch (const InputError& error) {
    throw InputError(file.string() + ": " + error.what());
  }
  return part;
}

}  // namespace tenon::config

#include <cmath>
#include <cstring>
#include <string>

#include "shared/base/error.h"
#include "shared/geometry/mesh_file.h"
#include "shared/geometry/text_lines.h"

namespace tenon {
namespace {

constexpr std::size_t kHeader_bytes = 84;    // a comment of 80, then the number of triangles
constexpr std::size_t kTriangle_bytes = 50;  // normal, three corners, two bytes for colours

std::uint32_t word_at(std::string_view bytes, std::size_t at) {
  std::uint32_t word = 0;
  for (std::size_t i = 0; i < 4; ++i) {
    word |= static_cast<std::uint32_t>(static_cast<std::uint8_t>(bytes[at + i])) << (8 * i);
  }
  return word;
}

double float_at(std::string_view bytes, std::size_t at) {
  const std::uint32_t word = word_at(bytes, at);
  float value = 0.0F;
  std::memcpy(&value, &word, sizeof value);
  return static_cast<double>(value);
}

[[noreturn]] void refuse_count(std::size_t count) {
  throw InputError("has " + std::to_string(count) + " triangles, must be at most " +
                   std::to_string(TriangleMesh::kTrianglesMax) +
                   ": export it with a coarser tolerance");
}

/// Three corners as they stand, the points not yet shared.
void add(TriangleMesh& mesh, const std::array<Vector3, 3>& corners_m) {
  if (mesh.triangles.size() == TriangleMesh::kTrianglesMax) refuse_count(mesh.triangles.size() + 1);
  const auto first = static_cast<std::uint32_t>(mesh.points_m.size());
  mesh.points_m.insert(mesh.points_m.end(), corners_m.begin(), corners_m.end());
  mesh.triangles.push_back({first, first + 1, first + 2});
}

TriangleMesh read_binary(std::string_view bytes, double scale_m) {
  const std::size_t count = word_at(bytes, kHeader_bytes - 4);
  if (count > TriangleMesh::kTrianglesMax) refuse_count(count);
  const std::size_t wanted = kHeader_bytes + kTriangle_bytes * count;
  if (bytes.size() != wanted) {
    throw InputError("has " + std::to_string(bytes.size()) + " bytes, its " +
                     std::to_string(count) + " triangles need " + std::to_string(wanted) +
                     (bytes.size() < wanted ? ": it is truncated, export it again"
                                            : ": it is damaged, export it again"));
  }
  TriangleMesh mesh;
  for (std::size_t i = 0; i < count; ++i) {
    std::array<Vector3, 3> corners_m;
    for (std::size_t j = 0; j < 9; ++j) {
      const double value =
          float_at(bytes, kHeader_bytes + kTriangle_bytes * i + 12 + 4 * j) * scale_m;
      if (!std::isfinite(value)) {
        throw InputError("triangle " + std::to_string(i) +
                         ": a coordinate is not a finite number: export it again");
      }
      corners_m[j / 3][static_cast<Eigen::Index>(j % 3)] = value;
    }
    add(mesh, corners_m);
  }
  return mesh;
}

class AsciiStl {
 public:
  AsciiStl(std::string_view text, double scale_m) : lines_(text), scale_m_(scale_m) {}

  [[nodiscard]] TriangleMesh read() {
    while (next()) {
      if (is("solid")) continue;
      if (is("endsolid")) {
        ended_ = true;
        continue;
      }
      ended_ = false;
      if (!is("facet")) {
        lines_.refuse("'" + std::string(words_.front()) +
                      "' must be solid, facet or endsolid: is this an STL file?");
      }
      read_facet();
    }
    if (!ended_) lines_.refuse("the file ends before endsolid: it is truncated, export it again");
    return std::move(mesh_);
  }

 private:
  bool next() {
    while (lines_.next(words_)) {
      if (!words_.empty()) return true;
    }
    return false;
  }

  [[nodiscard]] bool is(std::string_view first) const { return words_.front() == first; }

  void expect(std::string_view first) {
    if (!next()) lines_.refuse("the file ends within a facet: it is truncated, export it again");
    if (!is(first)) {
      lines_.refuse("'" + std::string(words_.front()) + "' must be " + std::string(first));
    }
  }

  void read_facet() {
    expect("outer");
    std::array<Vector3, 3> corners_m;
    for (Vector3& corner_m : corners_m) {
      expect("vertex");
      if (words_.size() != 4) lines_.refuse("a vertex must have three numbers");
      for (std::size_t axis = 0; axis < 3; ++axis) {
        corner_m[static_cast<Eigen::Index>(axis)] = lines_.number_of(words_[axis + 1]) * scale_m_;
      }
    }
    expect("endloop");
    expect("endfacet");
    add(mesh_, corners_m);
  }

  TextLines lines_;
  double scale_m_;
  std::vector<std::string_view> words_;
  TriangleMesh mesh_;
  bool ended_ = false;
};

}  // namespace

TriangleMesh read_stl(std::string_view bytes, double scale_m) {
  const bool long_enough = bytes.size() >= kHeader_bytes;
  const bool exact =
      long_enough &&
      bytes.size() == kHeader_bytes + kTriangle_bytes * static_cast<std::size_t>(
                                                            word_at(bytes, kHeader_bytes - 4));
  // Binary files may begin with "solid" too; text holds no zero byte.
  const bool text = !exact && bytes.find('\0') == std::string_view::npos &&
                    bytes.find("solid") != std::string_view::npos;
  if (text) return welded(AsciiStl(bytes, scale_m).read());
  if (!long_enough) {
    throw InputError("has " + std::to_string(bytes.size()) +
                     " bytes, an STL file at least 84: it is truncated or no STL file");
  }
  return welded(read_binary(bytes, scale_m));
}

}  // namespace tenon

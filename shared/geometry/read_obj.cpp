#include <algorithm>
#include <array>
#include <charconv>
#include <string>

#include "shared/geometry/mesh_file.h"
#include "shared/geometry/text_lines.h"

namespace tenon {
namespace {

constexpr std::size_t kPointsMax = 4 * TriangleMesh::kTrianglesMax;
constexpr std::array<std::string_view, 13> kPassedOver = {
    "vn", "vt",     "vp",     "g",      "o",      "s",         "l",
    "p",  "usemtl", "mtllib", "maplib", "usemap", "shadow_obj"};

class Obj {
 public:
  Obj(std::string_view text, double scale_m) : lines_(text), scale_m_(scale_m) {}

  [[nodiscard]] TriangleMesh read() {
    while (lines_.next(words_)) {
      if (words_.empty()) continue;
      if (words_.front() == "v") {
        read_point();
      } else if (words_.front() == "f") {
        read_face();
      } else if (std::find(kPassedOver.begin(), kPassedOver.end(), words_.front()) ==
                 kPassedOver.end()) {
        lines_.refuse("'" + std::string(words_.front()) +
                      "' is no keyword of an OBJ file's polygons: is this an OBJ file?");
      }
    }
    return std::move(mesh_);
  }

 private:
  void read_point() {
    // Some programs put a weight or a colour behind the place.
    if (words_.size() < 4) lines_.refuse("a vertex must have three numbers");
    if (mesh_.points_m.size() == kPointsMax) {
      lines_.refuse("more than " + std::to_string(kPointsMax) +
                    " vertices: export it with a coarser tolerance");
    }
    const double x = lines_.number_of(words_[1]);
    const double y = lines_.number_of(words_[2]);
    const double z = lines_.number_of(words_[3]);
    mesh_.points_m.emplace_back(x * scale_m_, y * scale_m_, z * scale_m_);
  }

  [[nodiscard]] std::uint32_t corner_of(std::string_view word) const {
    const std::string_view digits = word.substr(0, word.find('/'));
    long index = 0;
    const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), index);
    const auto count = static_cast<long>(mesh_.points_m.size());
    if (error != std::errc() || end != digits.data() + digits.size() || index == 0 ||
        index > count || index < -count) {
      lines_.refuse("corner '" + std::string(word) + "' of a face must name one of the " +
                    std::to_string(count) + " vertices before it");
    }
    return static_cast<std::uint32_t>(index > 0 ? index - 1 : count + index);
  }

  void read_face() {
    std::vector<std::uint32_t> corners;
    for (std::size_t i = 1; i < words_.size(); ++i) corners.push_back(corner_of(words_[i]));
    if (corners.size() < 3) lines_.refuse("a face must have three corners or more");
    if (corners.size() > 3) check_convex(corners);
    for (std::size_t i = 2; i < corners.size(); ++i) {
      if (mesh_.triangles.size() == TriangleMesh::kTrianglesMax) {
        lines_.refuse("more than " + std::to_string(TriangleMesh::kTrianglesMax) +
                      " triangles: export it with a coarser tolerance");
      }
      mesh_.triangles.push_back({corners[0], corners[i - 1], corners[i]});
    }
  }

  /// A fan of triangles stands for the face only then.
  void check_convex(const std::vector<std::uint32_t>& corners) const {
    const auto at = [&](std::size_t i) { return mesh_.points_m[corners[i % corners.size()]]; };
    Vector3 area_m2 = Vector3::Zero();
    for (std::size_t i = 1; i + 1 < corners.size(); ++i) {
      area_m2 += (at(i) - at(0)).cross(at(i + 1) - at(0));
    }
    const double size_m2 = area_m2.norm();
    for (std::size_t i = 0; i < corners.size(); ++i) {
      const Vector3 turn_m2 = (at(i + 1) - at(i)).cross(at(i + 2) - at(i + 1));
      constexpr double kFlat = 1e-3;
      if (turn_m2.dot(area_m2) < -kFlat * size_m2 * turn_m2.norm() ||
          std::abs((at(i) - at(0)).dot(area_m2)) > kFlat * size_m2 * std::sqrt(size_m2)) {
        lines_.refuse("a face of " + std::to_string(corners.size()) +
                      " corners is not flat and convex: export triangles");
      }
    }
  }

  TextLines lines_;
  double scale_m_;
  std::vector<std::string_view> words_;
  TriangleMesh mesh_;
};

}  // namespace

TriangleMesh read_obj(std::string_view text, double scale_m) {
  return welded(Obj(text, scale_m).read());
}

}  // namespace tenon

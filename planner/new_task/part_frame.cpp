#include "planner/new_task/part_frame.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <utility>
#include <vector>

namespace tenon::planner {
namespace {

// A side stands along the way out, or faces along an axis: within two degrees.
constexpr double kUpright = 0.035;
constexpr double kQuarter_rad = 0.5 * std::numbers::pi;
// Angles are counted in so many parts of a quarter turn, and those within two degrees together.
constexpr int kParts = 900;
constexpr int kTogether = 20;
// A side is flat that has so much of all that stands upright: a part that is round has none.
constexpr double kFlatShare = 0.06;
// Of one side: no farther apart than so much of the part, along which it faces.
constexpr double kSameSide = 1e-3;
// With so much of what the best axes have, the file's own are kept.
constexpr double kAsGood = 0.9;

/// How much of two parts' flat upright sides faces along x or y, by the angle of these.
class SquareSides {
 public:
  /// @param turn of the mesh, to a frame whose z is the way out
  void add(const TriangleMesh& mesh, const Eigen::Quaterniond& turn) {
    Eigen::AlignedBox3d box;
    for (const Vector3& point_m : mesh.points_m) box.extend(point_m);
    const double same_m = kSameSide * box.sizes().maxCoeff();
    std::map<std::pair<long, long>, double> sides_m2;  // by angle and distance
    double all_m2 = 0.0;
    for (const Triangle& t : mesh.triangles) {
      const Vector3 first_m = turn * mesh.points_m[t[0]];
      const Vector3 twice_m2 =
          (turn * mesh.points_m[t[1]] - first_m).cross(turn * mesh.points_m[t[2]] - first_m);
      const double norm_m2 = twice_m2.norm();
      if (std::abs(twice_m2.z()) > kUpright * norm_m2 || norm_m2 == 0.0) continue;
      const double angle_rad = std::atan2(twice_m2.y(), twice_m2.x());
      const long part = std::lround(angle_rad / kQuarter_rad * kParts);
      const long off = std::lround(twice_m2.dot(first_m) / norm_m2 / same_m);
      sides_m2[{part, off}] += 0.5 * norm_m2;
      all_m2 += 0.5 * norm_m2;
    }
    for (const auto& [side, area_m2] : sides_m2) {
      if (area_m2 < kFlatShare * all_m2) continue;
      const long part = (side.first % kParts + kParts) % kParts;
      area_m2_[static_cast<std::size_t>(part)] += area_m2;
    }
  }

  /// About a part of the quarter turn, from either side of it.
  [[nodiscard]] double near_m2(int part) const {
    double sum_m2 = 0.0;
    for (int off = -kTogether; off <= kTogether; ++off) sum_m2 += at(part + off);
    return sum_m2;
  }

  /// Of the angle about which the most faces, its middle, rad in (-1/8, 1/8] turn.
  [[nodiscard]] double best_rad() const {
    int best = 0;
    for (int part = 1; part < kParts; ++part) {
      if (near_m2(part) > near_m2(best)) best = part;
    }
    if (near_m2(best) == 0.0) return 0.0;
    double moment_m2 = 0.0;
    for (int off = -kTogether; off <= kTogether; ++off) moment_m2 += off * at(best + off);
    const double middle = (best + moment_m2 / near_m2(best)) / kParts;
    return kQuarter_rad * (middle - std::round(middle));
  }

 private:
  [[nodiscard]] double at(int part) const {
    return area_m2_[static_cast<std::size_t>((part + kParts) % kParts)];
  }

  std::vector<double> area_m2_ = std::vector<double>(kParts);
};

}  // namespace

Eigen::Quaterniond part_frame(const Vector3& way, const TriangleMesh& plug,
                              const Eigen::Quaterniond& plug_turn, const TriangleMesh& socket) {
  auto along = Eigen::Quaterniond::FromTwoVectors(Vector3::UnitZ(), way);
  SquareSides sides;
  sides.add(socket, along.conjugate());
  sides.add(plug, along.conjugate() * plug_turn);
  const double best_rad = sides.best_rad();
  const auto part = static_cast<int>(std::lround(best_rad / kQuarter_rad * kParts));
  if (sides.near_m2(0) >= kAsGood * sides.near_m2(part)) return along;
  return along * Eigen::AngleAxisd(best_rad, Vector3::UnitZ());
}

}  // namespace tenon::planner

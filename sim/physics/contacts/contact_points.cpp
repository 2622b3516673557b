#include "sim/physics/contacts/contact_points.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "shared/math/pose.h"

namespace tenon::sim {
namespace {

constexpr double kGrazing_m = 1e-7;  // points no deeper share alike

Vector3 normal_of(const dContactGeom& point) {
  return {point.normal[0], point.normal[1], point.normal[2]};
}

Vector3 position_of(const dContactGeom& point) {
  return {point.pos[0], point.pos[1], point.pos[2]};
}

bool on_one_plane(const dContactGeom& a, const dContactGeom& b) {
  constexpr double kParallel = 0.9994;  // 2 degrees
  constexpr double kApart_m = 1e-3;
  const Vector3 normal = normal_of(a);
  return normal.dot(normal_of(b)) > kParallel &&
         std::abs(normal.dot(position_of(a) - position_of(b))) < kApart_m;
}

/// Indices of the points of a face that stay: its hull as eight directions see it, and the deepest.
std::vector<std::size_t> outermost(const std::vector<dContactGeom>& points,
                                   const std::vector<std::size_t>& face) {
  const Vector3 normal = normal_of(points[face.front()]);
  const Vector3 u = normal.unitOrthogonal();
  const Vector3 v = normal.cross(u);
  const double diagonal = std::sqrt(0.5);
  const std::array<Vector3, 4> ways = {u, v, diagonal * (u + v), diagonal * (u - v)};
  std::vector<std::size_t> kept;
  const auto keep_most = [&](const auto& measure) {
    kept.push_back(*std::max_element(face.begin(), face.end(), [&](std::size_t a, std::size_t b) {
      return measure(points[a]) < measure(points[b]);
    }));
  };
  for (const Vector3& way : ways) {
    for (const double sign : {1.0, -1.0}) {
      keep_most([&](const dContactGeom& point) { return sign * way.dot(position_of(point)); });
    }
  }
  keep_most([](const dContactGeom& point) { return point.depth; });
  return kept;
}

/// Indices of points, those on one plane together.
std::vector<std::vector<std::size_t>> faces_of(const std::vector<dContactGeom>& points) {
  std::vector<std::vector<std::size_t>> faces;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const auto face = std::find_if(faces.begin(), faces.end(), [&](const auto& members) {
      return on_one_plane(points[members.front()], points[i]);
    });
    if (face == faces.end()) {
      faces.push_back({i});
    } else {
      face->push_back(i);
    }
  }
  return faces;
}

/// In the order that they had.
void keep_only(std::vector<dContactGeom>& points, std::vector<std::size_t> kept) {
  std::sort(kept.begin(), kept.end());
  kept.erase(std::unique(kept.begin(), kept.end()), kept.end());
  for (std::size_t i = 0; i < kept.size(); ++i) points[i] = points[kept[i]];
  points.resize(kept.size());
}

}  // namespace

void thin_out(std::vector<dContactGeom>& points) {
  if (points.size() <= kPointsAFace) return;
  std::vector<std::size_t> kept;
  for (const std::vector<std::size_t>& face : faces_of(points)) {
    const auto stay = face.size() <= kPointsAFace ? face : outermost(points, face);
    kept.insert(kept.end(), stay.begin(), stay.end());
  }
  keep_only(points, std::move(kept));
}

void keep_some(std::vector<dContactGeom>& points) {
  if (points.size() <= kPointsMax) return;
  const auto deeper = [&](std::size_t a, std::size_t b) {
    return points[a].depth != points[b].depth ? points[a].depth > points[b].depth : a < b;
  };
  // How many of its own face are deeper than a point, before how deep it is.
  std::vector<std::pair<std::size_t, std::size_t>> ranked;
  for (std::vector<std::size_t>& face : faces_of(points)) {
    std::sort(face.begin(), face.end(), deeper);
    for (std::size_t i = 0; i < face.size(); ++i) ranked.emplace_back(i, face[i]);
  }
  std::sort(ranked.begin(), ranked.end(), [&](const auto& a, const auto& b) {
    return a.first != b.first ? a.first < b.first : deeper(a.second, b.second);
  });
  std::vector<std::size_t> kept;
  for (std::size_t i = 0; i < kPointsMax; ++i) kept.push_back(ranked[i].second);
  keep_only(points, std::move(kept));
}

void keep_deepest(std::vector<dContactGeom>& points) {
  std::size_t kept = 0;
  for (const dContactGeom& point : points) {
    const auto end = points.begin() + static_cast<std::ptrdiff_t>(kept);
    const auto same = std::find_if(
        points.begin(), end, [&](const dContactGeom& other) { return on_one_plane(other, point); });
    if (same == end) {
      points[kept++] = point;
    } else if (point.depth > same->depth) {
      *same = point;
    }
  }
  points.resize(kept);
}

double share(const std::vector<dContactGeom>& points, std::size_t index) {
  const auto depth_m = [](const dContactGeom& point) {
    return std::max(kGrazing_m, static_cast<double>(point.depth));
  };
  const Vector3 normal = normal_of(points[index]);
  double all_m = 0.0;
  for (const dContactGeom& other : points) {
    const double cosine = std::max(0.0, normal.dot(normal_of(other)));
    all_m += cosine * cosine * depth_m(other);
  }
  return depth_m(points[index]) / all_m;
}

}  // namespace tenon::sim

#include "sim/physics/contacts/prism_manifold.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <utility>

#include "sim/physics/contacts/prism_contact.h"

namespace tenon::sim {
namespace {

// A circle among outlines that are clipped.
constexpr std::size_t kCircleCorners = 8;
// An outline of at most eight corners, clipped by as many edges.
constexpr std::size_t kCornersMax = 2 * kCircleCorners;

/// Corners in the plane across the axis, in the axes u and v of a prism.
class Outline {
 public:
  using Point = Eigen::Vector2d;

  void add(const Point& point) {
    if (count_ < points_.size()) points_[count_++] = point;
  }
  [[nodiscard]] std::size_t size() const { return count_; }
  [[nodiscard]] const Point& operator[](std::size_t i) const { return points_[i % count_]; }

  /// What lies on the inner side of a line. @param out unit normal  @param limit of out . point
  [[nodiscard]] Outline clipped(const Point& out, double limit) const {
    Outline inside;
    for (std::size_t i = 0; i < count_; ++i) {
      const Point& a = (*this)[i];
      const Point& b = (*this)[i + 1];
      const double beyond_a = out.dot(a) - limit;
      const double beyond_b = out.dot(b) - limit;
      if (beyond_a <= 0.0) inside.add(a);
      if (beyond_a * beyond_b < 0.0) inside.add(a + beyond_a / (beyond_a - beyond_b) * (b - a));
    }
    return inside;
  }

 private:
  std::array<Point, kCornersMax> points_;
  std::size_t count_ = 0;
};

/// A prism's outline, counter-clockwise, in the axes u and v of `frame` about its centre.
Outline outline_in(const Prism& prism, const Prism& frame) {
  const auto in_frame = [&](double u_m, double v_m) {
    const Vector3 off_m = prism.centre_m + u_m * prism.u + v_m * prism.v - frame.centre_m;
    return Outline::Point(frame.u.dot(off_m), frame.v.dot(off_m));
  };
  Outline outline;
  if (prism.round) {
    for (std::size_t i = 0; i < kCircleCorners; ++i) {
      const double angle_rad = 2.0 * std::numbers::pi * static_cast<double>(i) / kCircleCorners;
      outline.add(
          in_frame(prism.half_u_m * std::cos(angle_rad), prism.half_u_m * std::sin(angle_rad)));
    }
  } else {
    outline.add(in_frame(prism.half_u_m, prism.half_v_m));
    outline.add(in_frame(-prism.half_u_m, prism.half_v_m));
    outline.add(in_frame(-prism.half_u_m, -prism.half_v_m));
    outline.add(in_frame(prism.half_u_m, -prism.half_v_m));
  }
  return outline;
}

/// The edge of an outline that looks most against a direction.
std::pair<Outline::Point, Outline::Point> edge_against(const Outline& outline,
                                                       const Outline::Point& way) {
  std::size_t best = 0;
  double most = 0.0;
  for (std::size_t i = 0; i < outline.size(); ++i) {
    const Outline::Point along = outline[i + 1] - outline[i];
    // The outward normal of an edge, either way round.
    Outline::Point out = Outline::Point(along.y(), -along.x()).normalized();
    const Outline::Point middle = 0.5 * (outline[i] + outline[i + 1]);
    Outline::Point centre = Outline::Point::Zero();
    for (std::size_t j = 0; j < outline.size(); ++j) centre += outline[j];
    centre /= static_cast<double>(outline.size());
    if (out.dot(middle - centre) < 0.0) out = -out;
    const double against = -out.dot(way);
    if (against <= most) continue;
    most = against;
    best = i;
  }
  return {outline[best], outline[best + 1]};
}

/// Gathers contact points of one pair.
class Manifold {
 public:
  Manifold(const ShapeGeometry& held, const ShapeGeometry& environment, const Vector3& normal,
           PairPoints& points)
      : held_(held.id()), environment_(environment.id()), normal_(normal), points_(points) {}

  void add(const Vector3& at_m, double depth_m) {
    if (depth_m < 0.0 || count_ == points_.size()) return;
    dContactGeom contact{};
    contact.depth = depth_m;
    contact.g1 = held_;
    contact.g2 = environment_;
    for (int axis = 0; axis < 3; ++axis) {
      contact.normal[axis] = normal_[axis];
      contact.pos[axis] = at_m[axis];
    }
    points_[count_++] = contact;
  }
  [[nodiscard]] std::span<const dContactGeom> found() const { return {points_.data(), count_}; }

 private:
  dGeomID held_;
  dGeomID environment_;
  Vector3 normal_;
  PairPoints& points_;
  std::size_t count_ = 0;
};

/// Heights along the environment's axis, about its centre.
struct Heights {
  double low_m = 0.0;
  double high_m = 0.0;
};

Heights shared_heights(const Prism& held, const Prism& environment) {
  const double off_m = environment.axis.dot(held.centre_m - environment.centre_m);
  return {std::max(-environment.half_length_m, off_m - held.half_length_m),
          std::min(environment.half_length_m, off_m + held.half_length_m)};
}

/// The point of an outline, in its own axes, that is nearest to another one's centre.
Outline::Point nearest_of(const Prism& frame, const Prism& other) {
  const Vector3 off_m = other.centre_m - frame.centre_m;
  const Outline::Point to(frame.u.dot(off_m), frame.v.dot(off_m));
  if (frame.round) return std::min(1.0, frame.half_u_m / to.norm()) * to;
  return {std::clamp(to.x(), -frame.half_u_m, frame.half_u_m),
          std::clamp(to.y(), -frame.half_v_m, frame.half_v_m)};
}

/// The outlines' common area, on the environment's face.
void press_along(const Prism& held, const Prism& environment, const PrismOverlap& overlap,
                 Manifold& manifold) {
  const Prism& frame = environment.round ? held : environment;
  const Prism& other = environment.round ? environment : held;
  Outline area = outline_in(other, frame);
  if (frame.round) {
    // Two circles: the one that is smaller, as far as the other goes.
    const Outline circle = outline_in(frame, frame);
    for (std::size_t i = 0; i < circle.size(); ++i) {
      const Outline::Point middle = 0.5 * (circle[i] + circle[i + 1]);
      area = area.clipped(middle.normalized(), middle.norm());
    }
  } else {
    for (const double sign : {1.0, -1.0}) {
      area = area.clipped({sign, 0.0}, frame.half_u_m);
      area = area.clipped({0.0, sign}, frame.half_v_m);
    }
  }
  if (area.size() == 0) area.add(nearest_of(frame, other));  // a circle's rim, between its corners
  const Vector3 face_m = environment.centre_m + environment.half_length_m * overlap.normal;
  for (std::size_t i = 0; i < area.size(); ++i) {
    const Vector3 at_m = frame.centre_m + area[i].x() * frame.u + area[i].y() * frame.v;
    manifold.add(at_m + overlap.normal.dot(face_m - at_m) * overlap.normal, overlap.depth_m);
  }
}

/// The edge that looks against the face, as far as the face goes.
void press_across(const Prism& held, const Prism& environment, const PrismOverlap& overlap,
                  Manifold& manifold) {
  // Whose face it is: a side of the environment, or one of the held part.
  const auto looks_along = [&](const Prism& prism) {
    if (prism.round) return 0.0;
    return std::max(std::abs(prism.u.dot(overlap.normal)), std::abs(prism.v.dot(overlap.normal)));
  };
  const bool own = looks_along(held) > looks_along(environment);
  const Prism& face = own ? held : environment;
  const Prism& other = own ? environment : held;
  const Vector3 out = own ? Vector3(-overlap.normal) : overlap.normal;
  const Heights heights = shared_heights(held, environment);
  const auto add = [&](const Outline::Point& point, double depth_m) {
    const Vector3 across_m = face.centre_m + point.x() * face.u + point.y() * face.v;
    const double height_m = environment.axis.dot(across_m - environment.centre_m);
    for (const double at_m : {heights.low_m, heights.high_m}) {
      manifold.add(across_m + (at_m - height_m) * environment.axis, depth_m);
    }
  };
  const Outline::Point way(face.u.dot(out), face.v.dot(out));
  if (face.round || other.round) {
    // A circle has one point there. Of two of them, or of a circle and a corner, too.
    const Prism& circle = other.round ? other : face;
    const Vector3 to_other = other.round ? Vector3(-out) : out;
    const Vector3 at_m = circle.centre_m + circle.half_u_m * to_other - face.centre_m;
    return add({face.u.dot(at_m), face.v.dot(at_m)}, overlap.depth_m);
  }
  const bool along_u = std::abs(way.x()) > std::abs(way.y());
  const double reach_m = along_u ? face.half_u_m : face.half_v_m;
  const double width_m = along_u ? face.half_v_m : face.half_u_m;
  const Outline::Point side = along_u ? Outline::Point(0.0, 1.0) : Outline::Point(1.0, 0.0);
  const auto [from, to] = edge_against(outline_in(other, face), way);
  Outline edge;
  edge.add(from);
  edge.add(to);
  for (const double sign : {1.0, -1.0}) edge = edge.clipped(sign * side, width_m);
  for (std::size_t i = 0; i < std::min<std::size_t>(edge.size(), 2); ++i) {
    add(edge[i], reach_m - way.dot(edge[i]));
  }
}

}  // namespace

std::optional<std::span<const dContactGeom>> prism_manifold(const ShapeGeometry& held_shape,
                                                            const ShapeGeometry& environment_shape,
                                                            PairPoints& found) {
  const auto axes = held_shape.axes_in_common(environment_shape);
  if (!axes) return std::nullopt;
  const Prism held = held_shape.prism(axes->own);
  const Prism environment = environment_shape.prism(axes->other);
  const PrismOverlap overlapping = overlap(held, environment);
  Manifold manifold(held_shape, environment_shape, overlapping.normal, found);
  if (overlapping.depth_m >= 0.0) {
    const bool along = std::abs(environment.axis.dot(overlapping.normal)) > 0.5;
    (along ? press_along : press_across)(held, environment, overlapping, manifold);
  }
  return manifold.found();
}

}  // namespace tenon::sim

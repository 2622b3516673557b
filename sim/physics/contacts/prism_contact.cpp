#include "sim/physics/contacts/prism_contact.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace tenon::sim {
namespace {

/// Keeps the way out that is shortest.
struct Shortest {
  double depth_m = std::numeric_limits<double>::infinity();
  Vector3 normal = Vector3::Zero();

  void offer(double depth, const Vector3& way) {
    if (depth >= depth_m) return;
    depth_m = depth;
    normal = way;
  }
};

/// Half of an outline's width along a direction across the axis.
double half_width_m(const Prism& prism, const Vector3& way) {
  if (prism.round) return prism.half_u_m;
  return prism.half_u_m * std::abs(prism.u.dot(way)) + prism.half_v_m * std::abs(prism.v.dot(way));
}

/// Along a direction and against it. @param off_m from the environment's centre to the held one's
void offer_width(const Prism& held, const Prism& environment, const Vector3& off_m,
                 const Vector3& way, Shortest& shortest) {
  const double apart_m = way.dot(off_m);
  const double reach_m = half_width_m(held, way) + half_width_m(environment, way);
  shortest.offer(reach_m - std::abs(apart_m), apart_m >= 0.0 ? way : Vector3(-way));
}

/// The point of a rectangle that is nearest to a place.
Vector3 nearest_m(const Prism& rectangle, const Vector3& place_m) {
  const Vector3 off_m = place_m - rectangle.centre_m;
  const double u_m = std::clamp(rectangle.u.dot(off_m), -rectangle.half_u_m, rectangle.half_u_m);
  const double v_m = std::clamp(rectangle.v.dot(off_m), -rectangle.half_v_m, rectangle.half_v_m);
  return rectangle.centre_m + u_m * rectangle.u + v_m * rectangle.v +
         rectangle.axis.dot(off_m) * rectangle.axis;
}

/// The direction from `from` to `to` across the axis; zero where they are above each other.
Vector3 across(const Vector3& from_m, const Vector3& to_m, const Vector3& axis) {
  const Vector3 way = (to_m - from_m) - axis.dot(to_m - from_m) * axis;
  const double length_m = way.norm();
  return length_m > 0.0 ? Vector3(way / length_m) : Vector3::Zero();
}

/// Outlines across the axis. A round one adds the direction to what is nearest of the other.
Shortest across_the_axis(const Prism& held, const Prism& environment, const Vector3& off_m) {
  Shortest shortest;
  for (const Prism* prism : {&held, &environment}) {
    if (prism->round) continue;
    offer_width(held, environment, off_m, prism->u, shortest);
    offer_width(held, environment, off_m, prism->v, shortest);
  }
  if (!held.round && !environment.round) return shortest;
  const Vector3 of_environment =
      environment.round ? environment.centre_m : nearest_m(environment, held.centre_m);
  const Vector3 of_held = held.round ? held.centre_m : nearest_m(held, environment.centre_m);
  const Vector3 way = across(of_environment, of_held, environment.axis);
  if (!way.isZero(0.0)) {
    offer_width(held, environment, off_m, way, shortest);
  } else if (held.round && environment.round) {
    offer_width(held, environment, off_m, held.u, shortest);
  }
  return shortest;
}

}  // namespace

PrismOverlap overlap(const Prism& held, const Prism& environment) {
  const Vector3 off_m = held.centre_m - environment.centre_m;
  Shortest shortest = across_the_axis(held, environment, off_m);
  const double along_m = environment.axis.dot(off_m);
  const Vector3 axis = along_m >= 0.0 ? environment.axis : Vector3(-environment.axis);
  shortest.offer(held.half_length_m + environment.half_length_m - std::abs(along_m), axis);
  // On the environment's face; somewhere amid what overlaps on it.
  const Vector3 amid_m = 0.5 * (held.centre_m + environment.centre_m);
  const bool along = shortest.normal == axis;
  const double face_m =
      along ? environment.half_length_m : half_width_m(environment, shortest.normal);
  const double amid_to_face_m = face_m - shortest.normal.dot(amid_m - environment.centre_m);
  return {shortest.depth_m, shortest.normal, amid_m + amid_to_face_m * shortest.normal};
}

std::optional<dContactGeom> prism_contact(const ShapeGeometry& held,
                                          const ShapeGeometry& environment) {
  const auto axes = held.axes_in_common(environment);
  if (!axes) return std::nullopt;
  const PrismOverlap found = overlap(held.prism(axes->own), environment.prism(axes->other));
  dContactGeom contact{};
  contact.depth = found.depth_m;
  contact.g1 = held.id();
  contact.g2 = environment.id();
  for (int axis = 0; axis < 3; ++axis) {
    contact.normal[axis] = found.normal[axis];
    contact.pos[axis] = found.at_m[axis];
  }
  return contact;
}

}  // namespace tenon::sim

#include "sim/physics/contacts/surface_contact.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "shared/geometry/common_depth.h"

namespace tenon::sim {
namespace {

// What is farther away is not looked at one by one.
constexpr double kNear_m = 1e-4;
// A ball that may come near within this is looked at anew together with the others.
constexpr double kSoon_m = 0.5e-4;
// Looked at anew so much earlier than need be, so that rounding decides nothing.
constexpr double kEarly_m = 1e-9;

// Sharper edges than of some 35 degrees are taken by their sides.
constexpr double kSteepMin = 0.3;

Vector3 point_in(const Pose& X, const Vector3& point_m) {
  return X.position_m + X.orientation * point_m;
}

dContactGeom contact_at(const Vector3& at_m, const Vector3& normal, double depth_m) {
  dContactGeom contact{};
  contact.depth = depth_m;
  for (int axis = 0; axis < 3; ++axis) {
    contact.pos[axis] = at_m[axis];
    contact.normal[axis] = normal[axis];
  }
  return contact;
}

/// Where the distance is least along a piece whose ends fall towards each other: the tangents meet
/// there. Exact where the surface is an edge across the piece.
struct Foot {
  double along = 0.0;  ///< 0 to 1
  double distance_m = 0.0;
};
Foot foot_of(double from_m, double to_m, double slope_from, double slope_to, double length_m) {
  if (slope_from >= 0.0 || slope_to <= 0.0) {
    return {from_m <= to_m ? 0.0 : 1.0, std::min(from_m, to_m)};
  }
  const double way_m =
      std::clamp((to_m - slope_to * length_m - from_m) / (slope_from - slope_to), 0.0, length_m);
  return {way_m / length_m, from_m + slope_from * way_m};
}

}  // namespace

SurfaceContact::SurfaceContact(const Surface& held, const Surface& environment)
    : exact_(held.exact() && environment.exact()) {
  held_.edges = environment_.surface = &held;
  held_.surface = environment_.edges = &environment;
  for (Side* side : {&held_, &environment_}) {
    side->points.resize(side->edges->points_m().size());
    side->balls.resize(side->edges->balls().size());
    side->apart_until_m.resize(side->edges->pieces().size());
    side->at_least_tells.resize(side->edges->pieces().size());
  }
  forget();
}

void SurfaceContact::forget() {
  for (Side* side : {&held_, &environment_}) {
    side->near.clear();
    side->complete_until_m = 0.0;
    std::fill(side->apart_until_m.begin(), side->apart_until_m.end(), 0.0);
    std::fill(side->at_least_tells.begin(), side->at_least_tells.end(), true);
    std::fill(side->balls.begin(), side->balls.end(), Side::Ball{});
  }
}

const Surface::Place& SurfaceContact::place(Side& side, std::uint32_t index,
                                            const Pose& X_SE) const {
  Side::Point& point = side.points[index];
  if (point.time == time_) return point.place;
  point.time = time_;
  const Vector3 point_m = point_in(X_SE, side.edges->points_m()[index]);
  return point.place = side.surface->next_place(point_m, point.track);
}

Pose SurfaceContact::edges_in_surface(const Side& side, const Stand& stand) const {
  return &side == &held_ ? compose(inverse(stand.X_WE), stand.X_WH)
                         : compose(inverse(stand.X_WH), stand.X_WE);
}

void SurfaceContact::gather(Side& side, const Pose& X_SE, const Stand& stand) {
  side.near.clear();
  side.complete_until_m = std::numeric_limits<double>::infinity();
  const std::vector<Surface::Ball>& balls = side.edges->balls();
  if (balls.empty()) return;
  std::vector<std::uint32_t> waiting = {0};
  while (!waiting.empty()) {
    const Surface::Ball& ball = balls[waiting.back()];
    Side::Ball& known = side.balls[waiting.back()];
    waiting.pop_back();
    if (known.far_until_m <= stand.moved_m + kSoon_m && known.near_until_m <= stand.moved_m) {
      const Vector3 centre_m = point_in(X_SE, ball.centre_m);
      auto distance_m = side.surface->distance_at_least_m(centre_m);
      if (!distance_m) {
        const Surface::Place at = side.surface->place(centre_m, known.guess);
        known.guess = at.guess;
        distance_m = at.distance_m;
      }
      const double gap_m = *distance_m - ball.radius_m - stand.offset_m;
      known.far_until_m = gap_m > kNear_m ? stand.moved_m + gap_m - kEarly_m : 0.0;
      known.near_until_m = gap_m > kNear_m ? 0.0 : stand.moved_m + kNear_m - gap_m;
    }
    if (known.far_until_m > stand.moved_m) {
      side.complete_until_m = std::min(side.complete_until_m, known.far_until_m);
    } else if (ball.child != 0) {
      waiting.push_back(ball.child);
      waiting.push_back(ball.child + 1);
    } else {
      const auto first = side.edges->order().begin() + ball.first;
      side.near.insert(side.near.end(), first, first + ball.count);
    }
  }
  // In the order of the surface itself: the solver sees the same whatever the way here.
  std::sort(side.near.begin(), side.near.end());
}

void SurfaceContact::add(const Found& found, const Stand& stand,
                         std::vector<dContactGeom>& points) const {
  const Pose& X_WS = found.held ? stand.X_WE : stand.X_WH;
  const Vector3 outwards = X_WS.orientation * found.outwards;
  points.push_back(contact_at(point_in(X_WS, found.at_m),
                              found.held ? outwards : Vector3(-outwards), found.depth_m));
}

std::optional<double> SurfaceContact::distance_at_least_m(Side& side, std::uint32_t index,
                                                          const Pose& X_SE) const {
  const Surface::Piece& piece = side.edges->pieces()[index];
  const std::vector<Vector3>& points_m = side.edges->points_m();
  std::array<double, 2> ends_m{};
  for (std::size_t i = 0; i < 2; ++i) {
    const std::uint32_t end = i == 0 ? piece.from : piece.to;
    Side::Point& point = side.points[end];
    if (point.at_least_time != time_) {
      const auto at_least_m = side.surface->distance_at_least_m(point_in(X_SE, points_m[end]));
      if (!at_least_m) return std::nullopt;
      point.at_least_m = *at_least_m;
      point.at_least_time = time_;
    }
    ends_m[i] = point.at_least_m;
  }
  const Vector3& from_m = points_m[piece.from];
  const Vector3& to_m = points_m[piece.to];
  const double middle_m =
      side.surface->distance_at_least_m(point_in(X_SE, 0.5 * (from_m + to_m))).value();
  // A distance falls by no more than the way, from both ends of either half.
  const double half_m = 0.5 * (to_m - from_m).norm();
  return 0.5 * (std::min(ends_m[0], ends_m[1]) + middle_m - half_m);
}

double SurfaceContact::look_at(Side& side, std::uint32_t index, const Pose& X_SE,
                               const Stand& stand) {
  if (side.at_least_tells[index]) {
    const auto at_least_m = distance_at_least_m(side, index, X_SE);
    if (at_least_m && *at_least_m > stand.offset_m) return *at_least_m - stand.offset_m;
    side.at_least_tells[index] = false;
  }
  const Surface& edges = *side.edges;
  const Surface::Piece& piece = edges.pieces()[index];
  const bool held = &side == &held_;
  const auto end = [&](std::uint32_t point) -> const Surface::Place& {
    const bool first = side.points[point].time != time_;
    const Surface::Place& at = place(side, point, X_SE);
    if (first && at.distance_m <= stand.offset_m) {
      // On the environment, as everywhere.
      const Vector3 at_m = held ? at.nearest_m : point_in(X_SE, edges.points_m()[point]);
      const Vector3 against = X_SE.orientation.conjugate() * Vector3(-at.outwards);
      found_.push_back({at_m, at.outwards, stand.offset_m - at.distance_m, held,
                        edges.foremost(point, against)});
    }
    return at;
  };
  const Surface::Place& from = end(piece.from);
  const Surface::Place& to = end(piece.to);
  for (const Surface::Place* at : {&from, &to}) {
    if (exact_ && at->distance_m <= stand.offset_m) note_beside(side, index, X_SE, *at);
  }
  const Vector3 from_m = edges.points_m()[piece.from];
  const Vector3 along_m = edges.points_m()[piece.to] - from_m;
  const double length_m = along_m.norm();
  const Vector3 way = X_SE.orientation * (along_m / length_m);
  const double slope_from = way.dot(from.outwards);
  const double slope_to = way.dot(to.outwards);
  const Foot foot = foot_of(from.distance_m, to.distance_m, slope_from, slope_to, length_m);
  if (foot.along > 0.0 && foot.along < 1.0 && foot.distance_m <= stand.offset_m) {
    const Vector3 point_m = point_in(X_SE, from_m + foot.along * along_m);
    const Surface::Place at = side.surface->place(point_m, from.guess);
    if (at.distance_m <= std::min({stand.offset_m, from.distance_m, to.distance_m})) {
      // Two edges part across both: the sides of the one add up to that direction. Where both sides
      // are as near, whichever is closer to that direction is left first.
      const Vector3 across = (slope_to * from.outwards - slope_from * to.outwards).normalized();
      double steep = across.dot(at.outwards);
      if (std::abs(at.distance_m - foot.distance_m) < kEarly_m) {
        steep = std::max({steep, across.dot(from.outwards), across.dot(to.outwards)});
      }
      const bool edge = steep > kSteepMin;
      const double depth_m = stand.offset_m - at.distance_m;
      found_.push_back({held ? at.nearest_m : point_m, edge ? across : at.outwards,
                        edge ? depth_m / steep : depth_m, held, edge});
    }
  }
  return std::min({from.distance_m, to.distance_m, foot.distance_m}) - stand.offset_m;
}

void SurfaceContact::note_beside(const Side& side, std::uint32_t index, const Pose& X_SE,
                                 const Surface::Place& at) {
  constexpr double kInto = -0.5;
  const Vector3 inwards = X_SE.orientation * side.edges->inwards(index);
  if (inwards.dot(at.outwards) > kInto) return;
  beside_.push_back({&side == &held_, index, at.outwards});
}

std::vector<Vector3> SurfaceContact::ways_apart(const Side& side, const Pose& X_SE) const {
  // Of directions: of a fine round side a few do for all.
  constexpr double kSame = 0.05;
  const bool held = &side == &held_;
  std::vector<Vector3> ways;
  for (const Found& found : found_) {
    if (found.depth_m <= 0.0) continue;
    const Vector3 way =
        found.held == held ? found.outwards : Vector3(-(X_SE.orientation * found.outwards));
    const auto same = [&](const Vector3& known) { return known.isApprox(way, kSame); };
    // The latest first: what lies side by side on a face is found one after the other.
    if (std::none_of(ways.rbegin(), ways.rend(), same)) ways.push_back(way);
  }
  return ways;
}

void SurfaceContact::look_beside(const Stand& stand) {
  constexpr double kInwards_m = 1e-4;
  constexpr double kSameWay = 0.9;
  if (beside_.empty()) return;
  const Pose X_EH = edges_in_surface(held_, stand);
  const Pose X_HE = edges_in_surface(environment_, stand);
  const std::vector<Vector3> apart_in_E = ways_apart(held_, X_EH);
  const std::vector<Vector3> apart_in_H = ways_apart(environment_, X_HE);
  for (const Beside& beside : beside_) {
    const Side& side = beside.held ? held_ : environment_;
    const Pose& X_SE = beside.held ? X_EH : X_HE;
    const std::vector<Vector3>& apart = beside.held ? apart_in_E : apart_in_H;
    const Vector3 inwards = X_SE.orientation * side.edges->inwards(beside.piece);
    const Vector3 way = (inwards - inwards.dot(beside.outwards) * beside.outwards).normalized();
    const auto holds = [&](const Vector3& outwards) { return outwards.dot(way) > kSameWay; };
    if (std::any_of(apart.begin(), apart.end(), holds)) continue;
    const Surface::Piece& piece = side.edges->pieces()[beside.piece];
    const std::vector<Vector3>& points_m = side.edges->points_m();
    const Vector3 at_m = point_in(X_SE, 0.5 * (points_m[piece.from] + points_m[piece.to]));
    const Surface::Place face = side.surface->place(at_m + kInwards_m * inwards, 0);
    const double off_m = face.distance_m - kInwards_m * inwards.dot(face.outwards);
    if (face.outwards.dot(way) < kSameWay || off_m > stand.offset_m) continue;
    const Vector3 on_face_m = at_m - off_m * face.outwards;
    found_.push_back(
        {beside.held ? on_face_m : at_m, face.outwards, stand.offset_m - off_m, beside.held, true});
  }
}

double SurfaceContact::common_depth_m(const Side& side, const Pose& X_SE, double offset_m,
                                      double known_m, double enough_m) {
  const Surface& edges = *side.edges;
  const auto other_m = [&](const Vector3& point_m) {
    const Vector3 there_m = point_in(X_SE, point_m);
    const auto at_least_m = side.surface->distance_at_least_m(there_m);
    if (at_least_m && *at_least_m > offset_m) return *at_least_m - offset_m;
    return side.surface->place(there_m, 0).distance_m - offset_m;
  };
  const auto own_m = [&](const Vector3& point_m) { return edges.place(point_m, 0).distance_m; };
  double deepest_m = known_m;
  std::vector<std::uint32_t> waiting;
  if (!edges.balls().empty()) waiting.push_back(0);
  while (!waiting.empty() && deepest_m <= enough_m) {
    const Surface::Ball& ball = edges.balls()[waiting.back()];
    waiting.pop_back();
    if (other_m(ball.centre_m) > ball.radius_m + kDrawnTo_m) continue;
    if (ball.child != 0) {
      waiting.insert(waiting.end(), {ball.child, ball.child + 1});
      continue;
    }
    for (std::uint32_t i = ball.first; i < ball.first + ball.count; ++i) {
      const std::uint32_t index = edges.order()[i];
      const Surface::Piece& piece = edges.pieces()[index];
      const Vector3 middle_m = 0.5 * (edges.points_m()[piece.from] + edges.points_m()[piece.to]);
      deepest_m = tenon::common_depth_m(middle_m, edges.inwards(index), own_m, other_m, deepest_m);
    }
  }
  return deepest_m;
}

double SurfaceContact::common_depth_m(const Stand& stand, double known_m, double enough_m) const {
  double deepest_m = known_m;
  if (!exact_) return deepest_m;
  for (const Side* side : {&held_, &environment_}) {
    const Pose X_SE = edges_in_surface(*side, stand);
    deepest_m = common_depth_m(*side, X_SE, stand.offset_m, deepest_m, enough_m);
  }
  return deepest_m;
}

void SurfaceContact::choose(const Stand& stand, std::vector<dContactGeom>& points) const {
  double deepest_m = -1.0;
  for (const Found& found : found_) {
    if (found.foremost) deepest_m = std::max(deepest_m, found.depth_m);
  }
  for (const Found& found : found_) {
    if (found.foremost || found.depth_m > deepest_m) add(found, stand, points);
  }
}

bool SurfaceContact::deeper(Side& side, std::uint32_t piece, const Stand& stand, double enough_m) {
  ++time_;
  found_.clear();
  (void)look_at(side, piece, edges_in_surface(side, stand), stand);
  return std::any_of(found_.begin(), found_.end(),
                     [&](const Found& found) { return found.depth_m > enough_m; });
}

double SurfaceContact::find(const Stand& stand, std::vector<dContactGeom>& points,
                            double enough_m) {
  for (Side* side : {&held_, &environment_}) {
    // Next to where it was deep enough the last time it mostly still is.
    if (std::isinf(enough_m) || !side->deep) continue;
    if (deeper(*side, *side->deep, stand, enough_m)) {
      choose(stand, points);
      return 0.0;
    }
  }
  ++time_;
  found_.clear();
  beside_.clear();
  double until_m = std::numeric_limits<double>::infinity();
  for (Side* side : {&held_, &environment_}) {
    const Pose X_SE = edges_in_surface(*side, stand);
    if (side->complete_until_m <= stand.moved_m) gather(*side, X_SE, stand);
    for (const std::uint32_t piece : side->near) {
      double& apart_until_m = side->apart_until_m[piece];
      if (apart_until_m <= stand.moved_m) {
        const std::size_t before = found_.size();
        const double gap_m = look_at(*side, piece, X_SE, stand);
        apart_until_m = stand.moved_m + std::max(0.0, gap_m - kEarly_m);
        const bool enough =
            std::any_of(found_.begin() + static_cast<std::ptrdiff_t>(before), found_.end(),
                        [&](const Found& found) { return found.depth_m > enough_m; });
        if (enough) {
          side->deep = piece;
          choose(stand, points);
          return 0.0;
        }
      }
      until_m = std::min(until_m, apart_until_m);
    }
    until_m = std::min(until_m, side->complete_until_m);
  }
  look_beside(stand);
  choose(stand, points);
  return std::max(0.0, until_m - stand.moved_m);
}

}  // namespace tenon::sim

#include "sim/physics/scene.h"

#include <algorithm>
#include <limits>
#include <span>

#include "shared/geometry/common_depth.h"
#include "sim/physics/contacts/contact_points.h"
#include "sim/physics/contacts/prism_contact.h"
#include "sim/physics/contacts/prism_manifold.h"
#include "sim/physics/contacts/touching_points.h"

namespace tenon::sim {
namespace {

double deepest_m(std::span<const dContactGeom> points) {
  double depth_m = 0.0;
  for (const dContactGeom& point : points) {
    depth_m = std::max(depth_m, static_cast<double>(point.depth));
  }
  return depth_m;
}

}  // namespace

Scene::Scene(const std::vector<Shape>& held, const std::vector<Shape>& environment,
             const Pose& X_WT, MeshDistances distances)
    : X_WT_(X_WT) {
  for (const Shape& shape : held) held_.emplace_back(shape, distances);
  for (const Shape& shape : environment) environment_.emplace_back(shape, distances).place(X_WT);
  for (std::size_t h = 0; h < held.size(); ++h) {
    for (std::size_t e = 0; e < environment.size(); ++e) {
      Watched& watched = watched_.emplace_back();
      watched.pair = {h, e};
      if (!held_[h].is_solid() && !environment_[e].is_solid()) continue;
      solids_ = true;
      watched.surfaces =
          std::make_unique<SurfaceContact>(held_[h].surface(), environment_[e].surface());
    }
  }
}

void Scene::attach(dBodyID body, const Pose& X_BP) {
  for (ShapeGeometry& shape : held_) shape.attach(body, X_BP);
}

void Scene::place_environment(const Pose& X_WT) {
  if (X_WT == X_WT_) return;
  X_WT_ = X_WT;
  for (ShapeGeometry& shape : environment_) shape.place(X_WT);
  moved_anywhere();
}

void Scene::set_oversize(double oversize_m) {
  if (oversize_m == oversize_m_) return;
  oversize_m_ = oversize_m;
  for (ShapeGeometry& shape : held_) shape.set_oversize(oversize_m);
  moved_anywhere();
}

Scene::Contacts Scene::find_contacts(bool turns) {
  seen_ = body_pose();
  seen_m_ = moved_m_;
  points_.clear();
  touching_.clear();
  clear_until_m_ = std::numeric_limits<double>::infinity();
  PairPoints buffer;
  for (Watched& watched : watched_) {
    if (watched.apart_until_m <= moved_m_) {
      const ShapeGeometry& held = held_[watched.pair.held];
      const ShapeGeometry& environment = environment_[watched.pair.environment];
      const double apart_m = watched.met ? 0.0 : held.separation_m(environment);
      watched.apart_until_m = moved_m_ + std::max(0.0, apart_m);
      if (apart_m <= 0.0) watched.met = touch(watched, turns, buffer);
    }
    clear_until_m_ = std::min(clear_until_m_, watched.apart_until_m);
  }
  Contacts result;
  result.depth_max_m = deepest_m(points_);
  (turns ? thin_out : keep_deepest)(points_);
  if (solids_) keep_some(points_);
  result.points = points_.size();
  return result;
}

void Scene::moved_anywhere() {
  for (Watched& watched : watched_) {
    watched.apart_until_m = 0.0;
    if (watched.surfaces) watched.surfaces->forget();
  }
  moved_m_ = 0.0;
  seen_m_ = 0.0;
  clear_until_m_ = 0.0;
  forget_meetings();
}

void Scene::placed() {
  // Longer ways leave too little of a double for what is small.
  constexpr double kLongWay_m = 100.0;
  if (moved_m_ > kLongWay_m) return moved_anywhere();
  look_where();
  forget_meetings();
}

void Scene::forget_meetings() {
  for (Watched& watched : watched_) watched.met = false;
  points_.clear();
  touching_.clear();
}

void Scene::look_where() {
  const Pose now = body_pose();
  const double way_m = (now.position_m - seen_.position_m).norm() +
                       reach_m() * now.orientation.angularDistance(seen_.orientation);
  moved_m_ = std::max(moved_m_, seen_m_ + way_m);
  seen_ = now;
  seen_m_ = moved_m_;
}

Pose Scene::body_pose() const {
  const dBodyID body = dGeomGetBody(held_.front().id());
  return body == nullptr ? held_.front().pose() : pose_of(body);
}

bool Scene::touch(Watched& watched, bool turns, PairPoints& buffer) {
  const ShapeGeometry& held = held_[watched.pair.held];
  const ShapeGeometry& environment = environment_[watched.pair.environment];
  std::span<const dContactGeom> found;
  if (watched.surfaces) {
    const std::size_t before = points_.size();
    watched.apart_until_m = moved_m_ + touch_surfaces(watched, points_);
    const bool met = points_.size() > before;
    if (met) touching_.push_back(watched.pair);
    return met;
  }
  if (const auto one = turns ? std::nullopt : prism_contact(held, environment)) {
    watched.apart_until_m = moved_m_ + std::max(0.0, -static_cast<double>(one->depth));
    buffer.front() = *one;
    found = {buffer.data(), one->depth >= 0.0 ? 1U : 0U};
  } else if (const auto manifold = prism_manifold(held, environment, buffer)) {
    found = *manifold;
  } else {
    found = touching_points(held, environment, buffer);
  }
  if (!found.empty()) touching_.push_back(watched.pair);
  points_.insert(points_.end(), found.begin(), found.end());
  return !found.empty();
}

SurfaceContact::Stand Scene::stand(const Pair& pair) const {
  const ShapeGeometry& held = held_[pair.held];
  const ShapeGeometry& environment = environment_[pair.environment];
  return {held.pose(), environment.pose(), held.offset_m() + environment.offset_m(), moved_m_};
}

double Scene::touch_surfaces(const Watched& watched, std::vector<dContactGeom>& points,
                             double enough_m) const {
  const std::size_t before = points.size();
  const double gap_m = watched.surfaces->find(stand(watched.pair), points, enough_m);
  for (std::size_t i = before; i < points.size(); ++i) {
    points[i].g1 = held_[watched.pair.held].id();
    points[i].g2 = environment_[watched.pair.environment].id();
  }
  return gap_m;
}

void Scene::make_joints(OdeWorld& world, double step_s, const ContactLaw& law) {
  joints_.make(world, points_, law, step_s);
}

double Scene::reach_m() const {
  double reach_m = 0.0;
  for (const ShapeGeometry& held : held_) reach_m = std::max(reach_m, held.reach_m());
  return reach_m;
}

double Scene::overlap_m(double enough_m) {
  look_where();
  double overlap_m = 0.0;
  PairPoints buffer;
  for (Watched& watched : watched_) {
    if (overlap_m > enough_m) break;
    if (watched.apart_until_m > moved_m_) continue;
    const ShapeGeometry& held = held_[watched.pair.held];
    const ShapeGeometry& environment = environment_[watched.pair.environment];
    if (const double apart_m = held.separation_m(environment); apart_m > 0.0) {
      watched.apart_until_m = moved_m_ + apart_m;
      continue;
    }
    if (watched.surfaces) {
      std::vector<dContactGeom> points;
      const double gap_m = touch_surfaces(watched, points, enough_m);
      overlap_m = std::max(overlap_m, deepest_m(points));
      if (gap_m > kDrawnTo_m || overlap_m > enough_m) continue;
      overlap_m = watched.surfaces->common_depth_m(stand(watched.pair), overlap_m, enough_m);
    } else {
      const auto one = prism_contact(held, environment);
      overlap_m = std::max(overlap_m, one ? static_cast<double>(one->depth)
                                          : deepest_m(touching_points(held, environment, buffer)));
    }
  }
  return overlap_m;
}

std::string Scene::name(const Pair& pair) const {
  return held_[pair.held].name() + "-" + environment_[pair.environment].name();
}

std::vector<std::string> Scene::touching() const {
  std::vector<std::string> names;
  for (const Pair& pair : touching_) names.push_back(name(pair));
  return names;
}

}  // namespace tenon::sim

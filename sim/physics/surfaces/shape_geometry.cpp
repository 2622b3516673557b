#include "sim/physics/surfaces/shape_geometry.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>

namespace tenon::sim {
namespace {

dGeomID make_geometry(const Shape& shape) {
  switch (shape.kind) {
    case Shape::Kind::kBox:
      return dCreateBox(nullptr, shape.size_m.x(), shape.size_m.y(), shape.size_m.z());
    case Shape::Kind::kCylinder:
      return dCreateCylinder(nullptr, 0.5 * shape.size_m.x(), shape.size_m.z());
  }
  assert(false);
  return nullptr;
}

}  // namespace

ShapeGeometry::ShapeGeometry(const Shape& shape) : shape_(shape), geometry_(make_geometry(shape)) {}

ShapeGeometry::~ShapeGeometry() { dGeomDestroy(geometry_); }

void ShapeGeometry::place(const Pose& X_WT) {
  const Pose pose = compose(X_WT, shape_.pose);
  const Eigen::Quaterniond& q = pose.orientation;
  const dQuaternion raw = {q.w(), q.x(), q.y(), q.z()};
  dGeomSetQuaternion(geometry_, raw);
  dGeomSetPosition(geometry_, pose.position_m.x(), pose.position_m.y(), pose.position_m.z());
}

void ShapeGeometry::attach(dBodyID body, const Pose& X_BP) {
  const Pose offset = compose(X_BP, shape_.pose);
  const Eigen::Quaterniond& q = offset.orientation;
  const dQuaternion raw = {q.w(), q.x(), q.y(), q.z()};
  dGeomSetBody(geometry_, body);
  dGeomSetOffsetPosition(geometry_, offset.position_m.x(), offset.position_m.y(),
                         offset.position_m.z());
  dGeomSetOffsetQuaternion(geometry_, raw);
}

void ShapeGeometry::set_oversize(double oversize_m) {
  oversize_m_ = oversize_m;
  const Vector3 size_m = shape_.size_m + Vector3::Constant(oversize_m);
  switch (shape_.kind) {
    case Shape::Kind::kBox:
      return dGeomBoxSetLengths(geometry_, size_m.x(), size_m.y(), size_m.z());
    case Shape::Kind::kCylinder:
      return dGeomCylinderSetParams(geometry_, 0.5 * size_m.x(), size_m.z());
  }
}

double ShapeGeometry::gap_m(const ShapeGeometry& other) const {
  std::array<dReal, 6> a{};
  std::array<dReal, 6> b{};
  dGeomGetAABB(geometry_, a.data());
  dGeomGetAABB(other.geometry_, b.data());
  double squares_m2 = 0.0;
  for (std::size_t i = 0; i < a.size(); i += 2) {
    const double apart_m = std::max({0.0, b[i] - a[i + 1], a[i] - b[i + 1]});
    squares_m2 += apart_m * apart_m;
  }
  return std::sqrt(squares_m2);
}

bool ShapeGeometry::is_near(const ShapeGeometry& other) const {
  std::array<dReal, 6> a{};
  std::array<dReal, 6> b{};
  dGeomGetAABB(geometry_, a.data());
  dGeomGetAABB(other.geometry_, b.data());
  return a[0] <= b[1] && b[0] <= a[1] && a[2] <= b[3] && b[2] <= a[3] && a[4] <= b[5] &&
         b[4] <= a[5];
}

double ShapeGeometry::reach_m() const {
  const dReal* centre = dGeomGetOffsetPosition(geometry_);
  const double size_m = (shape_.size_m + Vector3::Constant(oversize_m_)).norm();
  return Vector3(centre[0], centre[1], centre[2]).norm() + 0.5 * size_m;
}

}  // namespace tenon::sim

#include "sim/physics/surfaces/shape_geometry.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>

#include "shared/geometry/solid.h"

namespace tenon::sim {
namespace {

dGeomID make_geometry(const Shape& shape) {
  switch (shape.kind) {
    case Shape::Kind::kBox:
    case Shape::Kind::kSolid:
      return dCreateBox(nullptr, shape.size_m.x(), shape.size_m.y(), shape.size_m.z());
    case Shape::Kind::kCylinder:
      return dCreateCylinder(nullptr, 0.5 * shape.size_m.x(), shape.size_m.z());
  }
  assert(false);
  return nullptr;
}

/// One of a geometry's own axes, in the world's. ODE's matrices have rows of four.
Vector3 axis_of(const dReal* rotation, int axis) {
  return {rotation[axis], rotation[4 + axis], rotation[8 + axis]};
}

}  // namespace

ShapeGeometry::ShapeGeometry(const Shape& shape, MeshDistances distances)
    : shape_(shape), distances_(distances), geometry_(make_geometry(shape)) {}

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
    case Shape::Kind::kSolid:
      return dGeomBoxSetLengths(geometry_, size_m.x(), size_m.y(), size_m.z());
    case Shape::Kind::kCylinder:
      return dGeomCylinderSetParams(geometry_, 0.5 * size_m.x(), size_m.z());
  }
}

const Surface& ShapeGeometry::surface() {
  if (!surface_) surface_ = surface_of(shape_, distances_);
  return *surface_;
}

double ShapeGeometry::offset_m() const {
  const double grown_m = is_solid() ? shape_.size_m.x() - shape_.solid->size_m().x() : 0.0;
  return 0.5 * (oversize_m_ + grown_m);
}

Pose ShapeGeometry::pose() const {
  const dReal* p = dGeomGetPosition(geometry_);
  dQuaternion q;
  dGeomGetQuaternion(geometry_, q);
  return {{p[0], p[1], p[2]}, Eigen::Quaterniond(q[0], q[1], q[2], q[3])};
}

Vector3 ShapeGeometry::half_m() const {
  return 0.5 * (shape_.size_m + Vector3::Constant(oversize_m_));
}

Eigen::Matrix3d ShapeGeometry::axes() const {
  using Rows = Eigen::Matrix<double, 3, 4, Eigen::RowMajor>;
  return Eigen::Map<const Rows>(dGeomGetRotation(geometry_)).leftCols<3>();
}

Vector3 ShapeGeometry::half_along_m(const Eigen::Matrix3d& ways) const {
  const Vector3 half = half_m();
  if (shape_.kind != Shape::Kind::kCylinder) return ways.cwiseAbs() * half;
  return half.x() * ways.leftCols<2>().rowwise().norm() + half.z() * ways.col(2).cwiseAbs();
}

double ShapeGeometry::separation_m(const ShapeGeometry& other) const {
  const dReal* a = dGeomGetPosition(geometry_);
  const dReal* b = dGeomGetPosition(other.geometry_);
  const Vector3 between_m(b[0] - a[0], b[1] - a[1], b[2] - a[2]);
  const Eigen::Matrix3d own = axes();
  const Eigen::Matrix3d its = other.axes();
  const Eigen::Matrix3d its_in_own = own.transpose() * its;
  const Vector3 along_own = (own.transpose() * between_m).cwiseAbs();
  const Vector3 along_its = (its.transpose() * between_m).cwiseAbs();
  const Vector3 own_gaps = along_own - half_m() - other.half_along_m(its_in_own);
  const Vector3 its_gaps = along_its - other.half_m() - half_along_m(its_in_own.transpose());
  return std::max(own_gaps.maxCoeff(), its_gaps.maxCoeff());
}

std::optional<ShapeGeometry::AxesInCommon> ShapeGeometry::axes_in_common(
    const ShapeGeometry& other) const {
  if (is_solid() || other.is_solid()) return std::nullopt;
  constexpr double kParallel = 1.0 - 1e-12;  // 1.4 urad
  const auto first = [](const ShapeGeometry& shape) {
    return shape.shape_.kind == Shape::Kind::kCylinder ? 2 : 0;
  };
  for (int own = first(*this); own < 3; ++own) {
    for (int its = first(other); its < 3; ++its) {
      const double cosine = axis_of(dGeomGetRotation(geometry_), own)
                                .dot(axis_of(dGeomGetRotation(other.geometry_), its));
      if (std::abs(cosine) > kParallel) return AxesInCommon{own, its};
    }
  }
  return std::nullopt;
}

Prism ShapeGeometry::prism(int axis) const {
  const Vector3 half = half_m();
  const dReal* centre = dGeomGetPosition(geometry_);
  const dReal* rotation = dGeomGetRotation(geometry_);
  const int u = (axis + 1) % 3;
  const int v = (axis + 2) % 3;
  return {.centre_m = {centre[0], centre[1], centre[2]},
          .axis = axis_of(rotation, axis),
          .half_length_m = half[axis],
          .u = axis_of(rotation, u),
          .v = axis_of(rotation, v),
          .half_u_m = half[u],
          .half_v_m = half[v],
          .round = shape_.kind == Shape::Kind::kCylinder};
}

double ShapeGeometry::reach_m() const {
  const dReal* centre = dGeomGetOffsetPosition(geometry_);
  const double size_m = (shape_.size_m + Vector3::Constant(oversize_m_)).norm();
  return Vector3(centre[0], centre[1], centre[2]).norm() + 0.5 * size_m;
}

}  // namespace tenon::sim

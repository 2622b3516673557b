#include "sim/physics/solver/locked_contacts.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "sim/physics/contacts/contact_points.h"
#include "sim/physics/solver/contact_row.h"
#include "sim/physics/solver/ode_world.h"

namespace tenon::sim {
namespace {

// Two or three do where few faces touch.
constexpr int kIterationsMax = 60;

/// x of A x = b for a symmetric positive definite A: A = L D L', written out, for it is solved in
/// every step of a sliding tool.
Vector3 solved(const Eigen::Matrix3d& A, const Vector3& b) {
  const double l10 = A(1, 0) / A(0, 0);
  const double l20 = A(2, 0) / A(0, 0);
  const double d1 = A(1, 1) - l10 * A(1, 0);
  const double l21 = (A(2, 1) - l20 * A(1, 0)) / d1;
  const double d2 = A(2, 2) - l20 * A(2, 0) - l21 * l21 * d1;
  const double y1 = b[1] - l10 * b[0];
  const double x2 = (b[2] - l20 * b[0] - l21 * y1) / d2;
  const double x1 = y1 / d1 - l21 * x2;
  return {b[0] / A(0, 0) - l10 * x1 - l20 * x2, x1, x2};
}

}  // namespace

void LockedContacts::make_rows(const std::vector<dContactGeom>& points, const ContactLaw& law,
                               double step_s) {
  rows_.clear();
  positions_m_.clear();
  for (std::size_t i = 0; i < points.size(); ++i) {
    const dContactGeom& point = points[i];
    dVector3 first;
    dVector3 second;
    dPlaneSpace(point.normal, first, second);
    for (const dReal* way : {static_cast<const dReal*>(point.normal),
                             static_cast<const dReal*>(first), static_cast<const dReal*>(second)}) {
      Row& row = rows_.emplace_back();
      row.way = vector_of(way);
      row.be_soft(kFrictionSoftness);
    }
    const ContactRow normal = contact_row(law, share(points, i), i, step_s);
    Row& row = rows_[rows_.size() - kRowsAPoint];
    row.be_soft(normal.softness);
    row.wanted_mps = normal.approach_mps(point.depth, step_s);
    row.most_N = std::numeric_limits<double>::infinity();
    positions_m_.push_back(vector_of(point.pos));
  }
}

LockedContacts::Pull LockedContacts::pull_at(const Vector3& velocity_mps, const Tool& tool,
                                             std::size_t stride) {
  Vector3 force_N = (velocity_mps - tool.velocity_mps).cwiseProduct(tool.damping_Nspm);
  // Of the slope, which is symmetric: the diagonal, and xy, yz, zx.
  Vector3 along_Nspm = tool.damping_Nspm;
  Vector3 across_Nspm = Vector3::Zero();
  bool same = true;
  for (std::size_t i = 0; i < rows_.size(); i += stride) {
    Row& row = rows_[i];
    const double missing_mps = row.wanted_mps - row.way.dot(velocity_mps);
    const double whole_N = missing_mps * row.damping_Nspm;
    row.force_N = std::clamp(whole_N, row.least_N, row.most_N);
    const int bound = whole_N > row.most_N ? 1 : (whole_N < row.least_N ? -1 : 0);
    same = same && bound == row.bound;
    row.bound = bound;
    force_N -= row.force_N * row.way;
    if (bound != 0) continue;
    const Vector3 damped_Nspm = row.damping_Nspm * row.way;
    along_Nspm += damped_Nspm.cwiseProduct(row.way);
    across_Nspm += damped_Nspm.cwiseProduct(Vector3{row.way[1], row.way[2], row.way[0]});
  }
  Pull pull{force_N,
            Eigen::Matrix3d{{along_Nspm[0], across_Nspm[0], across_Nspm[2]},
                            {across_Nspm[0], along_Nspm[1], across_Nspm[1]},
                            {across_Nspm[2], across_Nspm[1], along_Nspm[2]}},
            same};
  for (int axis = 0; axis < 3; ++axis) {
    if (tool.damping_Nspm[axis] != 0.0) continue;
    pull.force_N[axis] = 0.0;
    pull.slope_Nspm.row(axis).setZero();
    pull.slope_Nspm.col(axis).setZero();
    pull.slope_Nspm(axis, axis) = 1.0;
  }
  return pull;
}

double LockedContacts::lowest_along(const Vector3& velocity_mps, const Vector3& way_mps,
                                    const Tool& tool, double slope_W, std::size_t stride) {
  // Between their bounds forces change, each along a part of the way.
  bends_.clear();
  double curvature_W = 0.0;
  for (int axis = 0; axis < 3; ++axis) {
    curvature_W += way_mps[axis] * way_mps[axis] * tool.damping_Nspm[axis];
  }
  for (std::size_t i = 0; i < rows_.size(); i += stride) {
    const Row& row = rows_[i];
    const double speed_mps = row.way.dot(way_mps);
    if (speed_mps == 0.0) continue;
    const double missing_mps = row.wanted_mps - row.way.dot(velocity_mps);
    const double a = (missing_mps - row.most_N * row.softness) / speed_mps;
    const double b = (missing_mps - row.least_N * row.softness) / speed_mps;
    const double bend_W = speed_mps * speed_mps * row.damping_Nspm;
    if (std::max(a, b) <= 0.0) continue;
    bends_.emplace_back(std::max(0.0, std::min(a, b)), bend_W);
    if (std::isfinite(std::max(a, b))) bends_.emplace_back(std::max(a, b), -bend_W);
  }
  std::sort(bends_.begin(), bends_.end());
  double at = 0.0;
  for (const auto& [next, bend_W] : bends_) {
    const double there_W = slope_W + curvature_W * (next - at);
    if (there_W >= 0.0) break;
    at = next;
    slope_W = there_W;
    curvature_W += bend_W;
  }
  return at - slope_W / curvature_W;
}

bool LockedContacts::settle(const Tool& tool, std::size_t stride, Vector3& velocity_mps) {
  Pull pull = pull_at(velocity_mps, tool, stride);
  for (int i = 0; i < kIterationsMax; ++i) {
    const Pull before = pull;
    const Vector3 way_mps = -solved(before.slope_Nspm, before.force_N);
    pull = pull_at(velocity_mps + way_mps, tool, stride);
    if (pull.same_bounds) {
      velocity_mps += way_mps;
      return true;
    }
    const double slope_W = before.force_N.dot(way_mps);
    velocity_mps += lowest_along(velocity_mps, way_mps, tool, slope_W, stride) * way_mps;
    pull = pull_at(velocity_mps, tool, stride);
  }
  return false;
}

bool LockedContacts::solve(const std::vector<dContactGeom>& points, const ContactLaw& law,
                           const Vector3& velocity_mps, const Vector3& give_mpspN, double step_s) {
  make_rows(points, law, step_s);
  Tool tool{velocity_mps, Vector3::Zero()};
  for (int axis = 0; axis < 3; ++axis) {
    if (give_mpspN[axis] != 0.0) tool.damping_Nspm[axis] = 1.0 / give_mpspN[axis];
  }
  Vector3 velocity = velocity_mps;
  if (!settle(tool, kRowsAPoint, velocity)) return false;
  for (std::size_t i = 0; i < rows_.size(); i += kRowsAPoint) {
    const double most_N = law.friction * rows_[i].force_N;
    for (std::size_t j = i + 1; j < i + kRowsAPoint; ++j) {
      rows_[j].least_N = -most_N;
      rows_[j].most_N = most_N;
    }
  }
  return settle(tool, 1, velocity);
}

Vector6 LockedContacts::wrench_about(const Vector3& point_m) const {
  Vector6 wrench = Vector6::Zero();
  for (std::size_t i = 0; i < rows_.size(); ++i) {
    const Vector3 force_N = rows_[i].force_N * rows_[i].way;
    wrench.head<3>() += force_N;
    wrench.tail<3>() += (positions_m_[i / kRowsAPoint] - point_m).cross(force_N);
  }
  return wrench;
}

}  // namespace tenon::sim

#include "sim/physics/solver/locked_contacts.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "sim/physics/contacts/contact_points.h"
#include "sim/physics/solver/contact_row.h"

namespace tenon::sim {
namespace {

// Settled: no force changes by more.
constexpr double kSettled_N = 1e-9;
constexpr int kSweepsMax = 200;

Vector3 vector_of(const dReal* v) { return {v[0], v[1], v[2]}; }

}  // namespace

void LockedContacts::make_rows(const std::vector<dContactGeom>& points, const ContactLaw& law,
                               const Vector3& give_mpspN, double step_s) {
  rows_.clear();
  positions_m_.clear();
  const std::vector<double> share = shares(points);
  for (std::size_t i = 0; i < points.size(); ++i) {
    const dContactGeom& point = points[i];
    dVector3 first;
    dVector3 second;
    dPlaneSpace(point.normal, first, second);
    for (const dReal* way : {static_cast<const dReal*>(point.normal),
                             static_cast<const dReal*>(first), static_cast<const dReal*>(second)}) {
      Row& row = rows_.emplace_back();
      row.way = vector_of(way);
      row.moved = give_mpspN.cwiseProduct(row.way);
    }
    const ContactRow normal = contact_row(law, share[i], i, step_s);
    Row& row = rows_[rows_.size() - kRowsAPoint];
    row.softness = normal.softness;
    row.wanted_mps = normal.approach_mps(point.depth, step_s);
    row.most_N = std::numeric_limits<double>::infinity();
    positions_m_.push_back(vector_of(point.pos));
    for (std::size_t j = rows_.size() - kRowsAPoint; j < rows_.size(); ++j) {
      const double give = rows_[j].way.dot(rows_[j].moved);
      // Friction along an axis that is held stops nothing: without this it would know no measure.
      if (give == 0.0) rows_[j].softness = std::max(rows_[j].softness, kFrictionSoftness);
      rows_[j].grip_Nspm = 1.0 / (give + rows_[j].softness);
    }
  }
}

bool LockedContacts::sweep(std::size_t stride, Vector3& velocity_mps) {
  for (int i = 0; i < kSweepsMax; ++i) {
    double change_N = 0.0;
    for (std::size_t j = 0; j < rows_.size(); j += stride) {
      Row& row = rows_[j];
      const double missing_mps =
          row.wanted_mps - row.way.dot(velocity_mps) - row.softness * row.force_N;
      const double force_N =
          std::clamp(row.force_N + missing_mps * row.grip_Nspm, row.least_N, row.most_N);
      const double more_N = force_N - row.force_N;
      row.force_N = force_N;
      velocity_mps += more_N * row.moved;
      change_N = std::max(change_N, std::abs(more_N));
    }
    if (change_N <= kSettled_N) return true;
  }
  return false;
}

bool LockedContacts::solve(const std::vector<dContactGeom>& points, const ContactLaw& law,
                           const Vector3& velocity_mps, const Vector3& give_mpspN, double step_s) {
  make_rows(points, law, give_mpspN, step_s);
  Vector3 velocity = velocity_mps;
  if (!sweep(kRowsAPoint, velocity)) return false;
  for (std::size_t i = 0; i < rows_.size(); i += kRowsAPoint) {
    const double most_N = law.friction * rows_[i].force_N;
    for (std::size_t j = i + 1; j < i + kRowsAPoint; ++j) {
      rows_[j].least_N = -most_N;
      rows_[j].most_N = most_N;
    }
  }
  return sweep(1, velocity);
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

#include "sim/physics/solver/one_contact.h"

#include <algorithm>
#include <cmath>

#include "sim/physics/solver/contact_row.h"

namespace tenon::sim {
namespace {

// Of rows that are told apart from those that couple; rounding is some 1e-16.
constexpr double kCoupled = 1e-12;

Vector3 vector_of(const dReal* v) { return {v[0], v[1], v[2]}; }

}  // namespace

std::optional<Vector3> one_contact_force(const dContactGeom& point, const ContactLaw& law,
                                         const Vector3& velocity_mps, const Vector3& give_mpspN,
                                         double step_s) {
  dVector3 first;
  dVector3 second;
  dPlaneSpace(point.normal, first, second);
  const Vector3 n = vector_of(point.normal);
  const Vector3 t = vector_of(first);
  const Vector3 u = vector_of(second);
  const auto give = [&](const Vector3& a, const Vector3& b) {
    return a.dot(give_mpspN.cwiseProduct(b));
  };
  const double most = kCoupled * give_mpspN.maxCoeff();
  if (std::abs(give(n, t)) > most || std::abs(give(n, u)) > most || std::abs(give(t, u)) > most) {
    return std::nullopt;
  }
  const ContactRow row = contact_row(law, 1.0, 0, step_s);
  const double push_N =
      std::max(0.0, (row.approach_mps(point.depth, step_s) - n.dot(velocity_mps)) /
                        (give(n, n) + row.softness));
  const auto friction_N = [&](const Vector3& way) {
    const double stop_N = -way.dot(velocity_mps) / (give(way, way) + kFrictionSoftness);
    return std::clamp(stop_N, -law.friction * push_N, law.friction * push_N);
  };
  return Vector3(push_N * n + friction_N(t) * t + friction_N(u) * u);
}

}  // namespace tenon::sim

#include "shared/motion/rules.h"

#include "shared/base/text.h"

namespace tenon {

std::optional<std::string> broken_rule(const ContactThresholds& t, double force_limit_N,
                                       double acceleration_max_mps2,
                                       const ContactConditions& conditions) {
  if (!(0.0 < t.force_off_N && t.force_off_N < t.force_keep_N && t.force_keep_N < t.force_on_N)) {
    return format("0 < force_off < force_keep < force_on does not hold: %g, %g, %g N",
                  t.force_off_N, t.force_keep_N, t.force_on_N);
  }
  if (!(0.0 < t.torque_off_Nm && t.torque_off_Nm < t.torque_keep_Nm &&
        t.torque_keep_Nm < t.torque_on_Nm)) {
    return format("0 < torque_off < torque_keep < torque_on does not hold: %g, %g, %g Nm",
                  t.torque_off_Nm, t.torque_keep_Nm, t.torque_on_Nm);
  }
  if (!(kProbeOverOn * t.force_on_N <= force_limit_N)) {
    return format("force_on = %g N must be at most force_limit / %g = %g N", t.force_on_N,
                  kProbeOverOn, force_limit_N / kProbeOverOn);
  }
  // Contacts that are held brace each other by friction and so settle above the keep force.
  const double mu = conditions.friction_max;
  const int n = conditions.contacts_max;
  const double braced = n + 0.5 * mu * n * (n - 1);
  const double friction_N = 1.25 * mu * braced * t.force_keep_N;
  if (!(t.force_on_N >= friction_N)) {
    return format(
        "force_on = %g N must be at least 1.25 mu (n + mu n (n - 1) / 2) force_keep = %g N with "
        "friction_max mu = %g, contacts n = %d, force_keep = %g N",
        t.force_on_N, friction_N, mu, n, t.force_keep_N);
  }
  const double inertia_N = 2.0 * conditions.mass_uncompensated_kg * acceleration_max_mps2;
  if (!(t.force_on_N >= inertia_N)) {
    return format(
        "force_on = %g N must be at least 2 * uncompensated mass * acceleration = 2 * %g * %g = %g "
        "N",
        t.force_on_N, conditions.mass_uncompensated_kg, acceleration_max_mps2, inertia_N);
  }
  if (!(t.force_on_N >= 5.0 * conditions.force_noise_N)) {
    return format("force_on = %g N must be at least 5 * force noise = 5 * %g = %g N", t.force_on_N,
                  conditions.force_noise_N, 5.0 * conditions.force_noise_N);
  }
  return std::nullopt;
}

std::string kilonewtons_hint(double force_on_N) {
  const double meant_N = 1e3 * force_on_N;
  if (force_on_N >= kForceOnMin_N || meant_N < 1.0) return {};
  return format("; is force_on_N in kN? then write %g N", meant_N);
}

}  // namespace tenon

#include "shared/motion/stiff_contact.h"

#include <algorithm>

namespace tenon {

ContactLoop contact_loop(const Cell& cell) {
  const Robot& robot = cell.robot;
  return {cell.contact_stiffness_Npm, 1e-6 * robot.cycle_us, robot.measurement_delay_cycles,
          robot.response_lag_s, robot.sensor.cycles_per_sample};
}

double damping_least_Nspm(const ContactLoop& loop) {
  return 1.5 * loop.stiffness_Npm * loop.latency_s();
}

double mass_most_kg(const ContactLoop& loop, double damping_Nspm) {
  return damping_Nspm * loop.latency_s();
}

double peak_force_N(const ContactLoop& loop, const Compliance& compliance, double force_on_N,
                    double speed_mps) {
  const double law_s = compliance.mass_kg / compliance.damping_Nspm;
  const double impact_N = force_on_N + loop.stiffness_Npm * speed_mps * (loop.blind_s() + law_s);
  return std::max(impact_N, kProbeOverOn * force_on_N);
}

}  // namespace tenon

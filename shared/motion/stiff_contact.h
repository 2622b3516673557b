#pragma once
// What a stiff contact asks of the admittance law and of the speed of a touch. A force is measured,
// travels to the executor, becomes a setpoint and then motion; for all that time the arm drives on.

#include "shared/cell/cell.h"
#include "shared/motion/move_parameters.h"

namespace tenon {

/// For so many cycles guarded moves take no samples after one late wake-up or missing answer: the
/// drives ran out of setpoints, stop and go on in three, and what the sensor felt of that comes
/// `delay_cycles` later. @param delay_cycles n, age of a force sample when it is used
[[nodiscard]] constexpr int shaken_cycles(int delay_cycles) { return 3 + delay_cycles; }

/// The way from a force at the tool to the motion that answers it, and what it leans on.
struct ContactLoop {
  /// k_e: force per commanded motion into the contact. The environment's own stiffness in series
  /// with the arm's and the sensor's, so at most the weakest of the three.
  double stiffness_Npm = 5e4;
  double cycle_s = 2e-3;  ///< T
  int delay_cycles = 1;   ///< n, age of a force sample when it is used
  double lag_s = 0.0;     ///< tau_arm, from a setpoint to the motion; two cycles are CANopen's own
  int sample_cycles = 1;  ///< m, a new force sample every so many cycles

  /// tau = (n + m/2) T + tau_arm; half of the time for which a sample is held.
  [[nodiscard]] double latency_s() const {
    return (delay_cycles + 0.5 * sample_cycles) * cycle_s + lag_s;
  }
  /// (n + m) T + (n + 3) T + tau_arm: the longest time from F_on at the tool to the stop's first
  /// effect, with a late wake-up just before the touch. More of them at one touch are the force
  /// fault's.
  [[nodiscard]] double blind_s() const {
    return (delay_cycles + sample_cycles + shaken_cycles(delay_cycles)) * cycle_s + lag_s;
  }
};

/// Of a cell. k_e is the cell file's contact_stiffness_Npm, which by definition already is the
/// series of contact, arm and sensor: what `tenon-exec --identify-contact` measures.
[[nodiscard]] ContactLoop contact_loop(const Cell& cell);

/// 1.5 k_e tau, Ns/m: the least D with which pressing settles. Against a spring the law is an
/// integrator of gain k_e / D behind a dead time tau, which oscillates for ever at
/// D = (2 / pi) k_e tau and just not at all at e k_e tau; 1.5 leaves a gain margin of 2.4.
[[nodiscard]] double damping_least_Nspm(const ContactLoop& loop);

/// D tau, kg: with more virtual mass the law's own time constant M / D exceeds the dead time and
/// uses up that margin.
[[nodiscard]] double mass_most_kg(const ContactLoop& loop, double damping_Nspm);

/// What the force can rise to when the tool meets the contact at a speed, N: the larger of
/// F_on + k_e v ((2 n + m + 3) T + tau_arm + M / D) and 1.5 F_on, with which a guarded move presses
/// while it confirms a contact. The second counts for gentle touches alone. Measured against the
/// virtual arm in tests/chain/contact_force_test.cpp.
[[nodiscard]] double peak_force_N(const ContactLoop& loop, const Compliance& compliance,
                                  double force_on_N, double speed_mps);

}  // namespace tenon

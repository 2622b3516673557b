#include "executor/dry_run/plan_check.h"

#include <utility>

#include "shared/base/text.h"
#include "shared/motion/stiff_contact.h"

namespace tenon::executor {
namespace {

class Checker {
 public:
  Checker(const Plan& plan, const Cell& cell)
      : plan_(plan), cell_(cell), loop_(contact_loop(cell)) {}

  std::vector<std::string> run() {
    check_latency();
    check_compliance();
    for (std::size_t i = 0; i < plan_.parameter_sets.size(); ++i) check_set(i);
    return refusals_;
  }

 private:
  void refuse(std::string why) { refusals_.push_back(std::move(why)); }

  void check_latency() {
    if (loop_.latency_s() <= plan_.latency_max_s * kPlanRounding) return;
    refuse(format(
        "latency (n + 1/2) T + tau_arm = (%d + 0.5) * %g + %g = %g s, the plan allows at most %g s",
        loop_.delay_cycles, loop_.cycle_s, loop_.lag_s, loop_.latency_s(), plan_.latency_max_s));
  }

  void check_compliance() {
    const Compliance& c = plan_.compliance;
    const double damping_least = damping_least_Nspm(loop_);
    if (c.damping_Nspm * kPlanRounding < damping_least) {
      refuse(format("damping D = %g Ns/m, must be at least 1.5 k_e tau = 1.5 * %g * %g = %g Ns/m",
                    c.damping_Nspm, loop_.stiffness_Npm, loop_.latency_s(), damping_least));
    }
    const double mass_most = mass_most_kg(loop_, c.damping_Nspm);
    if (c.mass_kg > mass_most * kPlanRounding) {
      refuse(format("mass M = %g kg, must be at most D tau = %g * %g = %g kg", c.mass_kg,
                    c.damping_Nspm, loop_.latency_s(), mass_most));
    }
    if (plan_.force_limit_N > cell_.force_fault_N) {
      refuse(format("force_limit = %g N, must be at most the cell's force_fault_N = %g N",
                    plan_.force_limit_N, cell_.force_fault_N));
    }
  }

  void check_set(std::size_t index) {
    const ParameterSet& set = plan_.parameter_sets[index];
    const Compliance& c = plan_.compliance;
    const double force_on_N = set.thresholds.force_on_N;
    const double contact_mps = set.speeds.contact_mps;
    const double peak_N = peak_force_N(loop_, c, force_on_N, contact_mps);
    if (!(peak_N <= cell_.force_fault_N)) {
      refuse(format(
          "parameter set %d: peak force F_on + k_e v ((n + 1) T + tau_arm + M / D) = %g + %g * %g "
          "* (%g + %g + %g) = %g N, must be at most force_fault_N = %g N",
          static_cast<int>(index), force_on_N, loop_.stiffness_Npm, contact_mps,
          (loop_.delay_cycles + 1) * loop_.cycle_s, loop_.lag_s, c.mass_kg / c.damping_Nspm, peak_N,
          cell_.force_fault_N));
    }
    const double noise_N = cell_.robot.sensor.force_noise_N;
    if (force_on_N * kPlanRounding < 5.0 * noise_N) {
      refuse(format("parameter set %d: force_on = %g N, must be at least 5 sigma = 5 * %g = %g N",
                    static_cast<int>(index), force_on_N, noise_N, 5.0 * noise_N));
    }
  }

  const Plan& plan_;
  const Cell& cell_;
  ContactLoop loop_;
  std::vector<std::string> refusals_;
};

}  // namespace

std::vector<std::string> check_plan(const Plan& plan, const Cell& cell) {
  return Checker(plan, cell).run();
}

}  // namespace tenon::executor

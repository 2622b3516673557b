#include "executor/dry_run/plan_check.h"

#include <cmath>
#include <utility>

#include "executor/dry_run/plan_reach.h"
#include "shared/base/text.h"
#include "shared/motion/stiff_contact.h"

namespace tenon::executor {
namespace {

// What the sensor feels of the payload's turning is taken off only as far as the motion is known:
// the virtual inertia must outweigh it. On csp6 1.65 times is quiet in free air, 1.32 times is not
// (tests/chain/free_air_test.cpp).
constexpr double kPayloadMargin = 1.5;

class Checker {
 public:
  Checker(const Plan& plan, const Cell& cell)
      : plan_(plan), cell_(cell), loop_(contact_loop(cell)), rotary_(loop_) {
    rotary_.stiffness_Npm = cell.contact_stiffness_Nmpr;
  }

  std::vector<std::string> run() {
    check_envelopes();
    check_friction();
    check_latency();
    check_compliance();
    if (turns()) check_turning();
    for (std::size_t i = 0; i < plan_.parameter_sets.size(); ++i) check_set(i);
    for (std::size_t i = 0; i < plan_.steps.size(); ++i) check_watch(i);
    check_end();
    return refusals_;
  }

 private:
  void refuse(std::string why) { refusals_.push_back(std::move(why)); }

  // The planner writes them into every plan that its search has found.
  void check_envelopes() {
    if (plan_.check_envelopes || plan_.method != PlanMethod::kMha) return;
    refuse(
        "the plan has no envelopes, and its method, mha, always writes them: it was changed since "
        "it was made; plan again");
  }

  void check_friction() {
    if (!cell_.joint_torque || !cell_.joint_torque->joints.empty()) return;
    refuse(
        "the joints' efforts are to tell the force, and friction of the drives is not known; let "
        "tenon-exec --identify-friction FILE write it, and name it: joint_torque: {friction: "
        "FILE}");
  }

  void check_latency() {
    if (loop_.latency_s() <= plan_.latency_max_s * kPlanRounding) return;
    refuse(format(
        "latency (n + m/2) T + tau_arm = (%d + %g) * %g + %g = %g s, the plan allows at most %g s",
        loop_.delay_cycles, 0.5 * loop_.sample_cycles, loop_.cycle_s, loop_.lag_s,
        loop_.latency_s(), plan_.latency_max_s));
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

  [[nodiscard]] bool turns() const { return plan_.compliance.compliant_axes >> 3 != 0; }

  // The same law about the tool tip. What a turn meets is known where the cell says so; the payload
  // is there always.
  void check_turning() {
    const Compliance& c = plan_.compliance;
    if (rotary_.stiffness_Npm > 0.0) {
      const double damping_least = damping_least_Nspm(rotary_);
      if (c.damping_Nmspr * kPlanRounding < damping_least) {
        refuse(
            format("rotary damping D = %g Nm s/rad, must be at least 1.5 k_e tau = 1.5 * %g * %g "
                   "= %g Nm s/rad",
                   c.damping_Nmspr, rotary_.stiffness_Npm, rotary_.latency_s(), damping_least));
      }
      const double inertia_most = mass_most_kg(rotary_, c.damping_Nmspr);
      if (c.inertia_kgm2 > inertia_most * kPlanRounding) {
        refuse(format("inertia = %g kg m^2, must be at most D tau = %g * %g = %g kg m^2",
                      c.inertia_kgm2, c.damping_Nmspr, rotary_.latency_s(), inertia_most));
      }
    }
    const Vector3 tip_S_m = compose(inverse(cell_.X_FS), cell_.X_FP).position_m;
    const double lever_m = (cell_.payload_com_m - tip_S_m).norm();
    const double inertia_least = kPayloadMargin * cell_.payload_mass_kg * lever_m * lever_m;
    if (c.inertia_kgm2 * kPlanRounding < inertia_least) {
      refuse(
          format("inertia = %g kg m^2, must be at least %g m r^2 = %g * %g * %g^2 = %g kg m^2 of "
                 "the payload about the tool tip",
                 c.inertia_kgm2, kPayloadMargin, kPayloadMargin, cell_.payload_mass_kg, lever_m,
                 inertia_least));
    }
    if (plan_.torque_limit_Nm > cell_.torque_fault_Nm) {
      refuse(format("torque_limit = %g Nm, must be at most the cell's torque_fault_Nm = %g Nm",
                    plan_.torque_limit_Nm, cell_.torque_fault_Nm));
    }
  }

  void check_turning_set(std::size_t index) {
    const ParameterSet& set = plan_.parameter_sets[index];
    const Compliance& c = plan_.compliance;
    if ((c.compliant_axes & set.sensed_axes) >> 3 == 0) return;  // no torque is waited for
    const double torque_on_Nm = set.thresholds.torque_on_Nm;
    const double noise_Nm = cell_.robot.sensor.torque_noise_Nm;
    if (torque_on_Nm * kPlanRounding < 5.0 * noise_Nm) {
      refuse(
          format("parameter set %d: torque_on = %g Nm, must be at least 5 sigma = 5 * %g = %g Nm",
                 static_cast<int>(index), torque_on_Nm, noise_Nm, 5.0 * noise_Nm));
    }
    const double law_s = c.inertia_kgm2 / c.damping_Nmspr;
    const double peak_Nm = torque_on_Nm + rotary_.stiffness_Npm * set.speeds.contact_radps *
                                              (rotary_.blind_s() + law_s);
    if (!(peak_Nm <= cell_.torque_fault_Nm)) {
      refuse(format(
          "parameter set %d: peak torque T_on + k_e w ((2 n + m + 3) T + tau_arm + I / D) = %g + "
          "%g * %g * %g = %g Nm, must be at most torque_fault_Nm = %g Nm",
          static_cast<int>(index), torque_on_Nm, rotary_.stiffness_Npm, set.speeds.contact_radps,
          rotary_.blind_s() + law_s, peak_Nm, cell_.torque_fault_Nm));
    }
  }

  // Of what pushes against the step itself, every axis must be watched.
  void check_watch(std::size_t index) {
    const Step& step = plan_.steps[index];
    const ParameterSet& set = plan_.parameter_sets[step.parameter_set];
    const ContactSignature mask = set.trigger_mask;
    for (int axis = 0; axis < 6; ++axis) {
      if (step.displacement[axis] == 0.0) continue;
      const int push = step.displacement[axis] > 0.0 ? -1 : 1;
      const bool yields = (plan_.compliance.compliant_axes >> axis & 1U) != 0;
      // A rotation may go unsensed: what turns the tool is not waited for.
      const bool feels = yields && (axis >= 3 || (set.sensed_axes >> axis & 1U) != 0);
      if (feels && mask.has(axis, push)) continue;
      const std::string way = format("step %d moves along %c%s, ", static_cast<int>(index),
                                     push > 0 ? '-' : '+', axis_name(axis));
      refuse(way +
             (feels ? "and its trigger mask (" + to_string(mask) + ") lacks " +
                          to_string(ContactSignature{ContactSignature::bit(axis, push)})
              : yields ? "which is not sensed (sensed: " + axis_list(set.sensed_axes) + ")"
                       : "which does not yield (compliant: " +
                             axis_list(plan_.compliance.compliant_axes) + ")") +
             ": a contact there would not be noticed");
    }
  }

  // A plan whose ways do not end about its goal was made for another, or changed since.
  void check_end() {
    const auto reach = done_reach(plan_);
    if (!reach) return;
    const auto gap = goal_gap(plan_, *reach, plan_.goal, 0.0, 0.0);
    if (!gap) return;
    const double from = gap->axis < 3 ? plan_.start.position_m[gap->axis] : 0.0;
    refuse(
        format("the steps lead to %s = [%.4f, %.4f] %s, the plan's goal is at %.4f: it was changed "
               "since it was made",
               axis_name(gap->axis), from + reach->low[gap->axis], from + reach->high[gap->axis],
               axis_unit(gap->axis), gap->goal));
  }

  void check_set(std::size_t index) {
    if (turns()) check_turning_set(index);
    const ParameterSet& set = plan_.parameter_sets[index];
    const Compliance& c = plan_.compliance;
    const double force_on_N = set.thresholds.force_on_N;
    const double contact_mps = set.speeds.contact_mps;
    const double peak_N = peak_force_N(loop_, c, force_on_N, contact_mps);
    if (!(peak_N <= cell_.force_fault_N)) {
      refuse(format(
          "parameter set %d: peak force F_on + k_e v ((2 n + m + 3) T + tau_arm + M / D) = %g + "
          "%g * %g "
          "* (%g + %g + %g) = %g N, must be at most force_fault_N = %g N",
          static_cast<int>(index), force_on_N, loop_.stiffness_Npm, contact_mps,
          loop_.blind_s() - loop_.lag_s, loop_.lag_s, c.mass_kg / c.damping_Nspm, peak_N,
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
  ContactLoop rotary_;  ///< the same in Nm and rad; no stiffness: not known
  std::vector<std::string> refusals_;
};

}  // namespace

std::vector<std::string> check_plan(const Plan& plan, const Cell& cell) {
  return Checker(plan, cell).run();
}

}  // namespace tenon::executor

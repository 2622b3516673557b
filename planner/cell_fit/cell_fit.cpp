#include "planner/cell_fit/cell_fit.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "shared/base/error.h"
#include "shared/base/text.h"
#include "shared/joint_torque/pose_resolution.h"
#include "shared/motion/rules.h"
#include "shared/motion/stiff_contact.h"

namespace tenon::planner {
namespace {

constexpr double kDampingMargin = 1.1;
// Of the force fault; the rest is for the sensor's noise and for what the formula leaves out.
constexpr double kPeakShare = 0.8;
// A guarded move takes a tool below 1 mm/s for blocked, so that a touch must be clearly faster.
constexpr double kContactSpeedMin_mps = 2e-3;
constexpr double kNoiseDeviations = 5.0;
constexpr double kNoiseMargin = 1.05;
// Of what joints resolve at starts and goal: between them, and in another of the arm's ways to hold
// the tool, they may resolve less.
constexpr double kResolutionMargin = 1.2;
// A contact is confirmed by three samples in a row, however long they take.
constexpr std::uint32_t kDebouncePeriods = 2;
constexpr double kTimeoutMax_us = 600e6;

/// How far from the tool's tip the held part may be touched, m.
double touch_lever_m(const Task& task) {
  double lever_m = 0.0;
  for (const Shape& shape : task.held) {
    for (int corner = 0; corner < 8; ++corner) {
      const Vector3 signs((corner & 1) != 0 ? 0.5 : -0.5, (corner & 2) != 0 ? 0.5 : -0.5,
                          (corner & 4) != 0 ? 0.5 : -0.5);
      const Vector3 at_m =
          shape.pose.position_m + shape.pose.orientation * signs.cwiseProduct(shape.size_m).eval();
      lever_m = std::max(lever_m, at_m.norm());
    }
  }
  return lever_m;
}

/// What a touch may rise to, and which of the cell's faults has it so.
struct PeakBound {
  double force_N;
  std::string of_what;
};

PeakBound peak_bound(const Task& task, const Cell& cell) {
  const double lever_m = touch_lever_m(task);
  const double by_torque_N = cell.torque_fault_Nm / lever_m;
  if (by_torque_N >= cell.force_fault_N) {
    return {kPeakShare * cell.force_fault_N,
            format("%g of faults.force_N = %g N", kPeakShare, cell.force_fault_N)};
  }
  return {kPeakShare * by_torque_N,
          format("%.3g N: %g of faults.torque_Nm = %g Nm, %.3g m from the tip, where the part ends",
                 kPeakShare * by_torque_N, kPeakShare, cell.torque_fault_Nm, lever_m)};
}

class Fitting {
 public:
  Fitting(const Task& task, const Cell& cell) : cell_(cell), loop_(contact_loop(cell)) {
    fit_.task = task;
    fit_.assumptions = {loop_.stiffness_Npm, loop_.latency_s()};
  }

  CellFit run() {
    fit_debounce();
    fit_resolution();
    fit_thresholds();
    fit_compliance();
    fit_contact_speed();
    return std::move(fit_);
  }

 private:
  void note(std::string change) { fit_.changes.push_back(std::move(change)); }

  [[noreturn]] void refuse(const std::string& why) const {
    throw InputError("cell '" + cell_.name + "' cannot execute task '" + fit_.task.name +
                     "': " + why);
  }

  void fit_debounce() {
    std::uint32_t& debounce_us = fit_.task.motion.thresholds.debounce_us;
    const auto sample_cycles = static_cast<std::uint32_t>(cell_.robot.sensor.cycles_per_sample);
    const std::uint32_t least_us = kDebouncePeriods * sample_cycles * cell_.robot.cycle_us;
    if (debounce_us >= least_us) return;
    note(format("debounce %g -> %g ms: at least two samples of %g ms", 1e-3 * debounce_us,
                1e-3 * least_us, 1e3 * sample_period_s(cell_.robot)));
    debounce_us = least_us;
  }

  // Where joints tell the force, its off-threshold is what they have to resolve.
  void fit_resolution() {
    if (!cell_.joint_torque) return;
    if (cell_.joint_torque->joints.empty()) {
      refuse("its joint_torque has no friction file; let tenon-exec --identify-friction write one");
    }
    Task& task = fit_.task;
    Vector6 resolution = Vector6::Zero();
    std::vector<Pose> tools = {task.goal};
    for (const Start& start : task.starts) tools.push_back(start.pose);
    for (const Pose& tool : tools) {
      if (const auto here = resolution_at(cell_, tool)) resolution = resolution.cwiseMax(*here);
    }
    ContactThresholds& t = task.motion.thresholds;
    const unsigned axes = task.compliance.compliant_axes;
    const double force_N = kResolutionMargin * coarsest(resolution, axes & 0x07U);
    if (t.force_off_N < force_N) {
      note(format("force_off %g -> %.3g N, keep and on with it: the joints' efforts resolve %.3g N",
                  t.force_off_N, force_N, force_N / kResolutionMargin));
      force_cause_ = format("; that follows from the %.3g N that the joints' efforts resolve",
                            force_N / kResolutionMargin);
      t.force_on_N *= force_N / t.force_off_N;
      t.force_keep_N *= force_N / t.force_off_N;
      t.force_off_N = force_N;
    }
    const double torque_Nm = kResolutionMargin * coarsest(resolution, axes & 0x38U);
    if (t.torque_off_Nm < torque_Nm) {
      note(
          format("torque_off %g -> %.3g Nm, keep and on with it: the joints' efforts resolve %.3g "
                 "Nm",
                 t.torque_off_Nm, torque_Nm, torque_Nm / kResolutionMargin));
      t.torque_on_Nm *= torque_Nm / t.torque_off_Nm;
      t.torque_keep_Nm *= torque_Nm / t.torque_off_Nm;
      t.torque_off_Nm = torque_Nm;
    }
  }

  [[nodiscard]] double coarsest(const Vector6& resolution, unsigned axes) const {
    double coarsest = 0.0;
    for (int axis = 0; axis < 6; ++axis) {
      if ((axes >> axis & 1U) == 0) continue;
      if (!std::isfinite(resolution[axis])) {
        refuse(format("the joints' efforts tell nothing about %s", axis_name(axis)));
      }
      coarsest = std::max(coarsest, resolution[axis]);
    }
    return coarsest;
  }

  void fit_thresholds() {
    Task& task = fit_.task;
    ContactThresholds& t = task.motion.thresholds;
    const double noise_N = cell_.robot.sensor.force_noise_N;
    if (t.force_on_N < kNoiseDeviations * noise_N) {
      const double raised_N = kNoiseMargin * kNoiseDeviations * noise_N;
      note(format("force_on %g -> %g N, keep and off with it: the sensor's noise is %g N",
                  t.force_on_N, raised_N, noise_N));
      t.force_keep_N *= raised_N / t.force_on_N;
      t.force_off_N *= raised_N / t.force_on_N;
      t.force_on_N = raised_N;
    }
    const double limit_least_N = kProbeOverOn * t.force_on_N;
    if (task.force_limit_N < limit_least_N) {
      note(format("force_limit %g -> %g N: %g force_on", task.force_limit_N, limit_least_N,
                  kProbeOverOn));
      task.force_limit_N = limit_least_N;
    }
    if (task.force_limit_N > cell_.force_fault_N) {
      refuse(format("force_limit = %g N, must be at most the cell's faults.force_N = %g N",
                    task.force_limit_N, cell_.force_fault_N) +
             force_cause_);
    }
    ContactConditions conditions;
    conditions.friction_max = task.friction.high;
    conditions.force_noise_N = noise_N;
    if (const auto rule =
            broken_rule(t, task.force_limit_N, task.motion.speeds.acceleration_mps2, conditions)) {
      refuse(*rule);
    }
  }

  void fit_compliance() {
    Compliance& c = fit_.task.compliance;
    const double damping_least = damping_least_Nspm(loop_);
    if (c.damping_Nspm < damping_least) {
      const double raised = kDampingMargin * damping_least;
      note(format("damping %g -> %.4g Ns/m: at least 1.5 k_e tau = 1.5 * %g * %g = %.4g",
                  c.damping_Nspm, raised, loop_.stiffness_Npm, loop_.latency_s(), damping_least));
      c.damping_Nspm = raised;
    }
    const double mass_most = mass_most_kg(loop_, c.damping_Nspm);
    if (c.mass_kg > mass_most) {
      note(format("mass %g -> %.4g kg: at most D tau = %.4g * %g", c.mass_kg, mass_most,
                  c.damping_Nspm, loop_.latency_s()));
      c.mass_kg = mass_most;
    }
  }

  void fit_contact_speed() {
    Task& task = fit_.task;
    SpeedLimits& speeds = task.motion.speeds;
    const double force_on_N = task.motion.thresholds.force_on_N;
    const PeakBound most = peak_bound(task, cell_);
    const double peak_N = peak_force_N(loop_, task.compliance, force_on_N, speeds.contact_mps);
    if (peak_N <= most.force_N) return;

    const double seconds = loop_.blind_s() + task.compliance.mass_kg / task.compliance.damping_Nspm;
    const double lowered_mps = (most.force_N - force_on_N) / (loop_.stiffness_Npm * seconds);
    if (!(lowered_mps >= kContactSpeedMin_mps)) {
      refuse(format("contact_mps would have to be %.3g for a peak force of at most %s, with "
                    "force_on %g N, k_e = %g N/m and %.3g s to stop; must be at least %g",
                    lowered_mps, most.of_what.c_str(), force_on_N, loop_.stiffness_Npm, seconds,
                    kContactSpeedMin_mps) +
             force_cause_);
    }
    note(
        format("contact speed %g -> %.4g m/s: the peak force F_on + k_e v ((2 n + m + 3) T + "
               "tau_arm + M / D) "
               "= %g + %g * v * %.4g was %.3g N, now %s",
               speeds.contact_mps, lowered_mps, force_on_N, loop_.stiffness_Npm, seconds, peak_N,
               most.of_what.c_str()));
    stretch_timeout(speeds.contact_mps / lowered_mps);
    speeds.contact_mps = lowered_mps;
  }

  void stretch_timeout(double factor) {
    std::uint32_t& timeout_us = fit_.task.motion.timeout_us;
    const double longer_us = std::min(factor * timeout_us, kTimeoutMax_us);
    note(format("timeout %g -> %.4g s: as much longer as the contact speed is lower",
                1e-6 * timeout_us, 1e-6 * longer_us));
    timeout_us = static_cast<std::uint32_t>(longer_us);
  }

  const Cell& cell_;
  ContactLoop loop_;
  CellFit fit_;
  std::string force_cause_;  // of thresholds that were raised, for whom they are too high then
};

}  // namespace

CellFit fit_to_cell(const Task& task, const Cell& cell) { return Fitting(task, cell).run(); }

}  // namespace tenon::planner

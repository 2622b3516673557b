// How hard the tool meets a wall: the whole chain against the virtual arm, the truth's own peak
// force against the formula that plans and cells are checked with.

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <numeric>
#include <random>
#include <string>
#include <vector>

#include "executor/dry_run/plan_check.h"
#include "shared/motion/stiff_contact.h"
#include "shared/system/fan_out.h"
#include "tests/support/planned.h"
#include "tests/support/whole_run.h"

namespace tenon::tests {
namespace {

constexpr double kGap_m = 4e-3;
constexpr std::size_t kTouches = 10;

// A small cube on air, a wall in front of its +x face.
Task wall_task() {
  Task task;
  task.name = "wall";
  task.coordinates = 0x03;
  Shape wall{"wall", Shape::Kind::kBox, {0.1, 0.4, 0.4}, {}};
  wall.pose.position_m.x() = 0.02 + kGap_m + 0.05;
  task.held = {{"cube", Shape::Kind::kBox, {0.04, 0.04, 0.04}, {}}};
  task.environment = {wall};
  task.starts = {{"before the wall", {}, Vector6::Zero()}};
  return task;
}

// The gantry, so stiff and late; nothing but the formula stops it.
Cell cell_with(double contact_stiffness_Npm, std::uint32_t cycle_us, double lag_s) {
  Cell cell = gantry_cell();
  cell.contact_stiffness_Npm = contact_stiffness_Npm;
  cell.force_fault_N = 290.0;
  cell.robot.cycle_us = cycle_us;
  cell.robot.response_lag_s = lag_s;
  for (Joint& joint : cell.robot.joints) joint.following_error_max = 0.02;
  return cell;
}

Step step_along(int axis, double way_m, Outcome expected, Successor next) {
  Step step;
  step.displacement[axis] = way_m;
  step.outcomes[static_cast<std::size_t>(expected)].successor = next;
  return step;
}

Plan plan_without_steps(const Compliance& compliance, double speed_mps) {
  Plan plan;
  plan.task_name = "wall";
  plan.start_name = "before the wall";
  plan.coordinates = 0x03;
  plan.compliance = compliance;
  plan.compliance.compliant_axes = 0x03;
  plan.latency_max_s = 1.0;
  plan.method = PlanMethod::kSingleParticle;
  plan.check_envelopes = false;
  ParameterSet set;
  set.speeds.contact_mps = set.speeds.approach_mps = speed_mps;
  set.timeout_us = 60'000'000;
  plan.parameter_sets = {set};
  return plan;
}

// --- the formula --------------------------------------------------------------------------------

struct Contacts {
  Cell cell;
  Compliance compliance;
  double contact_mps = 0.0;
  // What came of it.
  double peak_N = 0.0;
  double formula_N = 0.0;
  std::size_t touches = 0;
  std::string reason;
  bool late = false;  ///< the loop wakes up late at every touch, just before its contact is felt
};

// Touches the wall and leaves it, again and again.
Plan touching_plan(const Contacts& contacts) {
  Plan plan = plan_without_steps(contacts.compliance, contacts.contact_mps);
  for (std::size_t i = 0; i < 2 * kTouches; ++i) {
    const Successor next = i + 1 == 2 * kTouches ? kSuccessorDone : static_cast<Successor>(i + 1);
    plan.steps.push_back(i % 2 == 0 ? step_along(0, 4.0 * kGap_m, Outcome::kContact, next)
                                    : step_along(0, -kGap_m, Outcome::kReached, next));
  }
  return plan;
}

// Blind from the sample on that is the first to feel the wall.
WholeRun::Result run_late_at_touches(WholeRun& run, double cycle_m) {
  bool touched = false;
  if (!run.prepare()) return run.result();
  while (run.cycle()) {
    const bool touches = run.controller().record().pose.position_m[0] > kGap_m - cycle_m;
    if (touches && !touched) run.controller().distrust_samples();
    touched = touches;
  }
  return run.result();
}

void touch(Contacts& contacts, std::uint64_t seed) {
  const Plan plan = touching_plan(contacts);
  for (const std::string& refusal : executor::check_plan(plan, contacts.cell)) {
    contacts.reason += refusal;
  }
  WholeRun::Options options;
  options.seed = seed;
  WholeRun run(contacts.cell, wall_task(), plan, options);
  const auto result =
      contacts.late
          ? run_late_at_touches(run, 1e-6 * contacts.cell.robot.cycle_us * contacts.contact_mps)
          : run.run();
  contacts.peak_N = result.truth.contact_force_N_max;
  contacts.formula_N =
      peak_force_N(contact_loop(contacts.cell), contacts.compliance,
                   plan.parameter_sets[0].thresholds.force_on_N, contacts.contact_mps);
  if (result.ending.reason != executor::EndReason::kPlanDone) contacts.reason += result.reason;
  const executor::PlanRunner& runner = run.controller().runner();
  for (std::size_t i = 0; i < runner.report_count(); ++i) {
    contacts.touches += runner.report(i).result.outcome == Outcome::kContact;
  }
}

// Stiffness evenly in its logarithm; lag evenly, but no less than the two cycles in which a target
// is taken up and interpolated (a cell file that claims less is 20 % below the truth); damping and
// mass anywhere that the inequalities leave, touches from gentle to hard.
std::vector<Contacts> draw_contacts(std::size_t count) {
  std::mt19937_64 random(1);
  const auto uniform = [&](double low, double high) {
    return low + (high - low) * static_cast<double>(random() >> 11) * 0x1.0p-53;
  };
  constexpr std::array<std::uint32_t, 4> kCycles_us = {2000, 4000, 5000, 10000};
  constexpr double kDampingMin_Nspm = 300.0;
  std::vector<Contacts> all;
  for (std::size_t i = 0; i < count; ++i) {
    Contacts c;
    const double stiffness_Npm = 5e3 * std::pow(20.0, uniform(0.0, 1.0));
    const std::uint32_t cycle_us = kCycles_us[random() % kCycles_us.size()];
    const double lag_s = std::max(2e-6 * cycle_us, uniform(0.0, 0.020));
    c.cell = cell_with(stiffness_Npm, cycle_us, lag_s);
    const ContactLoop loop = contact_loop(c.cell);
    c.compliance.damping_Nspm =
        std::max(kDampingMin_Nspm, uniform(1.0, 1.5) * damping_least_Nspm(loop));
    c.compliance.mass_kg = uniform(0.1, 1.0) * mass_most_kg(loop, c.compliance.damping_Nspm);
    const double impact_N = i % 4 == 0 ? uniform(0.1, 4.0) : uniform(4.0, 54.0);
    const double seconds = loop.blind_s() + c.compliance.mass_kg / c.compliance.damping_Nspm;
    c.contact_mps = std::clamp(impact_N / (stiffness_Npm * seconds), 2e-3, 0.1);
    all.push_back(c);
  }
  return all;
}

void expect_below_the_formula(std::vector<Contacts> all) {
  fan_out(all.size(), 2, [&](std::size_t i, std::size_t /*worker*/) { touch(all[i], i); });

  std::size_t touches = 0;
  double most = 0.0;
  double sum = 0.0;
  for (const Contacts& c : all) {
    touches += c.touches;
    most = std::max(most, c.peak_N / c.formula_N);
    sum += c.peak_N / c.formula_N;
    EXPECT_LE(c.peak_N, c.formula_N)
        << "cycle " << c.cell.robot.cycle_us << " us, lag " << c.cell.robot.response_lag_s
        << " s, k_e " << c.cell.contact_stiffness_Npm << " N/m, D " << c.compliance.damping_Nspm
        << " Ns/m, M " << c.compliance.mass_kg << " kg, " << c.contact_mps << " m/s";
    EXPECT_EQ(c.reason, "");
  }
  EXPECT_EQ(touches, 10 * all.size());
  std::printf("%zu touches: peak force over the formula's, mean %.2f, largest %.2f\n", touches,
              sum / static_cast<double>(all.size()), most);
}

// Where a release needs it (label full).
TEST(ContactForce, AThousandTouchesStayBelowTheFormula) {
  expect_below_the_formula(draw_contacts(100));
}

TEST(ContactForce, EightyTouchesStayBelowTheFormula) { expect_below_the_formula(draw_contacts(8)); }

// What one late wake-up adds is in the formula.
TEST(ContactForce, TouchesThatALateWakeUpHidesPressHarderAndStayBelowTheFormula) {
  constexpr std::size_t kCount = 5;
  std::vector<Contacts> all = draw_contacts(kCount);
  for (std::size_t i = 0; i < kCount; ++i) {
    all.push_back(all[i]);
    all.back().late = true;
  }
  fan_out(all.size(), 2, [&](std::size_t i, std::size_t /*worker*/) { touch(all[i], i % kCount); });
  std::size_t harder = 0;
  for (std::size_t i = 0; i < kCount; ++i) {
    const Contacts& late = all[kCount + i];
    EXPECT_GE(late.peak_N, all[i].peak_N) << late.contact_mps << " m/s";
    harder += late.peak_N > all[i].peak_N ? 1 : 0;
    EXPECT_LE(late.peak_N, late.formula_N) << late.contact_mps << " m/s";
    EXPECT_EQ(late.reason, "");
    std::printf("touch at %.4f m/s: %.1f N, hidden %.1f N, by the formula %.1f N\n",
                late.contact_mps, all[i].peak_N, late.peak_N, late.formula_N);
  }
  // A gentle touch has not come to its threshold before the loop sees again.
  EXPECT_GT(harder, 0U);
}

// --- nobody watches -----------------------------------------------------------------------------

// The wall ends the move neither by a trigger nor by a stop: what presses then is the limit's.
TEST(ContactForce, APushThatNobodyWatchesStaysWithinLimitAndFormula) {
  const Cell cell = cell_with(5e4, 2000, 0.010);
  const Task task = wall_task();
  const ContactLoop loop = contact_loop(cell);
  Compliance compliance;
  compliance.mass_kg = 0.5;
  compliance.damping_Nspm = damping_least_Nspm(loop);
  // The limit is the push's; the truth counts its friction, too, and what answers to noise.
  const double with_friction = std::hypot(1.0, task.friction.nominal);
  const double noise_N = 3.0 * cell.robot.sensor.force_noise_N;
  for (const double speed_mps : {0.005, 0.02, 0.05, 0.1}) {
    Plan plan = plan_without_steps(compliance, speed_mps);
    plan.parameter_sets[0].trigger_mask = {};
    plan.steps = {step_along(0, 0.1, Outcome::kBlocked, kSuccessorDone)};
    WholeRun run(cell, task, plan, {});
    const auto result = run.run();
    const double limit_N = plan.force_limit_N * with_friction + noise_N;
    const double formula_N = peak_force_N(loop, plan.compliance,
                                          plan.parameter_sets[0].thresholds.force_on_N, speed_mps);
    EXPECT_LE(result.truth.contact_force_N_max, std::max(formula_N, limit_N))
        << "at " << speed_mps << " m/s";
    EXPECT_EQ(result.ending.reason, executor::EndReason::kPlanDone) << result.reason;
    std::printf("unwatched at %5.3f m/s: %.1f N, by the formula %.1f, limit %.1f\n", speed_mps,
                result.truth.contact_force_N_max, formula_N, limit_N);
  }
}

// --- the inequality ---------------------------------------------------------------------------

class Forces : public executor::CycleSink {
 public:
  void record(const executor::CycleRecord& record) noexcept override {
    if (record.moving && (!along_x_N.empty() || record.wrench[0] < -kTouch_N)) {
      along_x_N.push_back(record.wrench[0]);
    }
  }
  static constexpr double kTouch_N = 6.0;
  std::vector<double> along_x_N;  ///< from the first touch on
};

struct Pressing {
  Outcome outcome = Outcome::kReached;
  double early_N = 0.0;  ///< largest less smallest force, from 0.2 s after the touch to 0.7 s
  double late_N = 0.0;   ///< from 1.2 s after it to 1.7 s
  int turns = 0;         ///< crossings of the mean in that time
};

// Pushes against the wall with the force limit and looks for no contact: it ends blocked as soon as
// the tool rests, or after three seconds.
Pressing press(const Cell& cell, const Compliance& compliance) {
  Plan plan = plan_without_steps(compliance, 0.01);
  plan.parameter_sets[0].trigger_mask = {};
  plan.parameter_sets[0].timeout_us = 3'000'000;
  plan.steps = {step_along(0, 0.1, Outcome::kBlocked, kSuccessorDone)};
  Forces forces;
  WholeRun run(cell, wall_task(), plan, {}, &forces);
  (void)run.run();
  Pressing pressing;
  pressing.outcome = run.controller().runner().report(0).result.outcome;
  const std::vector<double>& f = forces.along_x_N;
  const auto samples = [&](double time_s) {
    return static_cast<std::ptrdiff_t>(1e6 * time_s / cell.robot.cycle_us);
  };
  const auto swing = [](auto begin, auto end) {
    const auto [least, most] = std::minmax_element(begin, end);
    return *most - *least;
  };
  if (static_cast<std::ptrdiff_t>(f.size()) < samples(1.7)) return pressing;
  pressing.early_N = swing(f.begin() + samples(0.2), f.begin() + samples(0.7));
  // Before the move has timed out: then the setpoint lets go of the wall.
  const auto late = f.begin() + samples(1.2);
  const auto end = f.begin() + samples(1.7);
  pressing.late_N = swing(late, end);
  const double mean_N = std::accumulate(late, end, 0.0) / static_cast<double>(end - late);
  for (auto at = late; at + 1 != end; ++at) {
    pressing.turns += (*at > mean_N) != (*(at + 1) > mean_N);
  }
  return pressing;
}

TEST(ContactForce, TooLittleDampingIsRefusedWithBothNumbersAndOscillatesWhenForced) {
  const Cell cell = cell_with(5e4, 2000, 0.010);
  const ContactLoop loop = contact_loop(cell);
  Compliance enough;
  enough.mass_kg = 0.5;
  enough.damping_Nspm = damping_least_Nspm(loop);
  Compliance little = enough;
  little.damping_Nspm = 0.2 * loop.stiffness_Npm * loop.latency_s();

  const std::vector<std::string> refusals =
      executor::check_plan(plan_without_steps(little, 0.005), cell);
  ASSERT_EQ(refusals.size(), 1U);
  EXPECT_EQ(refusals[0],
            "damping D = 130 Ns/m, must be at least 1.5 k_e tau = 1.5 * 50000 * 0.013 = 975 Ns/m");
  EXPECT_TRUE(executor::check_plan(plan_without_steps(enough, 0.005), cell).empty());

  const Pressing calm = press(cell, enough);
  const Pressing forced = press(cell, little);
  EXPECT_EQ(calm.outcome, Outcome::kBlocked) << "pressed until it rested";
  EXPECT_EQ(forced.outcome, Outcome::kTimeout) << "it never rested";
  EXPECT_GT(forced.early_N, 20.0);
  EXPECT_GE(forced.late_N, forced.early_N) << "it does not decay";
  EXPECT_GE(forced.turns, 8);
  std::printf("forced: %.0f N from peak to peak at first, %.0f N in the end, %d turns in 0.5 s\n",
              forced.early_N, forced.late_N, forced.turns);
}

}  // namespace
}  // namespace tenon::tests

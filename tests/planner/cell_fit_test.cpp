// What a cell changes in a task, and what it may not.

#include "planner/cell_fit/cell_fit.h"

#include <gtest/gtest.h>

#include <cmath>

#include "executor/dry_run/plan_check.h"
#include "planner/judge/plan_draft.h"
#include "shared/base/error.h"
#include "shared/motion/stiff_contact.h"
#include "tests/planner/room_task.h"
#include "tests/support/refusal.h"

namespace tenon::planner {
namespace {

Cell cell_with(std::uint32_t cycle_us, double lag_s, double contact_stiffness_Npm) {
  Cell cell;
  cell.name = "test";
  cell.robot.cycle_us = cycle_us;
  cell.robot.response_lag_s = lag_s;
  cell.contact_stiffness_Npm = contact_stiffness_Npm;
  cell.robot.sensor.force_noise_N = 0.1;
  return cell;
}

// A plan of one step as it would be drafted, of a method that writes no envelopes.
Plan plan_of(const CellFit& fit) {
  const std::vector<Vector6> way = {
      displacement_between(fit.task.starts.front().pose, fit.task.goal)};
  Plan plan = draft_plan(fit.task, fit.task.starts.front(), fit.assumptions, way);
  plan.method = PlanMethod::kSingleParticle;
  return plan;
}

TEST(CellFit, AFastCellChangesNothing) {
  const Task task = room_task();
  const CellFit fit = fit_to_cell(task, cell_with(2000, 0.004, 4e4));
  EXPECT_TRUE(fit.changes.empty());
  EXPECT_EQ(fit.task.compliance, task.compliance);
  EXPECT_EQ(fit.task.motion, task.motion);
  EXPECT_DOUBLE_EQ(fit.assumptions.latency_max_s, 0.007);
  EXPECT_DOUBLE_EQ(fit.assumptions.contact_stiffness_Npm, 4e4);
}

TEST(CellFit, ASlowCellGetsDampingSpeedAndDebounceThatTheExecutorAccepts) {
  const Task task = room_task();
  const Cell cell = cell_with(10'000, 0.020, 5e4);
  EXPECT_FALSE(executor::check_plan(plan_of({task, {5e4, 0.035}, {}}), cell).empty());
  const CellFit fit = fit_to_cell(task, cell);
  EXPECT_TRUE(executor::check_plan(plan_of(fit), cell).empty());
  // 1.1 * 1.5 * 5e4 * 35 ms; 48 N = 6 N + 5e4 * v * (20 + 40 + 20 ms + 2 / 2887.5), 40 ms for a
  // late wake-up
  EXPECT_NEAR(fit.task.compliance.damping_Nspm, 2887.5, 1e-9);
  EXPECT_EQ(fit.task.compliance.mass_kg, task.compliance.mass_kg);
  EXPECT_NEAR(fit.task.motion.speeds.contact_mps, 0.010410, 1e-6);
  EXPECT_EQ(fit.task.motion.thresholds.debounce_us, 20'000U);
  EXPECT_EQ(fit.task.motion.speeds.approach_mps, task.motion.speeds.approach_mps);
  // Every change is told, and the time limit grows as the speed falls.
  EXPECT_EQ(fit.changes.size(), 4U);
  EXPECT_NEAR(fit.task.motion.timeout_us / 10e6, 0.05 / 0.010410, 1e-3);
}

TEST(CellFit, MassComesDownToWhatTheLatencyAllows) {
  Task task = room_task();
  task.compliance.mass_kg = 50.0;
  const CellFit fit = fit_to_cell(task, cell_with(2000, 0.004, 2e4));
  EXPECT_DOUBLE_EQ(fit.task.compliance.mass_kg, 1500.0 * 0.007);
  EXPECT_EQ(fit.changes.size(), 1U);
}

TEST(CellFit, ANoisySensorRaisesAllThresholdsTogether) {
  const Task task = room_task();
  Cell cell = cell_with(2000, 0.004, 2e4);
  cell.robot.sensor.force_noise_N = 2.0;
  const CellFit fit = fit_to_cell(task, cell);
  const ContactThresholds& t = fit.task.motion.thresholds;
  EXPECT_DOUBLE_EQ(t.force_on_N, 10.5);
  EXPECT_DOUBLE_EQ(t.force_keep_N, 5.25);
  EXPECT_DOUBLE_EQ(t.force_off_N, 2.625);
  EXPECT_GE(fit.task.force_limit_N, 1.5 * t.force_on_N);
  EXPECT_TRUE(executor::check_plan(plan_of(fit), cell).empty());
}

TEST(CellFit, AContactThatOnlyACrawlCouldMeetIsRefusedWithItsNumbers) {
  // 48 N = 6 N + 1e6 * v * (100 ms + ...): less than a millimetre a second.
  const std::string text =
      tests::refusal([] { (void)fit_to_cell(room_task(), cell_with(10'000, 0.040, 1e6)); });
  EXPECT_NE(text.find("contact_mps would have to be 0.0004"), std::string::npos) << text;
  EXPECT_NE(text.find("at least 0.002"), std::string::npos) << text;
  EXPECT_NE(text.find("1e+06 N/m"), std::string::npos) << text;
}

// A force at the far end of what is held turns the hand by as much as it is away from the tip.
TEST(CellFit, ATouchFarFromTheTipStaysBelowTheTorqueFault) {
  Task task = room_task();
  const Shape bar{"bar", Shape::Kind::kBox, {0.02, 0.02, 0.48}, {.position_m = {0.0, 0.0, 0.24}}};
  task.held = {bar};
  Cell cell = cell_with(2000, 0.004, 4e4);
  cell.torque_fault_Nm = 12.0;
  const CellFit fit = fit_to_cell(task, cell);
  // 0.8 * 12 Nm / 0.4802 m = 19.99 N = 6 N + 4e4 * v * (seconds to stop)
  ASSERT_EQ(fit.changes.size(), 2U);
  EXPECT_NE(fit.changes[0].find("now 20 N: 0.8 of faults.torque_Nm = 12 Nm, 0.48 m from the tip"),
            std::string::npos)
      << fit.changes[0];
  const double peak_N = peak_force_N(contact_loop(cell), fit.task.compliance, 6.0,
                                     fit.task.motion.speeds.contact_mps);
  EXPECT_NEAR(peak_N * std::hypot(0.01, 0.01, 0.48), 0.8 * 12.0, 1e-9);
}

TEST(CellFit, AForceLimitBeyondTheCellsFaultIsRefused) {
  Cell cell = cell_with(2000, 0.004, 1e3);
  cell.force_fault_N = 15.0;
  EXPECT_THROW((void)fit_to_cell(room_task(), cell), InputError);
}

}  // namespace
}  // namespace tenon::planner

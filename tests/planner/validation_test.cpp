// What validation runs besides its draws.

#include "planner/judge/validation.h"

#include <gtest/gtest.h>

#include "tests/planner/room_plan.h"

namespace tenon::planner {
namespace {

PlanReport planned_by(std::size_t draws, const Task& task) {
  PlannerOptions options;
  options.draws = draws;
  return make_plan(task, task.starts.front(), WallRollout(room()), options, stopped_clock);
}

TEST(Validation, TheRimStandsWhereDrawingEndsAndCountsInNoStatistic) {
  const Task task = room_task();
  const PlanReport report = planned_by(20, task);
  ASSERT_EQ(report.status, PlanStatus::kPlanned) << report.reason;
  const Validation& validation = report.validation;
  const Start& start = task.starts.front();
  const double sigmas = task.particle_sigmas + 1.0;
  // Four tips and four corners, each slippery and rough.
  ASSERT_EQ(validation.rim.size(), 16U);
  for (const Draw& draw : validation.rim) {
    EXPECT_EQ(draw.mahalanobis, sigmas);
    const Vector3 off_m = draw.chain.start.pose.position_m - start.pose.position_m;
    EXPECT_NEAR(off_m.norm(), sigmas * start.sigma[0], 1e-12);
    EXPECT_TRUE(draw.at_goal);
  }
  EXPECT_EQ(validation.draws.size(), 20U);
  EXPECT_EQ(report.plan->draws, 20U);
  EXPECT_LE(validation.at_goal(), 20U);
  EXPECT_EQ(validation.good_chains().size(), validation.at_goal() + 16U);
}

TEST(Validation, AStartOnTheRimStaysWithinTheEnvelopesHoweverFewWereDrawn) {
  const Task task = room_task();
  const PlanReport report = planned_by(1, task);
  ASSERT_EQ(report.status, PlanStatus::kPlanned) << report.reason;
  const double reach_m = (task.particle_sigmas + 1.0) * task.starts.front().sigma[0];
  WallRollout rollout(room());
  for (const Vector3& way : {Vector3(1, 0, 0), Vector3(-1, 0, 0), Vector3(0, 1, 0),
                             Vector3(0, -1, 0), Vector3(0.6, 0.8, 0), Vector3(-0.8, 0.6, 0)}) {
    Particle particle;
    particle.pose = task.starts.front().pose;
    particle.pose.position_m += reach_m * way;
    const Chain chain = run_chain(rollout, *report.plan, particle, task.rollout_step_us);
    EXPECT_TRUE(chain.done) << chain.failure;
  }
}

TEST(Validation, AStartOnTheRimThatCollidesIsLeftOut) {
  Task task = room_task();
  // Three standard deviations end 2 mm before the wall at x = -0.5, four beyond it.
  task.particle_sigmas = 3.0;
  task.starts.front().sigma[0] = (0.5 - 0.23 - 2e-3) / 3.0;
  const PlanReport report = planned_by(20, task);
  ASSERT_EQ(report.status, PlanStatus::kPlanned) << report.reason;
  EXPECT_EQ(report.validation.rim.size(), 14U);
}

}  // namespace
}  // namespace tenon::planner

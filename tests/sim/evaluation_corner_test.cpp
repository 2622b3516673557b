// The corners of what a task leaves open, as worlds that every run of an evaluation meets.

#include <gtest/gtest.h>

#include "shared/base/error.h"
#include "sim/evaluation/corner.h"
#include "sim/evaluation/evaluation.h"

namespace tenon::sim {
namespace {

Task task() {
  Task task;
  task.coordinates = 0b101;
  task.held = {{"peg", Shape::Kind::kBox, {0.04, 0.04, 0.1}, {}}};
  task.friction = {0.1, 0.3, 0.6};
  task.oversize_m = 5e-4;
  Start start;
  start.sigma.head<3>() << 0.01, 0.0, 0.01;
  task.starts = {start};
  return task;
}

WorldDraw world_at(const std::string& corner, const WorldRanges& ranges = {}) {
  const WorldRanges there = at_corner(ranges, corner, task());
  return draw_trial(task(), Cell{}, task().starts.front(), &there, 1, 2).world;
}

TEST(EvaluationCorner, EveryRunHasTheFrictionAndThePartOfTheCorner) {
  for (const std::string& corner : corner_names()) {
    const WorldDraw world = world_at(corner);
    EXPECT_EQ(world.friction, corner.starts_with("low") ? 0.1 : 0.6) << corner;
    const Vector3 grown_m = real_task(task(), world).held.front().size_m - task().held[0].size_m;
    const double larger_m = corner.ends_with("largest") ? 5e-4 : 0.0;
    EXPECT_TRUE(grown_m.isApproxToConstant(larger_m, 1e-9) || grown_m.norm() < 1e-12) << corner;
    EXPECT_NEAR(grown_m.x(), larger_m, 1e-12) << corner;
  }
}

TEST(EvaluationCorner, WhatElseAnExperimentDrawsStaysAsItWas) {
  WorldRanges ranges;
  ranges.name = "worn";
  ranges.friction = Spread{.low = 0.2, .high = 0.4};
  ranges.servo_stiffness_factor = {.low = 0.5, .high = 2.0};
  const WorldDraw drawn = draw_trial(task(), Cell{}, task().starts.front(), &ranges, 1, 2).world;
  const WorldDraw cornered = world_at("high,drawn", ranges);
  EXPECT_EQ(cornered.servo_stiffness_factor, drawn.servo_stiffness_factor);
  EXPECT_NE(cornered.friction, drawn.friction);
  EXPECT_EQ(at_corner(ranges, "high,drawn", task()).name, "worn at high,drawn");
  EXPECT_EQ(at_corner({}, "high,drawn", task()).name, "high,drawn");
}

TEST(EvaluationCorner, ACornerThatIsNoneIsRefused) {
  EXPECT_THROW((void)at_corner({}, "high", task()), InputError);
  Task exact = task();
  exact.oversize_m = 0.0;
  EXPECT_THROW((void)at_corner({}, "high,largest", exact), InputError);
  EXPECT_NO_THROW((void)at_corner({}, "high,drawn", exact));
}

}  // namespace
}  // namespace tenon::sim

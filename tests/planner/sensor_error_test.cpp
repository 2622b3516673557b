// A force sensor that is not where the cell has it: what guides and plans are to hold of that.

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <memory>
#include <set>
#include <vector>

#include "planner/belief/corners.h"
#include "planner/judge/judged_starts.h"
#include "planner/planner.h"
#include "tests/planner/room_task.h"

namespace tenon::planner {
namespace {

TEST(SensorError, WhereMovesYieldInRotationTheForceSensorIsOffEitherWayAmongTheCorners) {
  Task task = room_task();
  task.sensor_error_m = 1e-3;
  EXPECT_EQ(sensor_errors(task), std::vector<Vector3>{Vector3::Zero()}) << "no torque turns it";
  task.coordinates = task.compliance.compliant_axes = 0b111111;
  task.starts.front().sigma.setConstant(0.01);
  std::vector<Vector3> among;
  for (const Particle& corner : corner_belief(task, task.starts.front()).particles) {
    among.push_back(corner.physics.sensor_error_m);
  }
  ASSERT_EQ(among.size(), 16U);
  EXPECT_EQ(among.front(), Vector3::Zero());
  const std::vector<Vector3> all = sensor_errors(task);
  ASSERT_EQ(all.size(), 7U);
  for (const Vector3& error_m : all) {
    EXPECT_NE(std::count(among.begin(), among.end(), error_m), 0) << error_m.transpose();
    EXPECT_NE(std::count(all.begin(), all.end(), -error_m), 0) << error_m.transpose();
  }
  task.sensor_error_m = 0.0;
  EXPECT_EQ(sensor_errors(task).size(), 1U);
}

TEST(SensorError, CornersHaveTheForceSensorOffEveryWayInEveryPhysics) {
  Task task = room_task();
  task.coordinates = task.compliance.compliant_axes = 0b111111;
  task.sensor_error_m = 1e-3;
  task.starts.front().sigma << 0.03, 0.03, 0.03, 0.02, 0.02, 0.02;
  Plan plan;
  plan.latency_max_s = 0.008;
  WallRollout rollout(room());
  using Physics = std::array<double, 5>;
  const auto physics_of = [](const JudgedStart& one) {
    const PhysicalParameters& p = one.particle.physics;
    return Physics{p.friction, p.latency_s, p.sensor_error_m.x(), p.sensor_error_m.y(),
                   p.sensor_error_m.z()};
  };
  std::set<Physics> met;
  for (const auto& one : corner_starts(plan, task, task.starts.front(), rollout)) {
    met.insert(physics_of(one));
  }
  EXPECT_EQ(met.size(), 4U * 7U);

  const auto drawn = [&] {
    return drawn_starts(7, 200, DrawnPhysics::kEven, plan, task, task.starts.front(), rollout);
  };
  Vector3 low_m = Vector3::Zero();
  Vector3 high_m = Vector3::Zero();
  for (const JudgedStart& one : drawn()) {
    low_m = low_m.cwiseMin(one.particle.physics.sensor_error_m);
    high_m = high_m.cwiseMax(one.particle.physics.sensor_error_m);
  }
  for (int axis = 0; axis < 3; ++axis) {
    EXPECT_GE(low_m[axis], -1e-3);
    EXPECT_LT(low_m[axis], -0.9e-3);
    EXPECT_LE(high_m[axis], 1e-3);
    EXPECT_GT(high_m[axis], 0.9e-3);
  }
  task.compliance.compliant_axes = 0b000111;
  for (const JudgedStart& one : drawn()) {
    EXPECT_EQ(one.particle.physics.sensor_error_m, Vector3::Zero());
  }
}

/// Walls that fail whoever feels a torque that is none.
class FeltRollout final : public Rollout {
 public:
  explicit FeltRollout(double most_m) : most_m_(most_m), walls_(room()) {}

  [[nodiscard]] RolloutResult simulate(const Particle& particle, const MoveParameters& move,
                                       std::int64_t step_us,
                                       std::vector<TraceSample>* trace) override {
    if (particle.physics.sensor_error_m.norm() > most_m_) return {};
    return walls_.simulate(particle, move, step_us, trace);
  }
  [[nodiscard]] bool in_collision(const Pose& tool) override { return walls_.in_collision(tool); }
  [[nodiscard]] std::unique_ptr<Rollout> clone() const override {
    return std::make_unique<FeltRollout>(most_m_);
  }

 private:
  double most_m_;
  WallRollout walls_;
};

TEST(SensorError, WhatNoPlanBearsOfItIsNotHeld) {
  Task task = room_task();
  task.compliance.compliant_axes = 0b100011;
  task.sensor_error_m = 1e-3;
  for (const double borne_m : {2e-3, 1e-6}) {
    const FeltRollout rollout(borne_m);
    const PlanReport report = make_plan(task, task.starts.front(), rollout, {});
    ASSERT_EQ(report.status, PlanStatus::kPlanned) << report.reason;
    const Validation& validation = report.validation;
    EXPECT_EQ(validation.held.sensor_error_m, borne_m > 1e-3 ? 1e-3 : 0.0);
    EXPECT_EQ(arrived(validation.corners), validation.corners.size());
    // From the file alone as much is found.
    RolloutPool pool(rollout, 1);
    const Validation again = validate(*report.plan, task, task.starts.front(), 200, pool);
    EXPECT_EQ(again.held, validation.held);
    EXPECT_EQ(again.at_goal(), validation.at_goal());
  }
}

}  // namespace
}  // namespace tenon::planner

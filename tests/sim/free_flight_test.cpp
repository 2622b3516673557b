// A tool that nothing touches moves by a closed form: it must be where the solver would have taken
// it, and nothing may be met unseen on the way.

#include <gtest/gtest.h>

#include <cmath>

#include "sim/physics/rollout/compliant_tool.h"
#include "sim/physics/rollout/ode_rollout.h"
#include "sim/physics/scene.h"

namespace tenon::sim {
namespace {

constexpr double kStep_s = 0.002;

/// A command that turns and shakes; some of its axes may be rigid.
GuardedMove::Setpoint shaken(double time_s) {
  GuardedMove::Setpoint setpoint;
  Vector6 way;
  for (int axis = 0; axis < 6; ++axis) {
    const double size = axis < 3 ? 0.02 : 0.1;
    const double rate = 2.0 + axis;
    way[axis] = size * std::sin(rate * time_s);
    setpoint.velocity[axis] = size * rate * std::cos(rate * time_s);
    setpoint.acceleration[axis] = -rate * rate * way[axis];
  }
  setpoint.pose = displaced({}, way);
  return setpoint;
}

void expect_the_same_way(std::uint8_t compliant_axes) {
  Compliance compliance;
  compliance.compliant_axes = compliant_axes;
  OdeWorld world;
  CompliantTool solved(world, compliance);
  OdeWorld empty;
  CompliantTool flown(empty, compliance);
  solved.place({});
  flown.place({});
  double far_m = 0.0;
  for (int i = 0; i < 1000; ++i) {
    const GuardedMove::Setpoint setpoint = shaken(kStep_s * i);
    solved.show();
    solved.drive(setpoint, kStep_s);
    world.step(kStep_s);
    solved.follow();
    flown.fly(setpoint, kStep_s);
    const Vector6 apart = displacement_between(solved.pose(), flown.pose());
    ASSERT_LT(apart.head<3>().norm(), 1e-4) << i;
    ASSERT_LT(apart.tail<3>().norm(), 1e-3) << i;
    far_m = std::max(far_m, flown.pose().position_m.norm());
  }
  EXPECT_GT(far_m, 0.01);
}

TEST(FreeFlight, AClosedFormGoesWhereTheSolverGoes) { expect_the_same_way(0b111111); }

TEST(FreeFlight, AxesThatDoNotYieldToo) { expect_the_same_way(0b000011); }

TEST(FreeFlight, OfTranslationsAloneItIsTheSameStep) {
  const Compliance compliance{.compliant_axes = 0b000111};
  OdeWorld world;
  CompliantTool solved(world, compliance);
  OdeWorld empty;
  CompliantTool flown(empty, compliance);
  for (CompliantTool* tool : {&solved, &flown}) {
    tool->set_compliance(compliance, /*turns=*/false);
    tool->place({});
  }
  for (int i = 0; i < 1000; ++i) {
    GuardedMove::Setpoint setpoint = shaken(kStep_s * i);
    setpoint.pose.orientation.setIdentity();
    solved.show();
    solved.drive(setpoint, kStep_s);
    world.step(kStep_s);
    solved.follow();
    flown.fly(setpoint, kStep_s);
    ASSERT_LT((solved.pose().position_m - flown.pose().position_m).norm(), 1e-12) << i;
  }
}

const std::vector<Shape> kStick = {
    {"stick", Shape::Kind::kBox, {0.01, 0.01, 0.2}, {{0.0, 0.0, 0.1}, {1, 0, 0, 0}}}};

TEST(FreeFlight, ClearanceIsNeverMoreThanTheWayToTheNextShape) {
  OdeWorld world;
  CompliantTool tool(world, {});
  const Vector3 centre_m(0.1, 0.0, 0.0);
  Scene scene(kStick, {{"wall", Shape::Kind::kBox, {0.02, 1.0, 1.0}, {centre_m, {1, 0, 0, 0}}}});
  scene.attach(tool.body());
  const auto clearance_m = [&](const Pose& pose) {
    tool.place(pose);
    scene.moved_anywhere();
    EXPECT_EQ(scene.clearance_m(), 0.0);
    (void)scene.find_contacts(/*turns=*/true);
    return scene.clearance_m();
  };
  EXPECT_NEAR(clearance_m({}), 0.085, 1e-12);
  scene.moved(0.08);
  EXPECT_NEAR(scene.clearance_m(), 0.005, 1e-12);
  scene.set_oversize(0.004);
  EXPECT_NEAR(clearance_m({}), 0.083, 1e-12);
  const double tilted_m = clearance_m({Vector3::Zero(), rotation_of({0.0, 0.3, 0.0})});
  EXPECT_LE(tilted_m, 0.09 - 0.2 * std::sin(0.3));
  EXPECT_GT(tilted_m, 0.02);
  EXPECT_GE(scene.reach_m(), 0.2);
  EXPECT_EQ(clearance_m({{0.09, 0.0, 0.0}, Eigen::Quaterniond::Identity()}), 0.0);
  EXPECT_EQ(scene.touching(), std::vector<std::string>{"stick-wall"});
}

TEST(FreeFlight, AStickThatTurnsIntoAWallMeetsIt) {
  // Its tip is 0.2 m from the tool's origin, which does not move at all.
  Task task;
  task.held = kStick;
  task.environment = {
      {"wall", Shape::Kind::kBox, {0.02, 1.0, 1.0}, {{0.1, 0.0, 0.0}, {1, 0, 0, 0}}}};
  MoveParameters turn;
  turn.displacement[4] = 1.0;
  const RolloutResult result = OdeRollout(task).simulate({}, turn, 2000, nullptr);
  ASSERT_TRUE(result.valid) << result.failure;
  EXPECT_EQ(result.move.outcome, Outcome::kContact);
  EXPECT_EQ(result.touching, std::vector<std::string>{"stick-wall"});
  EXPECT_LT(result.move.travelled[4], 0.6);
}

}  // namespace
}  // namespace tenon::sim

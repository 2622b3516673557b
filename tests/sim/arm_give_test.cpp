// Between the tool that encoders see and the part that it holds an arm gives way: parts meet hard,
// and what a push sinks by is the arm's.

#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <vector>

#include "sim/physics/rollout/compliant_tool.h"
#include "sim/physics/rollout/ode_rollout.h"

namespace tenon::sim {
namespace {

/// Tool, arm and wall along one axis, in steps so small that any rule integrates them.
struct Springs {
  double mass_kg = 0.0;
  double damping_Nspm = 0.0;
  double stiffness_Npm = 0.0;
  ArmGive arm;
  double tool_m = 0.0;
  double speed_mps = 0.0;
  double bent_m = 0.0;

  /// @param push_N on the part; the setpoint stands at 0
  void run(double push_N, double time_s) {
    constexpr double kFine_s = 1e-6;
    for (double t_s = 0.0; t_s < time_s; t_s += kFine_s) {
      const double pull_N = push_N - damping_Nspm * speed_mps - stiffness_Npm * tool_m;
      speed_mps += kFine_s * pull_N / mass_kg;
      tool_m += kFine_s * speed_mps;
      bent_m += kFine_s * (arm.give_mpN * push_N - bent_m) / arm.relaxation_s;
    }
  }
};

TEST(ArmGive, ToolAndPartGoWhereTheirSpringsTakeThem) {
  Compliance compliance;
  compliance.compliant_axes = 0b000111;
  Springs springs{compliance.mass_kg, compliance.damping_Nspm, compliance.stiffness_Npm, {2e-5}};
  OdeWorld world;
  CompliantTool tool(world, compliance);
  tool.set_compliance(compliance, /*turns=*/false, springs.arm);
  tool.place({});
  Vector6 push = Vector6::Zero();
  for (const double push_N : {10.0, 0.0, -4.0}) {
    push.x() = push_N;
    constexpr double kStep_s = 1e-4;
    for (int i = 0; i < 100; ++i) tool.fly({}, kStep_s, push);
    springs.run(push_N, 100 * kStep_s);
    EXPECT_NEAR(tool.pose().position_m.x(), springs.tool_m, 1e-6);
    EXPECT_NEAR(tool.part_pose().position_m.x(), springs.tool_m + springs.bent_m, 2e-6);
  }
}

TEST(ArmGive, WhereItRestsUnderAForceItStaysUnderIt) {
  OdeWorld world;
  CompliantTool tool(world, {});
  tool.set_compliance({}, /*turns=*/true, {2e-5});
  tool.place({}, {3.0, 0.0, 0.0});
  EXPECT_NEAR(tool.part_pose().position_m.x(), 6e-5, 1e-15);
  EXPECT_EQ(tool.pose().position_m.x(), 0.0);
}

/// A cube before a wall, and a second wall that stands back by so much.
Task two_walls(double back_m) {
  Task task;
  task.held = {{"part", Shape::Kind::kBox, {0.04, 0.04, 0.04}, {{0.0, 0.0, 0.02}, {1, 0, 0, 0}}}};
  task.environment = {
      {"near", Shape::Kind::kBox, {0.1, 0.02, 0.2}, {{0.1, -0.01, 0.0}, {1, 0, 0, 0}}},
      {"far", Shape::Kind::kBox, {0.1, 0.02, 0.2}, {{0.1 + back_m, 0.01, 0.0}, {1, 0, 0, 0}}}};
  return task;
}

RolloutResult pressed(const Task& task, bool turning) {
  MoveParameters move;
  if (!turning) move.compliance.compliant_axes = 0b000111;
  move.displacement.x() = 0.05;
  RolloutResult result = OdeRollout(task).simulate({}, move, 2000, nullptr);
  EXPECT_TRUE(result.valid) << result.failure;
  EXPECT_EQ(result.move.outcome, Outcome::kContact);
  return result;
}

// 3 N over 5e4 N/m are 60 um.
TEST(ArmGive, APressedPartDoesNotReachAWallBehindTheOneThatHoldsIt) {
  for (const bool turning : {false, true}) {
    const RolloutResult result = pressed(two_walls(20e-6), turning);
    EXPECT_EQ(result.touching, std::vector<std::string>{"part-near"}) << turning;
    EXPECT_NEAR(result.move.pose.position_m.x() - 0.03, 3.0 / 5e4, 10e-6) << turning;
  }
}

TEST(ArmGive, BothWallsWhereTheyStandTogether) {
  EXPECT_EQ(pressed(two_walls(0.0), false).touching.size(), 2U);
}

}  // namespace
}  // namespace tenon::sim

// What commands joints: stops, moves, and commands that are not taken.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "executor/motion/joint_command.h"
#include "executor/motion/joint_move.h"
#include "executor/motion/joint_stop.h"
#include "tests/support/hand_made.h"

namespace tenon::executor {
namespace {

const JointVector kBent = {0.2, -0.4, 1.5, 0.1, 1.2, -0.3};

TEST(JointStop, EveryJointStopsWithinItsAccelerationAndWhereTheClosedFormSays) {
  const Robot robot = hand_made_arm_cell().robot;  // 5 rad/s^2
  const JointVector velocity = {1.0, -0.5, 0.2, 0.0, 0.01, -1.2};
  const JointStop stop(kBent, velocity, robot);
  constexpr double kT = 1e-4;
  double most = 0.0;
  for (int i = 1; i * kT < stop.duration_s(); ++i) {
    const JointVector before = stop.at((i - 1) * kT);
    const JointVector here = stop.at(i * kT);
    const JointVector after = stop.at((i + 1) * kT);
    for (std::size_t joint = 0; joint < 6; ++joint) {
      most = std::max(most, std::abs(after[joint] - 2.0 * here[joint] + before[joint]) / (kT * kT));
    }
  }
  EXPECT_LT(most, 5.0 + 1e-3);
  EXPECT_GT(most, 4.9);  // the fastest joint brakes as hard as it may
  // All in the time of joint 6: v (v / a + t_j) / 2 each.
  const double time_s = 1.2 / 5.0 + JointStop::kRampTime_s;
  EXPECT_NEAR(stop.duration_s(), time_s, 1e-12);
  for (std::size_t joint = 0; joint < 6; ++joint) {
    EXPECT_NEAR(stop.end()[joint], kBent[joint] + 0.5 * velocity[joint] * time_s, 1e-9);
  }
}

TEST(JointStop, JointsAtRestStayWhereTheyAre) {
  const JointStop stop(kBent, {}, hand_made_arm_cell().robot);
  EXPECT_EQ(stop.duration_s(), 0.0);
  EXPECT_EQ(stop.at(1.0), kBent);
}

TEST(JointMove, JointsAndToolKeepTheirBoundsAndArriveTogether) {
  const Cell cell = hand_made_arm_cell();
  const ToolKinematics kinematics(cell);
  const SpeedLimits tool;
  std::mt19937 random(5);
  std::uniform_real_distribution<double> turn(-0.8, 0.8);
  for (int trial = 0; trial < 20; ++trial) {
    JointVector to = kBent;
    for (std::size_t joint = 0; joint < 6; ++joint) to[joint] += turn(random);
    const JointMove move(kBent, to, cell.robot, kinematics, tool);
    EXPECT_EQ(move.at(0.0), kBent);
    EXPECT_LT(std::abs(move.at(move.duration_s())[3] - to[3]), 1e-12);
    constexpr double kT = 2e-3;
    double fastest = 0.0;
    double fastest_tool = 0.0;
    for (double t = kT; t < move.duration_s(); t += kT) {
      const JointVector before = move.at(t - kT);
      const JointVector here = move.at(t);
      for (std::size_t joint = 0; joint < 6; ++joint) {
        fastest = std::max(fastest, std::abs(here[joint] - before[joint]) / kT / 1.26);
        // On the straight way between the two.
        EXPECT_NEAR((here[joint] - kBent[joint]) * (to[0] - kBent[0]),
                    (here[0] - kBent[0]) * (to[joint] - kBent[joint]), 1e-9);
      }
      const Vector6 way = displacement_between(kinematics.tool(before), kinematics.tool(here));
      fastest_tool = std::max({fastest_tool, way.head<3>().norm() / kT / tool.contact_mps,
                               way.tail<3>().norm() / kT / tool.contact_radps});
    }
    EXPECT_LT(fastest, JointMove::kCaution + 1e-6);
    EXPECT_LT(fastest_tool, 1.01);
    EXPECT_GT(std::max(fastest / JointMove::kCaution, fastest_tool), 0.98);  // one of them decides
  }
}

class JointCommandTest : public ::testing::Test {
 protected:
  Cell cell = hand_made_arm_cell();
  ToolKinematics kinematics{cell};
  JointCommand command{cell.robot, kinematics};
};

TEST_F(JointCommandTest, ATooFastCommandIsNotTakenButNamed) {
  command.rest_at(kBent);
  JointVector next = kBent;
  next[4] += 1.3 * 2e-3;
  const auto ending = command.follow(next);
  ASSERT_TRUE(ending);
  EXPECT_EQ(ending->reason, EndReason::kJointSpeed);
  EXPECT_EQ(ending->index, 4);
  EXPECT_NEAR(ending->value, 1.3, 1e-9);
  EXPECT_EQ(command.position(), kBent);
}

TEST_F(JointCommandTest, AJointIsStoppedInsideItsLimitsHoweverItCame) {
  for (const double sign : {+1.0, -1.0}) {
    JointVector joints = kBent;
    joints[2] = sign * 2.4;  // its limits are 2.714 either way
    command.rest_at(joints);
    std::optional<Ending> ending;
    for (int cycle = 0; cycle < 1000 && !ending; ++cycle) {
      joints[2] += sign * 1.2 * 2e-3 * std::min(1.0, 0.01 * cycle);
      ending = command.follow(joints);
    }
    ASSERT_TRUE(ending) << sign;
    EXPECT_EQ(ending->reason, EndReason::kJointLimit);
    EXPECT_EQ(ending->index, 2);
    EXPECT_EQ(ending->bound, sign * 2.714);
    EXPECT_GT(sign * ending->value, 2.714);
    command.stop();
    EXPECT_FALSE(command.at_rest());
    while (!command.at_rest()) command.ramp();
    EXPECT_LT(sign * command.position()[2], 2.714);
    EXPECT_GT(sign * command.position()[2], 2.714 - 0.01);
  }
}

TEST_F(JointCommandTest, APoseOutOfReachIsNotTaken) {
  command.rest_at(kBent);
  Pose far = kinematics.tool(kBent);
  far.position_m.x() += 2.0;
  const auto ending = command.follow(far);
  ASSERT_TRUE(ending);
  EXPECT_EQ(ending->reason, EndReason::kUnreachable);
  EXPECT_GT(ending->value, 0.5);
  EXPECT_EQ(command.position(), kBent);
}

}  // namespace
}  // namespace tenon::executor

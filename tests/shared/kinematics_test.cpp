// The serial chain against finite differences, hand-computed poses and random round trips.

#include <gtest/gtest.h>

#include <numbers>
#include <random>

#include "shared/base/error.h"
#include "shared/kinematics/serial_chain.h"

namespace tenon {
namespace {

Eigen::Quaterniond rpy(double roll, double pitch, double yaw) {
  return Eigen::AngleAxisd(yaw, Vector3::UnitZ()) * Eigen::AngleAxisd(pitch, Vector3::UnitY()) *
         Eigen::AngleAxisd(roll, Vector3::UnitX());
}

Joint joint(Joint::Kind kind, const Pose& origin, const Vector3& axis, double limit) {
  Joint joint;
  joint.kind = kind;
  joint.origin = origin;
  joint.axis = axis;
  joint.lower = -limit;
  joint.upper = limit;
  return joint;
}

Robot gantry() {
  Robot robot;
  robot.name = "gantry";
  for (int axis = 0; axis < 3; ++axis) {
    robot.joints.push_back(
        joint(Joint::Kind::kPrismatic, {Vector3(0.1, 0.0, 0.2), {}}, Vector3::Unit(axis), 0.5));
    robot.joints.back().origin.orientation.setIdentity();
  }
  return robot;
}

// Six revolute joints, a spherical-wrist arm with an offset before the wrist.
Robot arm6() {
  Robot robot;
  robot.name = "arm6";
  const auto add = [&](double x, double y, double z, double r, double p, double w, double limit) {
    robot.joints.push_back(
        joint(Joint::Kind::kRevolute, {Vector3(x, y, z), rpy(r, p, w)}, Vector3::UnitZ(), limit));
  };
  add(0, 0, 0, 0, 0, 0, 2.967);
  add(0, 0, 0, std::numbers::pi / 2, 0, 0, 2.967);
  add(0, 0.350, 0, 0, std::numbers::pi, 0, 2.714);
  add(0, 0, 0, -std::numbers::pi / 2, std::numbers::pi, 0, 2.967);
  add(0, 0.005263, 0.305, std::numbers::pi / 2, 0, std::numbers::pi, 2.967);
  add(0, 0, 0, -std::numbers::pi / 2, 0, 0, 2.967);
  robot.flange = {Vector3(0, 0, 0.08), Eigen::Quaterniond::Identity()};
  return robot;
}

JointVector random_position(std::mt19937& random, const Robot& robot, double share) {
  JointVector q{};
  for (std::size_t i = 0; i < robot.joints.size(); ++i) {
    q[i] = std::uniform_real_distribution<double>(share * robot.joints[i].lower,
                                                  share * robot.joints[i].upper)(random);
  }
  return q;
}

TEST(SerialChain, AGantrysFlangeIsTheSumOfOriginsAndPositions) {
  const Pose pose = SerialChain(gantry()).flange({0.1, -0.2, 0.3});
  EXPECT_NEAR(pose.position_m.x(), 0.4, 1e-15);
  EXPECT_NEAR(pose.position_m.y(), -0.2, 1e-15);
  EXPECT_NEAR(pose.position_m.z(), 0.9, 1e-15);
  EXPECT_TRUE(pose.orientation.isApprox(Eigen::Quaterniond::Identity()));
}

TEST(SerialChain, AQuarterTurnOfAPlanarArmPointsItSideways) {
  Robot robot;
  robot.joints.push_back(joint(Joint::Kind::kRevolute, {}, Vector3::UnitZ(), 3.0));
  robot.joints.push_back(
      joint(Joint::Kind::kRevolute, {Vector3(0.3, 0, 0), rpy(0, 0, 0)}, Vector3::UnitZ(), 3.0));
  robot.flange = {Vector3(0.2, 0, 0), rpy(0, 0, 0)};
  const Pose pose = SerialChain(robot).flange({std::numbers::pi / 2, -std::numbers::pi / 2});
  EXPECT_NEAR(pose.position_m.x(), 0.2, 1e-15);
  EXPECT_NEAR(pose.position_m.y(), 0.3, 1e-15);
  EXPECT_NEAR(rotation_vector(pose.orientation).norm(), 0.0, 1e-15);
}

TEST(SerialChain, TheJacobianIsTheDerivativeOfTheFlangePose) {
  std::mt19937 random(1);
  for (const Robot& robot : {gantry(), arm6()}) {
    const SerialChain chain(robot);
    for (int trial = 0; trial < 50; ++trial) {
      const JointVector q = random_position(random, robot, 1.0);
      const SerialChain::Jacobian J = chain.jacobian(q);
      for (std::size_t i = 0; i < robot.joints.size(); ++i) {
        constexpr double kStep = 1e-6;
        JointVector below = q;
        JointVector above = q;
        below[i] -= kStep;
        above[i] += kStep;
        const Vector6 difference =
            displacement_between(chain.flange(below), chain.flange(above)) / (2 * kStep);
        EXPECT_LT((J.col(static_cast<int>(i)) - difference).norm(), 1e-8) << robot.name << " " << i;
      }
    }
  }
}

TEST(SerialChain, TheInverseFindsAGantrysPositionFromAnywhere) {
  std::mt19937 random(2);
  const Robot robot = gantry();
  const SerialChain chain(robot);
  SerialChain::InverseParameters parameters;
  parameters.axes = 0x07;
  for (int trial = 0; trial < 200; ++trial) {
    const JointVector q = random_position(random, robot, 1.0);
    const auto inverse =
        chain.inverse(chain.flange(q), random_position(random, robot, 1.0), parameters);
    ASSERT_EQ(inverse.status, SerialChain::InverseStatus::kSolved);
    for (std::size_t i = 0; i < 3; ++i) EXPECT_NEAR(inverse.position[i], q[i], 2e-9);
  }
}

TEST(SerialChain, TheInverseReturnsToTheFlangePoseFromANearbySeed) {
  std::mt19937 random(3);
  const Robot robot = arm6();
  const SerialChain chain(robot);
  int solved = 0;
  for (int trial = 0; trial < 500; ++trial) {
    const JointVector q = random_position(random, robot, 0.8);
    JointVector seed = q;
    for (double& joint_rad : seed) {
      joint_rad += std::uniform_real_distribution<double>(-0.1, 0.1)(random);
    }
    const Pose goal = chain.flange(q);
    const auto inverse = chain.inverse(goal, seed, {});
    if (inverse.status != SerialChain::InverseStatus::kSolved) continue;
    ++solved;
    EXPECT_LT(displacement_between(chain.flange(inverse.position), goal).norm(), 3e-9);
  }
  EXPECT_GE(solved, 490);  // the rest lies beside singular positions
}

TEST(SerialChain, AStepOfOneControlCycleTakesFewIterations) {
  const SerialChain chain(arm6());
  const JointVector q{0.3, -0.7, 1.1, 0.4, 0.9, -0.2};
  const Pose goal = displaced(chain.flange(q), (Vector6() << 2e-4, 0, 1e-4, 0, 5e-4, 0).finished());
  const auto inverse = chain.inverse(goal, q, {});
  EXPECT_EQ(inverse.status, SerialChain::InverseStatus::kSolved);
  EXPECT_LE(inverse.iterations, 4);
}

TEST(SerialChain, AGoalBehindAJointLimitIsRefusedByThatJointsIndex) {
  const SerialChain chain(gantry());
  SerialChain::InverseParameters parameters;
  parameters.axes = 0x07;
  const Pose goal = chain.flange({0.1, 0.6, 0.2});
  const auto inverse = chain.inverse(goal, {}, parameters);
  EXPECT_EQ(inverse.status, SerialChain::InverseStatus::kJointLimit);
  EXPECT_EQ(inverse.joint, 1);
  EXPECT_NEAR(inverse.position[1], 0.5, 1e-12);
  EXPECT_NEAR(inverse.error, 0.1, 1e-9);

  parameters.respect_limits = false;
  EXPECT_EQ(chain.inverse(goal, {}, parameters).status, SerialChain::InverseStatus::kSolved);
  parameters.respect_limits = true;
  parameters.limit_margin = 0.01;
  const auto near_limit = chain.inverse(chain.flange({0.495, 0, 0}), {}, parameters);
  EXPECT_EQ(near_limit.status, SerialChain::InverseStatus::kJointLimit);
  EXPECT_EQ(near_limit.joint, 0);
}

TEST(SerialChain, AGoalExactlyAtALimitIsReached) {
  const SerialChain chain(gantry());
  SerialChain::InverseParameters parameters;
  parameters.axes = 0x07;
  const auto inverse = chain.inverse(chain.flange({0.5, -0.5, 0.5}), {}, parameters);
  EXPECT_EQ(inverse.status, SerialChain::InverseStatus::kSolved);
}

TEST(SerialChain, AGoalOutOfReachDoesNotConverge) {
  Pose goal;
  goal.position_m = Vector3(5, 0, 0);
  Robot robot = arm6();
  for (Joint& free : robot.joints) {
    free.lower = -100;
    free.upper = 100;
  }
  const auto inverse = SerialChain(robot).inverse(goal, {0.3, -0.7, 1.1, 0.4, 0.9, -0.2}, {});
  EXPECT_EQ(inverse.status, SerialChain::InverseStatus::kNotConverged);
  EXPECT_GT(inverse.error, 1.0);
}

TEST(SerialChain, AGoalThatIsNotFiniteIsNamedSo) {
  Pose goal;
  goal.position_m.x() = std::nan("");
  EXPECT_EQ(SerialChain(arm6()).inverse(goal, {}, {}).status,
            SerialChain::InverseStatus::kNotFinite);
}

TEST(SerialChain, FreeAxesAreThoseThatTheJointsCanMoveAlone) {
  EXPECT_EQ(SerialChain(gantry()).free_axes({}), 0x07);
  EXPECT_EQ(SerialChain(arm6()).free_axes({0.3, -0.7, 1.1, 0.4, 0.9, -0.2}), 0x3F);
}

TEST(SerialChain, ARobotWithoutJointsOrWithTooManyIsRefused) {
  EXPECT_THROW(SerialChain(Robot{}), InputError);
  Robot robot;
  robot.joints.resize(kMaxJoints + 1);
  EXPECT_THROW(SerialChain{robot}, InputError);
}

}  // namespace
}  // namespace tenon

// The robots and cells of the tree: the LWA 4P's own values literally, the kinematics of all of
// them against KDL, and what the cells promise about their table.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <kdl/chain.hpp>
#include <kdl/chainfksolverpos_recursive.hpp>
#include <kdl/chainjnttojacsolver.hpp>
#include <numbers>
#include <random>
#include <string>

#include "hw/bus_load/bus_load.h"
#include "shared/canopen/robot_drives.h"
#include "shared/config/load.h"
#include "shared/kinematics/serial_chain.h"
#include "tests/support/allocation_count.h"
#include "tests/support/places.h"

namespace tenon {
namespace {

using Status = SerialChain::InverseStatus;

Robot shipped(const std::string& name) {
  return load_robot(tests::in_tree("hw/robots/" + name + "/robot.yaml"));
}
Cell shipped_cell(const std::string& name) {
  return load_cell(tests::in_tree("hw/cells/" + name + ".yaml"));
}

struct LiteralFrame {
  double x, y, z, roll, pitch, yaw;
};
/// The LWA 4P's frames, written down a second time.
constexpr LiteralFrame kLwa4p[] = {{0, 0, 0, 0, 0, 0},
                                   {0, 0, 0, std::numbers::pi / 2, 0, 0},
                                   {0, 0.350, 0, 0, std::numbers::pi, 0},
                                   {0, 0, 0, -std::numbers::pi / 2, std::numbers::pi, 0},
                                   {0, 0.005263, 0.305, std::numbers::pi / 2, 0, std::numbers::pi},
                                   {0, 0, 0, -std::numbers::pi / 2, 0, 0}};

KDL::Chain kdl_chain(const std::string& robot) {
  KDL::Chain chain;
  if (robot == "gantry3" || robot == "epos4") {
    for (const auto axis : {KDL::Joint::TransX, KDL::Joint::TransY, KDL::Joint::TransZ}) {
      chain.addSegment(KDL::Segment(KDL::Joint(axis), KDL::Frame::Identity()));
    }
    return chain;
  }
  for (const LiteralFrame& f : kLwa4p) {
    chain.addSegment(KDL::Segment(
        KDL::Joint(KDL::Joint::None),
        KDL::Frame(KDL::Rotation::RPY(f.roll, f.pitch, f.yaw), KDL::Vector(f.x, f.y, f.z))));
    chain.addSegment(KDL::Segment(KDL::Joint(KDL::Joint::RotZ), KDL::Frame::Identity()));
  }
  return chain;
}

JointVector random_position(std::mt19937& random, const Robot& robot) {
  JointVector q{};
  for (std::size_t i = 0; i < robot.joints.size(); ++i) {
    q[i] = std::uniform_real_distribution<double>(robot.joints[i].lower,
                                                  robot.joints[i].upper)(random);
  }
  return q;
}

Eigen::Matrix3d rotation_of_kdl(const KDL::Frame& frame) {
  return Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>(frame.M.data);
}

class ShippedRobot : public ::testing::TestWithParam<const char*> {};
INSTANTIATE_TEST_SUITE_P(All, ShippedRobot,
                         ::testing::Values("gantry3", "lwa4p", "csp6", "epos4", "mit6"),
                         [](const auto& robot) { return std::string(robot.param); });

TEST_P(ShippedRobot, AgreesWithKdlOver100000Configurations) {
  std::mt19937 random(1);
  const Robot robot = shipped(GetParam());
  const SerialChain chain(robot);
  const KDL::Chain kdl = kdl_chain(GetParam());
  const auto count = static_cast<unsigned>(robot.joints.size());
  ASSERT_EQ(kdl.getNrOfJoints(), count);
  KDL::ChainFkSolverPos_recursive forward(kdl);
  KDL::ChainJntToJacSolver to_jacobian(kdl);
  KDL::JntArray positions(count);
  KDL::Frame frame;
  KDL::Jacobian kdl_jacobian(count);
  double worst_pose = 0.0;
  double worst_jacobian = 0.0;
  for (int trial = 0; trial < 100'000; ++trial) {
    const JointVector q = random_position(random, robot);
    for (unsigned i = 0; i < count; ++i) positions(i) = q[i];
    ASSERT_GE(forward.JntToCart(positions, frame), 0);
    ASSERT_GE(to_jacobian.JntToJac(positions, kdl_jacobian), 0);
    const Pose pose = chain.flange(q);
    const Vector3 off_m = pose.position_m - Vector3(frame.p.x(), frame.p.y(), frame.p.z());
    const Eigen::Matrix3d turned = pose.orientation.toRotationMatrix() - rotation_of_kdl(frame);
    worst_pose =
        std::max({worst_pose, off_m.lpNorm<Eigen::Infinity>(), turned.cwiseAbs().maxCoeff()});
    const SerialChain::Jacobian J = chain.jacobian(q);
    worst_jacobian =
        std::max(worst_jacobian, (J.leftCols(count) - kdl_jacobian.data).cwiseAbs().maxCoeff());
  }
  EXPECT_LT(worst_pose, 1e-9);
  EXPECT_LT(worst_jacobian, 1e-9);
  RecordProperty("worst_pose", std::to_string(worst_pose * 1e15) + "e-15");
  RecordProperty("worst_jacobian", std::to_string(worst_jacobian * 1e15) + "e-15");
}

struct Tally {
  int solved = 0;
  int joint_limit = 0;
  int not_converged = 0;
  int wrong = 0;  ///< solved and not there or beyond a limit, or a reason that is not true
};

bool truly_solved(const SerialChain& chain, const Robot& robot, const SerialChain::Inverse& found,
                  const Pose& goal) {
  for (std::size_t i = 0; i < robot.joints.size(); ++i) {
    const Joint& joint = robot.joints[i];
    if (found.position[i] < joint.lower || found.position[i] > joint.upper) return false;
  }
  return displacement_between(chain.flange(found.position), goal).lpNorm<Eigen::Infinity>() < 2e-9;
}

bool at_limit(const Robot& robot, const SerialChain::Inverse& found) {
  if (found.joint < 0) return false;
  const auto i = static_cast<std::size_t>(found.joint);
  const double q = found.position[i];
  return q == robot.joints[i].lower || q == robot.joints[i].upper;
}

/// Goals that the robot can reach. @param near_rad seeds this close, or anywhere where it is 0
Tally tally(const Robot& robot, double near_rad) {
  std::mt19937 random(2);
  const SerialChain chain(robot);
  SerialChain::InverseParameters parameters;
  if (robot.joints.size() == 3) parameters.axes = 0x07;
  Tally tally;
  for (int trial = 0; trial < 10'000; ++trial) {
    const JointVector there = random_position(random, robot);
    JointVector seed = random_position(random, robot);
    for (std::size_t i = 0; near_rad > 0.0 && i < robot.joints.size(); ++i) {
      const double off = std::uniform_real_distribution<double>(-near_rad, near_rad)(random);
      seed[i] = std::clamp(there[i] + off, robot.joints[i].lower, robot.joints[i].upper);
    }
    const Pose goal = chain.flange(there);
    const SerialChain::Inverse found = chain.inverse(goal, seed, parameters);
    switch (found.status) {
      case Status::kSolved:
        ++tally.solved;
        tally.wrong += truly_solved(chain, robot, found, goal) ? 0 : 1;
        break;
      case Status::kJointLimit:
        ++tally.joint_limit;
        tally.wrong += at_limit(robot, found) ? 0 : 1;
        break;
      case Status::kNotConverged:
        ++tally.not_converged;
        tally.wrong += found.error > parameters.tolerance ? 0 : 1;
        break;
      case Status::kNotFinite:
        ++tally.wrong;
        break;
    }
  }
  return tally;
}

TEST_P(ShippedRobot, InverseConvergesFromNearbySeeds) {
  const Tally near = tally(shipped(GetParam()), 0.1);
  EXPECT_EQ(near.wrong, 0);
  EXPECT_GE(near.solved, 9'990);
  RecordProperty("solved_near", near.solved);
}

TEST_P(ShippedRobot, InverseFromAnywhereConvergesOrNamesWhy) {
  const Tally any = tally(shipped(GetParam()), 0.0);
  EXPECT_EQ(any.wrong, 0);
  EXPECT_EQ(any.solved + any.joint_limit + any.not_converged, 10'000);
  RecordProperty("solved", any.solved);
  RecordProperty("joint_limit", any.joint_limit);
  RecordProperty("not_converged", any.not_converged);
}

TEST_P(ShippedRobot, KinematicsDoesNotAllocate) {
  std::mt19937 random(3);
  const Robot robot = shipped(GetParam());
  const SerialChain chain(robot);
  const std::uint64_t before = tests::allocation_count();
  for (int trial = 0; trial < 100; ++trial) {
    const JointVector q = random_position(random, robot);
    const Pose goal = chain.flange(q);
    static_cast<void>(chain.jacobian(q));
    static_cast<void>(chain.inverse(goal, random_position(random, robot), {}));
    static_cast<void>(chain.free_axes(q));
  }
  EXPECT_EQ(tests::allocation_count(), before);
}

TEST_P(ShippedRobot, FitsItsBus) { EXPECT_NO_THROW(hw::check_bus_load(shipped(GetParam()))); }

TEST(Lwa4p, HasTheArmsOwnValues) {
  const Robot robot = shipped("lwa4p");
  ASSERT_EQ(robot.joints.size(), 6U);
  EXPECT_EQ(robot.cycle_us, 10'000U);
  EXPECT_EQ(robot.targets_per_frame, 1);
  constexpr double kMasses_kg[] = {0.294, 1.683, 2.1, 1.683, 0.807, 0.819};
  constexpr double kEfforts_Nm[] = {370.0, 370.0, 176.0, 176.0, 41.6, 20.1};
  for (std::size_t i = 0; i < 6; ++i) {
    const Joint& joint = robot.joints[i];
    EXPECT_EQ(joint.node, i + 3);
    EXPECT_EQ(joint.kind, Joint::Kind::kRevolute);
    EXPECT_EQ(canopen_drive(joint).mode, DriveMode::kInterpolatedPosition);
    EXPECT_NEAR(joint.counts_per_unit * std::numbers::pi / 2, 90000.0, 1e-9);
    EXPECT_EQ(joint.upper, i == 2 ? 2.714 : 2.967);
    EXPECT_EQ(joint.lower, -joint.upper);
    EXPECT_EQ(joint.speed_max, 1.26);
    EXPECT_EQ(joint.effort_max, kEfforts_Nm[i]);
    EXPECT_EQ(joint.link.mass_kg, kMasses_kg[i]);
  }
}

TEST(Lwa4p, StretchedOutItIsAsLongAsItsLinks) {
  const SerialChain chain(shipped("lwa4p"));
  // Upper arm and forearm on top of each other; the forearm's offset of 5.263 mm sideways.
  EXPECT_TRUE(chain.flange({}).position_m.isApprox(Vector3(0.0, 0.005263, 0.655), 1e-9))
      << chain.flange({}).position_m.transpose();
}

TEST(Csp6, IsTheLwa4psMechanicsWithPackedTargetsAtTwoMilliseconds) {
  const Robot robot = shipped("csp6");
  const Robot lwa4p = shipped("lwa4p");
  EXPECT_EQ(robot.cycle_us, 2000U);
  EXPECT_EQ(robot.targets_per_frame, 2);
  ASSERT_EQ(robot.joints.size(), lwa4p.joints.size());
  for (std::size_t i = 0; i < robot.joints.size(); ++i) {
    EXPECT_EQ(canopen_drive(robot.joints[i]).mode, DriveMode::kCyclicSynchronousPosition);
    EXPECT_EQ(robot.joints[i].origin, lwa4p.joints[i].origin);
    EXPECT_EQ(robot.joints[i].lower, lwa4p.joints[i].lower);
    EXPECT_EQ(robot.joints[i].upper, lwa4p.joints[i].upper);
    EXPECT_EQ(robot.joints[i].link.inertia_kgm2, lwa4p.joints[i].link.inertia_kgm2);
  }
}

/// Largest joint speed of tool motions of 1 m/s in the table's plane.
double speed_radps_per_mps(const SerialChain& chain, const Cell& cell, const JointVector& q) {
  const Eigen::Matrix<double, 6, 6> J = chain.jacobian(q).leftCols<6>();
  Eigen::Matrix<double, 6, 2> plane = Eigen::Matrix<double, 6, 2>::Zero();
  plane.topRows<3>() = cell.X_BT.orientation.toRotationMatrix().leftCols<2>();
  return J.partialPivLu().solve(plane).rowwise().norm().maxCoeff();
}

// What csp6.yaml says about its placement.
TEST(Csp6, ReachesItsPartOfTheTableInOnePosture) {
  for (const char* name : {"csp6", "lwa4p"}) {
    const Cell cell = shipped_cell(name);
    const SerialChain chain(cell.robot);
    const auto flange = [&](double x_m, double y_m) {
      Pose tool;
      tool.position_m = {x_m, y_m, 0.002};
      return compose(compose(cell.X_BT, tool), inverse(cell.X_FP));
    };
    constexpr JointVector kMiddle{0.0253, -0.8045, 2.5520, 0.0245, -1.5238, 0.0054};
    SerialChain::InverseParameters parameters;
    parameters.limit_margin = 0.08;
    double fastest_radps = 0.0;
    for (int row = 0; row <= 22; ++row) {
      for (const double side : {-1.0, 1.0}) {
        JointVector q = kMiddle;
        for (int column = 0; column <= 28; ++column) {
          const double x_m = -0.04 + side * 0.55 * column / 28.0;
          const SerialChain::Inverse found =
              chain.inverse(flange(x_m, -0.47 + 0.02 * row), q, parameters);
          ASSERT_EQ(found.status, Status::kSolved) << name << " " << x_m << " " << row;
          q = found.position;
          fastest_radps = std::max(fastest_radps, 0.1 * speed_radps_per_mps(chain, cell, q));
        }
      }
    }
    EXPECT_LT(fastest_radps, cell.robot.joints[0].speed_max);
    EXPECT_NEAR(cell.up_B.dot(cell.X_BT.orientation * Vector3::UnitZ()), 1.0, 1e-9);
  }
}

}  // namespace
}  // namespace tenon

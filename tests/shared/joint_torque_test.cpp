// The force from joint torque: dynamics against KDL's, the map from efforts to the wrench against
// numbers by hand and against numeric differences, and what files may say.

#include <gtest/gtest.h>

#include <cmath>
#include <kdl/chain.hpp>
#include <kdl/chainidsolver_recursive_newton_euler.hpp>
#include <limits>
#include <random>
#include <string>

#include "shared/config/friction_file.h"
#include "shared/config/load.h"
#include "shared/joint_torque/friction_memory.h"
#include "shared/joint_torque/pose_resolution.h"
#include "shared/joint_torque/torque_map.h"
#include "shared/kinematics/inverse_dynamics.h"
#include "tests/shared/slide_robot.h"
#include "tests/support/places.h"
#include "tests/support/refusal.h"
#include "tests/support/scratch_folder.h"

namespace tenon {
namespace {

using tests::refusal;
using tests::ScratchFolder;

constexpr double kG_mps2 = 9.80665;

Cell shipped_cell(const std::string& name) {
  return load_cell(tests::in_tree("hw/cells/" + name + ".yaml"));
}

KDL::Vector kdl(const Vector3& v) { return {v.x(), v.y(), v.z()}; }

KDL::RigidBodyInertia kdl(const LinkInertia& link) {
  const Eigen::Matrix3d& i = link.inertia_kgm2;
  return KDL::RigidBodyInertia(
      link.mass_kg, kdl(link.com_m),
      KDL::RotationalInertia(i(0, 0), i(1, 1), i(2, 2), i(0, 1), i(0, 2), i(1, 2)));
}

KDL::Chain kdl_chain(const Cell& cell) {
  KDL::Chain chain;
  for (std::size_t i = 0; i < cell.robot.joints.size(); ++i) {
    const Joint& joint = cell.robot.joints[i];
    const Eigen::Quaterniond& q = joint.origin.orientation;
    const KDL::Frame origin(KDL::Rotation::Quaternion(q.x(), q.y(), q.z(), q.w()),
                            kdl(joint.origin.position_m));
    chain.addSegment(KDL::Segment(KDL::Joint(KDL::Joint::None), origin));
    const bool turns = joint.kind == Joint::Kind::kRevolute;
    const KDL::Joint moving(KDL::Vector::Zero(), kdl(joint.axis),
                            turns ? KDL::Joint::RotAxis : KDL::Joint::TransAxis);
    KDL::RigidBodyInertia inertia = kdl(joint.link);
    if (i + 1 == cell.robot.joints.size()) {
      const Pose X_LS = compose(cell.robot.flange, cell.X_FS);
      const Vector3 payload_m = X_LS.position_m + X_LS.orientation * cell.payload_com_m;
      inertia = inertia + KDL::RigidBodyInertia(cell.payload_mass_kg, kdl(payload_m));
    }
    chain.addSegment(KDL::Segment(moving, KDL::Frame::Identity(), inertia));
  }
  return chain;
}

class DynamicsOf : public ::testing::TestWithParam<const char*> {};
INSTANTIATE_TEST_SUITE_P(All, DynamicsOf, ::testing::Values("gantry3", "csp6", "csp6_peg", "mit6"),
                         [](const auto& cell) { return std::string(cell.param); });

TEST_P(DynamicsOf, AgreesWithKdl) {
  const Cell cell = shipped_cell(GetParam());
  const InverseDynamics dynamics(cell);
  const KDL::Chain chain = kdl_chain(cell);
  KDL::ChainIdSolver_RNE solver(chain, kdl(Vector3(-kG_mps2 * cell.up_B)));
  const auto count = static_cast<unsigned>(cell.robot.joints.size());
  std::mt19937 random(1);
  std::uniform_real_distribution<double> draw(-1.0, 1.0);
  for (int k = 0; k < 1000; ++k) {
    JointVector q{};
    JointVector v{};
    JointVector a{};
    KDL::JntArray kq(count);
    KDL::JntArray kv(count);
    KDL::JntArray ka(count);
    KDL::JntArray torques(count);
    for (unsigned i = 0; i < count; ++i) {
      kq(i) = q[i] = 2.5 * draw(random);
      kv(i) = v[i] = 2.0 * draw(random);
      ka(i) = a[i] = 5.0 * draw(random);
    }
    const KDL::Wrenches none(chain.getNrOfSegments(), KDL::Wrench::Zero());
    ASSERT_EQ(solver.CartToJnt(kq, kv, ka, none, torques), 0);
    const JointVector effort = dynamics.effort(q, v, a);
    for (unsigned i = 0; i < count; ++i) EXPECT_NEAR(effort[i], torques(i), 1e-9) << i;
  }
}

// 24.5 kg, 12.5 kg and 4.5 kg: what each axis carries of 12 + 8 + 4 + 0.5 kg.
TEST(InverseDynamics, OfAGantryIsMassTimesAccelerationAndWeight) {
  const InverseDynamics dynamics(shipped_cell("gantry3"));
  const JointVector effort = dynamics.effort({}, {}, {1.0, 2.0, 0.5});
  EXPECT_NEAR(effort[0], 24.5, 1e-12);
  EXPECT_NEAR(effort[1], 25.0, 1e-12);
  EXPECT_NEAR(effort[2], 4.5 * (kG_mps2 + 0.5), 1e-12);
}

// The gantry's task frame has the base's axes: each effort is a force.
TEST(TorqueMap, OfAGantryEachEffortIsAForceAndTorquesAreNotResolved) {
  const Cell cell = shipped_cell("gantry3");
  const TorqueMap::At at = TorqueMap(cell).at({0.1, 0.2, 0.0});
  EXPECT_EQ(at.axes, 0x07);
  const Eigen::Matrix<double, 7, 1> efforts{3.0, -2.0, 5.0, 0.0, 0.0, 0.0, 0.0};
  const Vector6 wrench = at.to_wrench * efforts;
  EXPECT_NEAR(wrench[0], 3.0, 1e-4);
  EXPECT_NEAR(wrench[1], -2.0, 1e-4);
  EXPECT_NEAR(wrench[2], 5.0, 1e-4);
  const Vector6 resolution = TorqueMap::resolution(at, {0.5, 1.0, 2.0});
  EXPECT_NEAR(resolution[0], 0.5, 1e-4);
  EXPECT_NEAR(resolution[2], 2.0, 1e-4);
  EXPECT_TRUE(std::isinf(resolution[3]));
  EXPECT_EQ(resolution_text(resolution), "x 0.5 N, y 1 N, z 2 N; not: rx ry rz");
}

// The work of a wrench along numeric differences of the tool's pose is what the joints feel.
TEST(TorqueMap, OfSixAxesGivesBackTheWrenchThatNumericDifferencesFeel) {
  const Cell cell = shipped_cell("csp6_peg");
  const TorqueMap map(cell);
  std::mt19937 random(2);
  std::uniform_real_distribution<double> draw(-1.0, 1.0);
  int looked_at = 0;
  for (int k = 0; k < 500; ++k) {
    JointVector q{};
    for (std::size_t i = 0; i < 6; ++i) q[i] = 2.5 * draw(random);
    const TorqueMap::At at = map.at(q);
    if (at.axes != 0x3F) continue;
    Vector6 wrench;
    for (double& value : wrench) value = 20.0 * draw(random);
    Eigen::Matrix<double, 7, 1> efforts = Eigen::Matrix<double, 7, 1>::Zero();
    for (int i = 0; i < 6; ++i) {
      constexpr double kStep = 1e-6;
      JointVector ahead = q;
      JointVector behind = q;
      ahead[static_cast<std::size_t>(i)] += kStep;
      behind[static_cast<std::size_t>(i)] -= kStep;
      efforts[i] =
          wrench.dot(displacement_between(map.tool(behind), map.tool(ahead))) / (2.0 * kStep);
    }
    const SerialChain::Jacobian J = at.jacobian;
    const Eigen::JacobiSVD<SerialChain::Jacobian> svd(J);
    if (svd.singularValues()[5] < 0.05) continue;  // damping shows
    ++looked_at;
    const Vector6 found = at.to_wrench * efforts;
    EXPECT_LT((found - wrench).norm(), 0.02 * wrench.norm()) << k;
  }
  EXPECT_GT(looked_at, 200);
}

// A straight arm feels nothing along itself.
TEST(TorqueMap, AtASingularityAnAxisIsLeftOutAndNotBlownUp) {
  const Cell cell = shipped_cell("csp6_peg");
  const TorqueMap::At at = TorqueMap(cell).at({});
  EXPECT_NE(at.axes, 0x3F);
  EXPECT_LT(at.to_wrench.cwiseAbs().maxCoeff(), 1e3);
  const Vector6 resolution = TorqueMap::resolution(at, {1, 1, 1, 1, 1, 1});
  for (int axis = 0; axis < 6; ++axis) {
    EXPECT_EQ((at.axes >> axis & 1U) == 0, std::isinf(resolution[axis])) << axis;
  }
}

TEST(FrictionMemory, TurnsWithinItsWayAndStaysAtRest) {
  EXPECT_NEAR(friction_after(-1.0, 1e-4 * std::log(2.0), 1e-4), 0.0, 1e-12);
  EXPECT_NEAR(friction_after(0.3, 1.0, 1e-4), 1.0, 1e-12);
  EXPECT_NEAR(friction_after(0.3, -1.0, 1e-4), -1.0, 1e-12);
  EXPECT_EQ(friction_after(0.3, 0.0, 1e-4), 0.3);
}

constexpr const char* kFriction = R"(friction_of: slide
joints:
  - {name: turn, coulomb_Nm: 0.5, viscous_Nmspr: 0.2, offset_Nm: -0.01, way_rad: 2e-4, hysteresis_Nm: 0.1, hysteresis_way_rad: 0.02, residual_Nm: 0.1}
  - {name: x, coulomb_N: 6, viscous_Nspm: 3, offset_N: 0.1, way_m: 3e-5, hysteresis_N: 1, hysteresis_way_m: 5e-3, residual_N: 1.5}
)";

constexpr const char* kCell = R"(name: bench
robot: slide.yaml
task_in_base: {position_m: [0.1, 0.05, 0]}
tool_in_flange: {position_m: [0, 0, -0.15]}
sensor_in_flange: {position_m: [0, 0, 0]}
payload: {mass_kg: 0.5, com_m: [0, 0, -0.1]}
contact_stiffness_Npm: 5e4
joint_torque: {friction: friction.yaml}
faults: {force_N: 600, torque_Nm: 100}
)";

struct Files {
  ScratchFolder folder;
  std::filesystem::path cell;
  explicit Files(const std::string& friction = kFriction, const std::string& cell_text = kCell,
                 const std::string& robot = tests::kSlideRobot) {
    (void)folder.put("slide.urdf", tests::kSlideUrdf);
    (void)folder.put("slide.yaml", robot);
    (void)folder.put("friction.yaml", friction);
    cell = folder.put("cell.yaml", cell_text);
  }
  [[nodiscard]] std::string refused() const {
    return refusal([&] { (void)load_cell(cell); });
  }
};

// Rated 200 N and 20 Nm: 0.2 N, and 0.02 Nm over 0.3 m of lever; the robot's n of 1 and the
// force's 4.
TEST(JointTorqueCell, HasNoSensorAndTheFrictionOfItsJointsInTheUrdfsOrder) {
  const Cell cell = load_cell(Files().cell);
  ASSERT_TRUE(cell.joint_torque);
  ASSERT_EQ(cell.joint_torque->joints.size(), 2U);
  EXPECT_EQ(cell.joint_torque->joints[0].coulomb, 6.0);
  EXPECT_EQ(cell.joint_torque->joints[0].way, 3e-5);
  EXPECT_EQ(cell.joint_torque->joints[1].residual, 0.1);
  EXPECT_TRUE(cell.robot.sensor.absent());
  EXPECT_EQ(cell.robot.sensor.node, 0);
  EXPECT_NEAR(cell.robot.sensor.force_per_count_N, 0.2, 1e-12);
  EXPECT_EQ(cell.robot.measurement_delay_cycles, 5);
  EXPECT_EQ(cell.force_fault_N, 600.0);  // no sensor's range bounds it
}

TEST(JointTorqueCell, BeforeAnIdentificationKnowsNothing) {
  const Cell cell =
      load_cell(Files(kFriction, tests::replaced(kCell, "{friction: friction.yaml}", "{}")).cell);
  ASSERT_TRUE(cell.joint_torque);
  EXPECT_TRUE(cell.joint_torque->joints.empty());
  const JointVector unknown = effort_uncertainty(cell);
  EXPECT_EQ(unknown[0], 200.0);
  EXPECT_EQ(unknown[1], 20.0);
}

TEST(JointTorqueCell, ARobotWithoutASensorNeedsIt) {
  std::string robot = tests::kSlideRobot;
  robot.resize(robot.find("sensor:"));
  EXPECT_TRUE(load_cell(Files(kFriction, kCell, robot).cell).robot.sensor.absent());
  const std::string line =
      Files(kFriction, tests::replaced(kCell, "joint_torque: {friction: friction.yaml}\n", ""),
            robot)
          .refused();
  EXPECT_NE(line.find("cell.yaml:2: robot: robot slide has no force/torque sensor; say "
                      "joint_torque: {}"),
            std::string::npos)
      << line;
}

TEST(JointTorqueCell, RefusalsNameFileLineAndKey) {
  const auto with = [](const char* what, const char* by) {
    return Files(tests::replaced(kFriction, what, by)).refused();
  };
  const auto has = [](const std::string& line, const std::string& part) {
    EXPECT_NE(line.find(part), std::string::npos) << line;
  };
  has(with("friction_of: slide", "friction_of: other"), "friction_of = other, must be slide");
  has(with("residual_N: 1.5", "residual_N: 0"), "residual_N = 0, must be in (0, 100000]");
  has(with("way_m: 3e-5", "way_m: 2"), "way_m = 2, must be in (0, 1]");
  has(with("name: x", "name: turn"), "listed once");
  has(with("name: turn", "name: z"), "a joint of robot slide");
  has(with(" coulomb_Nm", " coulomb_N"), "did you mean coulomb_Nm");
  has(Files(tests::kSlideRobot).refused(), "is a robot file, not a friction file");
  const std::string biased =
      std::string(kCell) +
      "sensor_bias: {force_N: [0, 0, 0], torque_Nm: [0, 0, 0], force_tolerance_N: 1, "
      "torque_tolerance_Nm: 1}\n";
  has(Files(kFriction, biased).refused(), "sensor_bias");
}

TEST(PoseResolution, OfAGantryIsEachJointsResidual) {
  Cell cell = shipped_cell("gantry3");
  cell.joint_torque.emplace();
  cell.joint_torque->joints.resize(3);
  for (std::size_t i = 0; i < 3; ++i) cell.joint_torque->joints[i].residual = 1.0 + double(i);
  const auto resolution = resolution_at(cell, {Vector3(0.1, 0.0, 0.01), {1, 0, 0, 0}});
  ASSERT_TRUE(resolution);
  EXPECT_NEAR((*resolution)[0], 1.0, 1e-4);
  EXPECT_NEAR((*resolution)[1], 2.0, 1e-4);
  EXPECT_NEAR((*resolution)[2], 3.0, 1e-4);
  EXPECT_FALSE(resolution_at(cell, {Vector3(5.0, 0.0, 0.0), {1, 0, 0, 0}}));
}

}  // namespace
}  // namespace tenon

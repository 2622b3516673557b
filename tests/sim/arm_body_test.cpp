// The articulated arm against the mechanics of mechanics.h and what follows from it in closed form.

#include "sim/cell/virtual_arm/arm_body.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>

#include "shared/base/error.h"
#include "tests/sim/arm_bench.h"
#include "tests/sim/mechanics.h"
#include "tests/sim/six_axis_cell.h"
#include "tests/support/refusal.h"

namespace tenon::sim {
namespace {

TEST(ArmBodyTest, TheToolStandsWhereTheJointsSayAtTheStartAndAfterAMotion) {
  const Cell cell = six_axis_cell();
  ArmBench bench(cell, kElbow);
  bench.enable();
  const auto check = [&] {
    Eigen::Isometry3d sensor;
    static_cast<void>(bodies_at(cell, bench.position(), &sensor));
    const Vector3 sensor_in_tool =
        inverse(cell.X_FP).position_m + inverse(cell.X_FP).orientation * cell.X_FS.position_m;
    const Pose tool = bench.arm.tool();
    const Vector3 there_m = tool.position_m + tool.orientation * sensor_in_tool;
    EXPECT_LT((there_m - sensor.translation()).norm(), 1e-6);
  };
  check();
  for (int i = 0; i < 1000; ++i) {
    for (std::size_t j = 0; j < 6; ++j) {
      bench.demands[j].velocity = 0.8;
      bench.demands[j].position += 0.8 * kStep_s;
    }
    bench.arm.step(bench.demands, kStep_s);
  }
  EXPECT_NEAR(bench.arm.joint(2).position, kElbow[2] + 0.4, 1e-3);
  check();
}

TEST(ArmBodyTest, AtRestEveryServoCarriesTheTorqueOfGravity) {
  const Cell cell = six_axis_cell();
  std::mt19937_64 random(3);
  for (int pose = 0; pose < 5; ++pose) {
    ArmBench bench(cell, random_position(cell, random));
    bench.enable();
    bench.run(0.5);
    const JointVector position = bench.position();
    for (std::size_t i = 0; i < 6; ++i) {
      EXPECT_NEAR(bench.arm.joint(i).effort, gravity_effort(cell, position, i), 1e-3)
          << "pose " << pose << " joint " << i;
      // The integral part leaves nothing of the sag.
      EXPECT_NEAR(position[i], bench.demands[i].position, 1e-7);
    }
    EXPECT_EQ(bench.arm.solver_messages(), 0U);
  }
}

TEST(ArmBodyTest, WithoutAnIntegralPartItSagsByEffortOverStiffness) {
  const Cell cell = six_axis_cell();
  ArmBench bench(cell, kElbow, without_integral());
  bench.enable();
  bench.run(0.5);
  for (std::size_t i = 0; i < 6; ++i) {
    const double effort = gravity_effort(cell, bench.position(), i);
    EXPECT_NEAR(bench.arm.joint(i).position - kElbow[i], -effort / cell.robot.joints[i].stiffness,
                1e-8)
        << i;
  }
}

TEST(ArmBodyTest, AtRestTheSensorReadsThePayloadsWeightInItsAxesAtAHundredPoses) {
  Cell cell = six_axis_cell();
  cell.up_B = Vector3(0.2, -0.5, 0.9).normalized();  // hung askew
  std::mt19937_64 random(4);
  for (int pose = 0; pose < 100; ++pose) {
    ArmBench bench(cell, random_position(cell, random));
    if (pose % 2 == 0) bench.enable();
    bench.run(pose % 2 == 0 ? 0.4 : 0.02);
    Eigen::Isometry3d sensor;
    static_cast<void>(bodies_at(cell, bench.position(), &sensor));
    const Vector3 weight_N =
        sensor.linear().transpose() * (-cell.payload_mass_kg * kGravity_mps2 * cell.up_B);
    EXPECT_LT((bench.arm.wrench().head<3>() - weight_N).norm(), 1e-3) << pose;
    EXPECT_LT((bench.arm.wrench().tail<3>() - cell.payload_com_m.cross(weight_N)).norm(), 1e-4)
        << pose;
  }
}

TEST(ArmBodyTest, InMotionTheSensorFeelsThePayloadsInertia) {
  // A pendulum held level that turns about the vertical: centripetal force m w^2 r.
  Cell cell = pendulum({0.4}, {1.0});
  cell.robot.joints[0].axis = Vector3::UnitZ();
  cell.payload_mass_kg = 0.5;
  cell.payload_com_m = {0.6, 0.0, 0.0};
  ArmBench bench(cell, {});
  bench.enable();
  constexpr double kSpeed_radps = 1.5;
  for (int i = 0; i < 2000; ++i) {
    bench.demands[0].velocity = kSpeed_radps;
    bench.demands[0].position += kSpeed_radps * kStep_s;
    bench.arm.step(bench.demands, kStep_s);
  }
  const double outward_N = 0.5 * kSpeed_radps * kSpeed_radps * 0.6;
  EXPECT_NEAR(bench.arm.wrench()[0], outward_N, 5e-3 * outward_N);
  EXPECT_NEAR(bench.arm.wrench()[1], 0.0, 5e-3);
  EXPECT_NEAR(bench.arm.wrench()[2], -0.5 * kGravity_mps2, 5e-3);
}

// x(t) = 1 - (1 + wt) exp(-wt), w^2 = K / M, M the diagonal of the mass matrix: the joint's own
// inertia as the arm stands, which differs by a factor between a folded and a stretched arm.
TEST(ArmBodyTest, AServoIsCriticallyDampedInAnyPose) {
  const Cell cell = six_axis_cell();
  constexpr double kJump = 0.002;
  for (const JointVector& start : {JointVector{0.0, 1.5, 0.0, 0.0, 0.0, 0.0, 0.0},
                                   JointVector{0.0, 1.5, 2.5, 0.3, 1.5, 0.0}}) {
    for (const std::size_t joint : {1U, 2U, 5U}) {
      ArmBench bench(cell, start, without_integral());
      ArmBench::enable(bench.demands[joint]);
      bench.run(0.3);
      const double from = bench.arm.joint(joint).position;
      const double inertia =
          mass_matrix(cell, start)(static_cast<int>(joint), static_cast<int>(joint));
      const double w_radps = std::sqrt(cell.robot.joints[joint].stiffness / inertia);
      bench.demands[joint].position += kJump;
      double largest = 0.0;
      for (int i = 1; i <= 400; ++i) {
        bench.arm.step(bench.demands, kStep_s);
        const double t_s = i * kStep_s;
        const double moved = (bench.arm.joint(joint).position - from) / kJump;
        const double expected = 1.0 - (1.0 + w_radps * t_s) * std::exp(-w_radps * t_s);
        // The implicit step smears the response by about a step of time.
        EXPECT_NEAR(moved, expected, 0.6 * w_radps * kStep_s) << joint << " at " << t_s << " s";
        largest = std::max(largest, moved);
      }
      EXPECT_LT(largest, 1.001) << joint;
    }
  }
}

TEST(ArmBodyTest, BrakesHoldTheWholeArm) {
  const Cell cell = six_axis_cell();
  ArmBench bench(cell, kElbow);
  bench.run(2.0);
  for (std::size_t i = 0; i < 6; ++i) {
    EXPECT_NEAR(bench.arm.joint(i).position, kElbow[i], 1e-6) << i;
    EXPECT_EQ(bench.arm.joint(i).effort, 0.0);
  }
}

TEST(ArmBodyTest, ReleasingTheBrakesMovesNoJoint) {
  const Cell cell = six_axis_cell();
  ArmBench bench(cell, kElbow);
  bench.run(0.1);
  bench.enable();
  for (int i = 0; i < 400; ++i) {
    bench.arm.step(bench.demands, kStep_s);
    for (std::size_t j = 0; j < 6; ++j) {
      EXPECT_NEAR(bench.arm.joint(j).position, kElbow[j], 1e-5) << j;
    }
  }
}

TEST(ArmBodyTest, AServoThatLostItsTorqueGivesWay) {
  const Cell cell = six_axis_cell();
  ArmBench bench(cell, kElbow);
  bench.enable();
  bench.run(0.1);
  const double needed_Nm = std::abs(gravity_effort(cell, kElbow, 1));
  bench.demands[1].effort_max = 1.5 * needed_Nm;
  bench.run(0.2);
  EXPECT_NEAR(bench.arm.joint(1).position, kElbow[1], 1e-3);
  bench.demands[1].effort_max = 0.5 * needed_Nm;
  bench.run(0.2);
  EXPECT_GT(std::abs(bench.arm.joint(1).position - kElbow[1]), 0.05);
  EXPECT_NEAR(std::abs(bench.arm.joint(1).effort), 0.5 * needed_Nm, 1e-6);
}

TEST(ArmBodyTest, PositionsGoOnBeyondHalfATurnAndEndAtTheStops) {
  Cell cell = pendulum({0.3}, {1.0});
  cell.up_B = Vector3::UnitY();  // turns level
  JointVector start{};
  start[0] = 2.5;
  ArmBench bench(cell, start);
  bench.enable();
  const auto turn = [&](double speed_radps, double duration_s) {
    bench.demands[0].velocity = speed_radps;
    for (double t_s = 0.0; t_s < duration_s - 0.5 * kStep_s; t_s += kStep_s) {
      bench.demands[0].position += speed_radps * kStep_s;
      bench.arm.step(bench.demands, kStep_s);
      ASSERT_NEAR(bench.arm.joint(0).position, bench.demands[0].position, 0.01);
    }
  };
  turn(2.0, 1.6);
  EXPECT_NEAR(bench.arm.joint(0).position, 5.7, 0.01);
  turn(-2.0, 5.6);
  EXPECT_NEAR(bench.arm.joint(0).position, -5.5, 0.01);
  // It is thrown against the stop at -6 rad, without power.
  bench.release_all();
  double lowest = 0.0;
  for (int i = 0; i < 1000; ++i) {
    bench.arm.step(bench.demands, kStep_s);
    lowest = std::min(lowest, bench.arm.joint(0).position);
  }
  EXPECT_NEAR(lowest, -6.0, 0.01);
}

TEST(ArmBodyTest, BacklashIsBetweenEncoderAndLink) {
  // Loaded by gravity the gear always drives on the same side. The load is reversed by turning the
  // arm from one side of upright to the other: the link then lies on the other flank.
  Cell cell = pendulum({0.3}, {1.0});
  ArmBody::Parameters parameters;
  parameters.backlash_rad = 0.002;
  JointVector start{};
  start[0] = -std::numbers::pi / 2 - 0.3;
  ArmBench bench(cell, start, parameters);
  bench.enable();
  bench.run(0.3);
  const double play_before = bench.arm.joint(0).encoder - bench.arm.joint(0).position;
  bench.demands[0].velocity = 0.6;
  for (int i = 0; i < 2000; ++i) {
    bench.demands[0].position += 0.6 * kStep_s;
    bench.arm.step(bench.demands, kStep_s);
  }
  bench.demands[0].velocity = 0.0;
  bench.run(0.3);
  const double play_after = bench.arm.joint(0).encoder - bench.arm.joint(0).position;
  EXPECT_NEAR(std::abs(play_before), 0.001, 1e-9);
  EXPECT_NEAR(play_after, -play_before, 1e-9);
  EXPECT_NEAR(bench.arm.joint(0).encoder, bench.demands[0].position, 1e-5);
}

TEST(ArmBodyTest, ALinkWithoutMassIsRefusedByName) {
  Cell cell = six_axis_cell();
  cell.robot.joints[3].link.mass_kg = 0.0;
  EXPECT_EQ(tests::refusal([&] { const ArmBody arm(cell, empty_task(), {}); }),
            "robot six_axis: the link behind joint arm_4 has mass 0.000000 kg, must be > 0");
  cell = six_axis_cell();
  cell.robot.joints[5].link.inertia_kgm2(0, 0) = -1.0;
  EXPECT_THROW(ArmBody(cell, empty_task(), {}), InputError);
}

}  // namespace
}  // namespace tenon::sim

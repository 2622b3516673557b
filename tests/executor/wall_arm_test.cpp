// The double itself.

#include "tests/support/wall_arm.h"

#include <gtest/gtest.h>

#include "tests/support/hand_made.h"

namespace tenon::executor {
namespace {

struct Stepper {
  WallArm arm{hand_made_cell(), Pose{Vector3(0.1, 0, 0), Eigen::Quaterniond::Identity()}};
  ArmFeedback feedback;
  std::int64_t now_ns = 0;

  bool step(ArmRequest request, const JointVector& position) {
    now_ns += 2'000'000;
    arm.start_cycle(now_ns);
    const bool complete = arm.receive(now_ns, feedback);
    arm.command(now_ns, request, position);
    return complete;
  }
};

TEST(WallArm, ItsToolStandsWhereItWasPut) {
  const Stepper stepper;
  EXPECT_LT((stepper.arm.tool().position_m - Vector3(0.1, 0, 0)).norm(), 1e-8);
  EXPECT_LT(rotation_vector(stepper.arm.tool().orientation).norm(), 1e-9);
}

// command at k -> moves at k + 1 -> told at k + 2
TEST(WallArm, ItFollowsOnlyWhileEnabledAndTellsACycleLater) {
  Stepper stepper;
  EXPECT_FALSE(stepper.step(ArmRequest::kDisabled, {}));  // nothing measured yet
  EXPECT_TRUE(stepper.step(ArmRequest::kDisabled, {}));
  const JointVector start = stepper.feedback.position;
  JointVector target = start;
  target[1] += 0.01;
  while (stepper.arm.state() != ArmState::kEnabled) {
    stepper.step(ArmRequest::kEnabled, target);
    EXPECT_EQ(stepper.feedback.position, start);
  }
  stepper.step(ArmRequest::kEnabled, target);
  EXPECT_EQ(stepper.feedback.position, start);
  stepper.step(ArmRequest::kEnabled, target);
  EXPECT_EQ(stepper.feedback.position, target);
}

TEST(WallArm, AWallPushesBackByItsDepth) {
  Stepper stepper;
  stepper.arm.walls.push_back({0, +1, 0.0998});
  EXPECT_NEAR(stepper.arm.wall_force_N().x(), -10.0, 1e-3);
  stepper.arm.walls[0].sign = -1;
  stepper.arm.walls[0].position_m = 0.1001;
  EXPECT_NEAR(stepper.arm.wall_force_N().x(), 5.0, 1e-3);
}

TEST(WallArm, AMuteJointIsNotFreshAndABrokenArmIsInFault) {
  Stepper stepper;
  stepper.arm.mute_joints = 0x4;
  stepper.step(ArmRequest::kEnabled, {});
  EXPECT_FALSE(stepper.step(ArmRequest::kEnabled, {}));
  EXPECT_EQ(stepper.feedback.joints_fresh, 0x3U);
  stepper.arm.break_with.kind = ArmFaultKind::kBusOff;
  stepper.step(ArmRequest::kEnabled, {});
  EXPECT_EQ(stepper.feedback.state, ArmState::kFault);
  EXPECT_EQ(stepper.feedback.fault.kind, ArmFaultKind::kBusOff);
}

}  // namespace
}  // namespace tenon::executor

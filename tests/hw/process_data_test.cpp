// What stands on the bus, byte by byte: an LWA 4P in mode 7 with its default PDOs, and targets
// packed two to a frame, where the controlwords travel apart and must not get lost.

#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include "hw/arm/describe_fault.h"
#include "shared/canopen/robot_drives.h"
#include "tests/hw/gantry_on_bus.h"
#include "tests/support/frame_filter.h"

namespace tenon::hw {
namespace {

using Bytes = std::vector<std::uint8_t>;

Bytes bytes_of(const CanFrame& frame) {
  return {frame.data.begin(), frame.data.begin() + frame.length};
}

/// Six revolute joints of 1000 counts a degree.
Robot six_axes(DriveMode mode, std::uint8_t first_node, int targets_per_frame) {
  Robot robot = gantry_robot();
  robot.joints.resize(6, robot.joints.front());
  for (std::size_t i = 0; i < robot.joints.size(); ++i) {
    robot.joints[i].name = "arm_" + std::to_string(i + 1);
    robot.joints[i].kind = Joint::Kind::kRevolute;
    canopen_drive(robot.joints[i]).mode = mode;
    robot.joints[i].node = static_cast<std::uint8_t>(first_node + i);
    robot.joints[i].counts_per_unit = 1000.0 * 180.0 / M_PI;
    robot.joints[i].following_error_max = 0.05;
  }
  robot.sensor.node = 9;
  robot.targets_per_frame = targets_per_frame;
  return robot;
}

class SixAxesOnBus : public GantryOnBus {
 public:
  explicit SixAxesOnBus(const Robot& six) : GantryOnBus(six) {
    for (std::size_t i = 0; i < robot.joints.size(); ++i) {
      // 6502h of an LWA 4P: no mode 8; else mode 8 alone.
      const bool interpolated =
          canopen_drive(robot.joints[i]).mode == DriveMode::kInterpolatedPosition;
      nodes[i]->keeps[0x650200] = interpolated ? 0x43 : 0x80;
    }
  }
  /// The setpoints leave, and the nodes take them in.
  void cycle_and_deliver(ArmRequest request, const JointVector& position = {}) {
    step_nodes();  // what the cycle before has sent
    for (const auto& node : nodes) node->commands.clear();
    cycle(request, position);
    step_nodes();
  }
};

Robot lwa4p() { return six_axes(DriveMode::kInterpolatedPosition, 3, 1); }
Robot packed() { return six_axes(DriveMode::kCyclicSynchronousPosition, 1, 2); }

TEST(ProcessData, AnLwa4pKeepsItsDefaultMappings) {
  SixAxesOnBus arm(lwa4p());
  ASSERT_TRUE(arm.prepare()) << describe(arm.arm.fault(), arm.robot);
  auto& objects = arm.nodes[0]->objects;
  EXPECT_EQ(objects[0x160000].value, 2u);
  EXPECT_EQ(objects[0x160001].value, 0x60400010u);
  EXPECT_EQ(objects[0x160002].value, 0x60C10120u);
  EXPECT_EQ(objects[0x1A0000].value, 3u);
  EXPECT_EQ(objects[0x1A0001].value, 0x60410010u);
  EXPECT_EQ(objects[0x1A0002].value, 0x60770010u);
  EXPECT_EQ(objects[0x1A0003].value, 0x60640020u);
  EXPECT_EQ(objects[0x606000].value, 7u);
}

TEST(ProcessData, NinetyDegreesOnAnLwa4pAre90000CountsInModeSevenWithBitFour) {
  SixAxesOnBus arm(lwa4p());
  ASSERT_TRUE(arm.prepare_and_enable()) << describe(arm.arm.fault(), arm.robot);
  arm.cycle_and_deliver(ArmRequest::kEnabled, {M_PI / 2, -M_PI / 2, 0.0, 0.0, 0.0, M_PI / 180});
  // 90000 = 0x00015F90, -90000 = 0xFFFEA070, 1000 = 0x000003E8.
  EXPECT_EQ(arm.nodes[0]->commands.back().id, 0x203u);
  EXPECT_EQ(bytes_of(arm.nodes[0]->commands.back()), (Bytes{0x1F, 0x00, 0x90, 0x5F, 0x01, 0x00}));
  EXPECT_EQ(bytes_of(arm.nodes[1]->commands.back()), (Bytes{0x1F, 0x00, 0x70, 0xA0, 0xFE, 0xFF}));
  EXPECT_EQ(arm.nodes[5]->commands.back().id, 0x208u);
  EXPECT_EQ(bytes_of(arm.nodes[5]->commands.back()), (Bytes{0x1F, 0x00, 0xE8, 0x03, 0x00, 0x00}));
}

TEST(ProcessData, AnLwa4psFeedbackIsStatuswordTorquePosition) {
  SixAxesOnBus arm(lwa4p());
  ASSERT_TRUE(arm.prepare());
  arm.nodes[0]->answers_sync = false;
  arm.arm.start_cycle(arm.now_ns);
  arm.step_nodes();
  // 0x0237, -250 thousandths of 200 Nm, 45000 counts.
  arm.nodes[0]->send(0x190, {0x37, 0x02, 0x06, 0xFF, 0xC8, 0xAF, 0x00, 0x00});
  EXPECT_TRUE(arm.arm.receive(arm.now_ns, arm.feedback));
  EXPECT_NEAR(arm.feedback.position[0], M_PI / 4, 1e-12);
  EXPECT_DOUBLE_EQ(arm.feedback.effort[0], -50.0);
}

TEST(ProcessData, ModeEightGoesWithoutBitFour) {
  SixAxesOnBus arm(six_axes(DriveMode::kCyclicSynchronousPosition, 3, 1));
  ASSERT_TRUE(arm.prepare_and_enable());
  arm.cycle_and_deliver(ArmRequest::kEnabled, {M_PI / 2});
  EXPECT_EQ(bytes_of(arm.nodes[0]->commands.back()), (Bytes{0x0F, 0x00, 0x90, 0x5F, 0x01, 0x00}));
}

TEST(ProcessData, PackedTargetsAreMappedByDummiesInEachOthersHalves) {
  SixAxesOnBus arm(packed());
  ASSERT_TRUE(arm.prepare()) << describe(arm.arm.fault(), arm.robot);
  for (std::size_t i : {std::size_t{2}, std::size_t{3}}) {
    auto& objects = arm.nodes[i]->objects;
    EXPECT_EQ(objects[0x140001].value, 0x00000203u);
    EXPECT_EQ(objects[0x140002].value, 1u);
    EXPECT_EQ(objects[0x160000].value, 2u);
    EXPECT_EQ(objects[0x160001].value, i == 2 ? 0x607A0020u : 0x00040020u);
    EXPECT_EQ(objects[0x160002].value, i == 2 ? 0x00040020u : 0x607A0020u);
    EXPECT_EQ(objects[0x140101].value, i == 2 ? 0x00000303u : 0x00000304u);
    EXPECT_EQ(objects[0x140102].value, 255u);
    EXPECT_EQ(objects[0x160100].value, 1u);
    EXPECT_EQ(objects[0x160101].value, 0x60400010u);
  }
}

TEST(ProcessData, PackedTargetsOfNinetyAndMinusNinetyDegreesOnTheWire) {
  SixAxesOnBus arm(packed());
  ASSERT_TRUE(arm.prepare_and_enable()) << describe(arm.arm.fault(), arm.robot);
  arm.cycle_and_deliver(ArmRequest::kEnabled, {M_PI / 2, -M_PI / 2, 0.0, 0.0, 0.0, M_PI / 180});
  // One frame for both, and no controlword: nothing has changed.
  for (std::size_t i : {std::size_t{0}, std::size_t{1}}) {
    ASSERT_EQ(arm.nodes[i]->commands.size(), 1u);
    EXPECT_EQ(arm.nodes[i]->commands[0].id, 0x201u);
    EXPECT_EQ(bytes_of(arm.nodes[i]->commands[0]),
              (Bytes{0x90, 0x5F, 0x01, 0x00, 0x70, 0xA0, 0xFE, 0xFF}));
  }
  EXPECT_EQ(arm.nodes[5]->commands[0].id, 0x205u);
  EXPECT_EQ(bytes_of(arm.nodes[5]->commands[0]), (Bytes{0, 0, 0, 0, 0xE8, 0x03, 0x00, 0x00}));
  arm.cycle(ArmRequest::kEnabled, {M_PI / 2, -M_PI / 2});
  EXPECT_EQ(arm.nodes[0]->position_counts, 90000);
  EXPECT_EQ(arm.nodes[1]->position_counts, -90000);
  EXPECT_EQ(arm.nodes[5]->position_counts, 1000);
}

TEST(ProcessData, TheLastOfAnOddNumberOfPackedJointsHasAFrameForItself) {
  Robot robot = gantry_robot();
  robot.targets_per_frame = 2;
  GantryOnBus gantry(robot);
  ASSERT_TRUE(gantry.prepare_and_enable());
  EXPECT_EQ(gantry.nodes[2]->objects[0x160000].value, 1u);
  gantry.step_nodes();
  gantry.nodes[2]->commands.clear();
  gantry.cycle(ArmRequest::kEnabled, {0.0, 0.0, 0.25});
  gantry.step_nodes();
  ASSERT_EQ(gantry.nodes[2]->commands.size(), 1u);
  EXPECT_EQ(gantry.nodes[2]->commands[0].id, 0x203u);
  EXPECT_EQ(bytes_of(gantry.nodes[2]->commands[0]), (Bytes{0x90, 0xD0, 0x03, 0x00}));
}

TEST(ProcessData, PackedControlwordsLeaveOnChangeAloneAndAheadOfTheTargets) {
  SixAxesOnBus arm(packed());
  ASSERT_TRUE(arm.prepare());
  std::vector<std::string> sent;
  const tests::FrameFilter filter(arm.bus, [&](CanFrame& frame, std::size_t) {
    if (frame.id == 0x304) sent.push_back("controlword " + std::to_string(frame.data[0]));
    if (frame.id == 0x203) sent.emplace_back("targets");
    return true;
  });
  ASSERT_TRUE(arm.run_until(ArmState::kEnabled, ArmRequest::kEnabled));
  const std::vector<std::string> up{"controlword 6",  "targets", "controlword 7", "targets",
                                    "controlword 15", "targets", "targets"};
  EXPECT_EQ(sent, up);
  sent.clear();
  for (int i = 0; i < 20; ++i) arm.cycle(ArmRequest::kEnabled, arm.feedback.position);
  EXPECT_EQ(sent, std::vector<std::string>(20, "targets"));
}

// SYNC k      command: 02 at once             SYNC k + 1
//  |            |--> drive stops now            |
//  |            |        with type 1 it would stop here
TEST(ProcessData, PackedQuickStopActsBeforeTheNextSync) {
  SixAxesOnBus arm(packed());
  ASSERT_TRUE(arm.prepare_and_enable());
  arm.cycle_and_deliver(ArmRequest::kQuickStop);
  for (std::size_t i = 0; i < 6; ++i) {
    EXPECT_EQ(arm.nodes[i]->controlword, 0x02);
    EXPECT_EQ(arm.nodes[i]->statusword, 0x0217);
    EXPECT_EQ(bytes_of(arm.nodes[i]->commands.front()), (Bytes{0x02, 0x00}));
  }
}

/// Drops the first frames of an identifier.
class LosesFirst {
 public:
  LosesFirst(SixAxesOnBus& arm, std::uint32_t id, int count)
      : filter_(arm.bus, [this, id, count](CanFrame& frame, std::size_t) {
          return frame.id != id || ++seen_ > count;
        }) {}
  [[nodiscard]] int seen() const { return seen_; }

 private:
  int seen_ = 0;
  tests::FrameFilter filter_;
};

TEST(ProcessData, LostPackedControlwordIsRepeatedUntilTheDriveIsEnabled) {
  SixAxesOnBus arm(packed());
  ASSERT_TRUE(arm.prepare());
  const LosesFirst loses(arm, 0x304, 3);
  ASSERT_TRUE(arm.run_until(ArmState::kEnabled, ArmRequest::kEnabled, 20));
  EXPECT_EQ(loses.seen(), 6);
  EXPECT_EQ(arm.arm.fault().kind, ArmFaultKind::kNone);
}

TEST(ProcessData, LostPackedQuickStopIsRepeatedUntilTheDriveStops) {
  SixAxesOnBus arm(packed());
  ASSERT_TRUE(arm.prepare_and_enable());
  const LosesFirst loses(arm, 0x304, 3);
  for (int i = 0; i < 10; ++i) arm.cycle(ArmRequest::kQuickStop);
  EXPECT_EQ(arm.nodes[3]->statusword, 0x0217);
  // Lost in three cycles, heard in the fourth; the fifth sees the drive's answer.
  EXPECT_EQ(loses.seen(), 4);
}

TEST(ProcessData, LostStopOfADriveFaultIsRepeatedForTheOthers) {
  SixAxesOnBus arm(packed());
  ASSERT_TRUE(arm.prepare_and_enable());
  const LosesFirst loses(arm, 0x302, 2);
  arm.nodes[0]->statusword = 0x0218;
  for (int i = 0; i < 5; ++i) arm.cycle(ArmRequest::kEnabled, arm.feedback.position);
  EXPECT_EQ(arm.arm.fault().kind, ArmFaultKind::kDriveFault);
  EXPECT_EQ(arm.nodes[1]->statusword, 0x0217);
}

TEST(ProcessData, LostPackedDisableIsRepeatedUntilTheBrakeIsOn) {
  SixAxesOnBus arm(packed());
  ASSERT_TRUE(arm.prepare_and_enable());
  const LosesFirst loses(arm, 0x304, 2);
  ASSERT_TRUE(arm.run_until(ArmState::kDisabled, ArmRequest::kDisabled, 20));
  EXPECT_EQ(arm.nodes[3]->statusword, 0x0231);
  for (int i = 0; i < 3; ++i) arm.cycle(ArmRequest::kDisabled);
  EXPECT_EQ(arm.nodes[3]->statusword, 0x0250);
}

// In mode 7 the word that lets the axis move changes no state: bit 12 of the statusword tells.
TEST(ProcessData, LostPackedBitFourIsRepeatedUntilTheDriveInterpolates) {
  SixAxesOnBus arm(six_axes(DriveMode::kInterpolatedPosition, 1, 2));
  ASSERT_TRUE(arm.prepare());
  int lost = 0;
  const tests::FrameFilter filter(arm.bus, [&](CanFrame& frame, std::size_t) {
    return frame.id != 0x304 || frame.data[0] != 0x1F || ++lost > 3;
  });
  ASSERT_TRUE(arm.run_until(ArmState::kEnabled, ArmRequest::kEnabled));
  for (int i = 0; i < 10; ++i) arm.cycle(ArmRequest::kEnabled, {0.0, 0.0, 0.0, M_PI / 2});
  EXPECT_EQ(arm.nodes[3]->controlword, 0x1F);
  EXPECT_EQ(arm.nodes[3]->position_counts, 90000);
  EXPECT_EQ(lost, 4);
}

}  // namespace
}  // namespace tenon::hw

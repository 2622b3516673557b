// Arm and sensor on two interfaces of the kernel: a whole plan, and each taken down in mid-plan.

#include <gtest/gtest.h>

#include <string>

#include "hw/can/polled_pair.h"
#include "hw/can/socketcan_bus.h"
#include "tests/socketcan/box_run.h"
#include "tests/socketcan/interfaces.h"

namespace tenon::socketcan {
namespace {

using executor::EndReason;
using hw::SocketcanBus;

/// One side's ends of both.
struct Ends {
  Ends(const std::string& arm_interface, const std::string& sensor_interface)
      : arm(arm_interface, kMbit_bps, kBurst_frames),
        sensor(sensor_interface, kMbit_bps, kBurst_frames) {}
  SocketcanBus arm;
  SocketcanBus sensor;
  hw::PolledPair both{arm, sensor};
};

class TwoInterfaces : public testing::Test {
 protected:
  void expect_named(const std::string& what) {
    for (int i = 0; i < 5000 && box.lockstep().cycle(); ++i) {
    }
    const auto result = box.lockstep().result();
    EXPECT_EQ(result.ending.reason, EndReason::kArmFault) << result.reason;
    EXPECT_NE(result.reason.find(what), std::string::npos) << result.reason;
    std::printf("%s\n", result.reason.c_str());
    box.lockstep().leave_alone(2.0);
    EXPECT_TRUE(box.lockstep().cell().at_standstill());
    for (const auto& drive : box.lockstep().cell().truth().drives) {
      EXPECT_TRUE(drive.brake_engaged) << drive.joint;
    }
  }

  const VirtualInterface vcan0{"vcan0"};
  const VirtualInterface vcan1{"vcan1"};
  Ends master{"vcan0", "vcan1"};
  Ends devices{"vcan0", "vcan1"};
  BoxRun box{master.both, devices.both, kMbit_bps};
};

TEST_F(TwoInterfaces, CarryAWholePlan) {
  const auto result = box.lockstep().run();
  EXPECT_EQ(result.ending.reason, EndReason::kPlanDone) << result.reason;
  EXPECT_LT(result.truth.error_norm_m, 0.01);
  box.lockstep().leave_alone(0.01);  // the last frames arrive
  EXPECT_EQ(box.link().lost(), 0U);
  EXPECT_EQ(master.arm.status().sent, devices.arm.status().received);
  EXPECT_EQ(master.sensor.status().sent, devices.sensor.status().received);
  EXPECT_EQ(devices.sensor.status().sent, master.sensor.status().received);
  std::printf(
      "%lld cycles, %llu frames on the arm's bus, %llu on the sensor's\n",
      static_cast<long long>(result.cycles),
      static_cast<unsigned long long>(master.arm.status().sent + devices.arm.status().sent),
      static_cast<unsigned long long>(master.sensor.status().sent + devices.sensor.status().sent));
}

TEST_F(TwoInterfaces, TheArmsTakenDownInMidPlanIsNamed) {
  ASSERT_TRUE(box.into_motion()) << box.lockstep().result().reason;
  run("ip link set vcan0 down");
  expect_named("the CAN bus of the arm is gone");
}

TEST_F(TwoInterfaces, TheSensorsTakenDownInMidPlanIsNamed) {
  ASSERT_TRUE(box.into_motion()) << box.lockstep().result().reason;
  run("ip link set vcan1 down");
  expect_named("the CAN bus of the force/torque sensor is gone");
}

}  // namespace
}  // namespace tenon::socketcan

// Bring-up and a whole plan through the kernel's CAN, and what happens when it goes away.

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <string>

#include "hw/can/socketcan_bus.h"
#include "tests/socketcan/box_run.h"
#include "tests/socketcan/interfaces.h"

namespace tenon::socketcan {
namespace {

using executor::EndReason;
using hw::SocketcanBus;

void expect_brakes(const sim::Truth& truth) {
  ASSERT_EQ(truth.drives.size(), 3U);
  for (const auto& drive : truth.drives) EXPECT_TRUE(drive.brake_engaged) << drive.joint;
}

void expect_whole_plan(const std::string& master_interface, const std::string& device_interface) {
  SocketcanBus master(master_interface, kMbit_bps, kBurst_frames);
  SocketcanBus devices(device_interface, kMbit_bps, kBurst_frames);
  BoxRun run(master, devices);
  const auto result = run.lockstep().run();
  EXPECT_EQ(result.ending.reason, EndReason::kPlanDone) << result.reason;
  EXPECT_LT(result.truth.error_norm_m, 0.01);
  expect_brakes(result.truth);
  run.lockstep().leave_alone(0.01);  // the last frames arrive
  EXPECT_EQ(run.link().lost(), 0U);
  EXPECT_EQ(master.status().sent, devices.status().received);
  EXPECT_EQ(devices.status().sent, master.status().received);
  EXPECT_EQ(master.status().error_frames, 0U);
  std::printf(
      "%lld cycles, %llu frames from the master, %llu to it, the part ends %.2f mm off\n",
      static_cast<long long>(result.cycles), static_cast<unsigned long long>(master.status().sent),
      static_cast<unsigned long long>(master.status().received), 1e3 * result.truth.error_norm_m);
}

TEST(SocketcanPlan, BringUpAndAWholePlanRunOverAVirtualInterface) {
  const VirtualInterface vcan("vcan0");
  expect_whole_plan("vcan0", "vcan0");
}

TEST(Sja1000Plan, BringUpAndAWholePlanRunOverTwoControllers) {
  const Controllers controllers;
  expect_whole_plan("can0", "can1");
}

/// The executor ends with `kind`; the virtual drives stop by themselves.
void expect_end(BoxRun& run, ArmFaultKind kind) {
  for (int i = 0; i < 5000 && run.lockstep().cycle(); ++i) {
  }
  const auto result = run.lockstep().result();
  EXPECT_EQ(result.ending.reason, EndReason::kArmFault) << result.reason;
  EXPECT_EQ(result.ending.arm_fault.kind, kind) << result.reason;
  std::printf("%s\n", result.reason.c_str());

  run.lockstep().leave_alone(2.0);
  const sim::Truth truth = run.lockstep().cell().truth();
  EXPECT_TRUE(run.lockstep().cell().at_standstill());
  expect_brakes(truth);
}

bool told_of(const sim::Truth& truth, const std::string& what) {
  return std::any_of(truth.events.begin(), truth.events.end(),
                     [&](const auto& event) { return event.what.find(what) != std::string::npos; });
}

TEST(SocketcanPlan, TakenDownInMidPlanTheExecutorSaysSoAndTheDrivesBrakeByTheirHeartbeatWatch) {
  const VirtualInterface vcan("vcan0");
  SocketcanBus master("vcan0", kMbit_bps, kBurst_frames);
  SocketcanBus devices("vcan0", kMbit_bps, kBurst_frames);
  BoxRun box(master, devices);
  ASSERT_TRUE(box.into_motion()) << box.lockstep().result().reason;
  EXPECT_FALSE(told_of(box.lockstep().cell().truth(), "heartbeat"));
  run("ip link set vcan0 down");
  expect_end(box, ArmFaultKind::kBusDown);
  EXPECT_TRUE(told_of(box.lockstep().cell().truth(), "heartbeat"));
}

TEST(SocketcanPlan, BusOffInMidPlanIsNamed) {
  const VirtualInterface vcan("vcan0");
  SocketcanBus master("vcan0", kMbit_bps, kBurst_frames);
  SocketcanBus devices("vcan0", kMbit_bps, kBurst_frames);
  BoxRun box(master, devices);
  ASSERT_TRUE(box.into_motion()) << box.lockstep().result().reason;
  run("cansend vcan0 20000040#0000000000000000");
  expect_end(box, ArmFaultKind::kBusOff);
}

TEST(Sja1000Plan, TheMastersControllerTakenDownInMidPlanLeavesTheDrivesToTheirHeartbeatWatch) {
  const Controllers controllers;
  SocketcanBus master("can0", kMbit_bps, kBurst_frames);
  SocketcanBus devices("can1", kMbit_bps, kBurst_frames);
  BoxRun box(master, devices);
  ASSERT_TRUE(box.into_motion()) << box.lockstep().result().reason;
  run("ip link set can0 down");
  expect_end(box, ArmFaultKind::kBusDown);
  EXPECT_TRUE(told_of(box.lockstep().cell().truth(), "heartbeat"));
}

}  // namespace
}  // namespace tenon::socketcan

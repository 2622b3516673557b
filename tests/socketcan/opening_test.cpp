// What a SocketCAN interface must be before anything is sent on it, and the lines that say so.

#include <gtest/gtest.h>

#include <string>

#include "hw/can/open_bus.h"
#include "tests/socketcan/box_run.h"
#include "tests/socketcan/interfaces.h"
#include "tests/support/places.h"
#include "tests/support/refusal.h"

namespace tenon::socketcan {
namespace {

/// The line of the refusal, or "accepted".
std::string refusal(const std::string& interface, std::uint32_t burst_frames = 1) {
  return tests::refusal(
      [&] { (void)hw::open_bus("socketcan:" + interface, kMbit_bps, burst_frames); });
}

TEST(SocketcanOpening, AnInterfaceThatIsNotThereOrNoCanIsRefused) {
  EXPECT_EQ(refusal("none0"),
            "CAN bus socketcan:none0: no such interface; list them with 'ip link show type can'");
  EXPECT_EQ(refusal("lo"),
            "CAN bus socketcan:lo: is no CAN interface; list them with 'ip link show type can'");
}

TEST(SocketcanOpening, AVirtualInterfaceHasNoBitrateAndTakesAnyBurst) {
  const VirtualInterface vcan("vcan0");
  EXPECT_EQ(refusal("vcan0", 100'000), "accepted");
  run("ip link set vcan0 down");
  EXPECT_EQ(refusal("vcan0"),
            "CAN bus socketcan:vcan0: the interface is down; 'ip link set vcan0 up'");
}

TEST(Sja1000Opening, AControllerIsOpenedAtTheRobotsBitrateOnly) {
  {
    const Controllers controllers(kMbit_bps);
    EXPECT_EQ(refusal("can0"), "accepted");
  }
  EXPECT_EQ(refusal("can0"),
            "CAN bus socketcan:can0: the interface is down; "
            "'ip link set can0 up type can bitrate 1000000'");
  const Controllers controllers(500'000);
  EXPECT_EQ(refusal("can0"),
            "CAN bus socketcan:can0: runs at 500000 bit/s, wanted are 1000000 (robot file, or "
            "--bitrate); 'ip link set can0 "
            "down', then 'ip link set can0 up type can bitrate 1000000'");
}

TEST(Sja1000Opening, AControllerThatOnlyListensIsRefused) {
  const Controllers controllers(kMbit_bps);
  run("ip link set can0 down");
  run("ip link set can0 up type can bitrate 1000000 listen-only on");
  EXPECT_EQ(refusal("can0"),
            "CAN bus socketcan:can0: the controller only listens, nothing would be sent; 'ip link "
            "set can0 down', then 'ip link set can0 up type can listen-only off'");
}

TEST(Sja1000Opening, ATransmitQueueThatDoesNotHoldACycleIsRefused) {
  const Controllers controllers(kMbit_bps);
  run("ip link set can0 txqueuelen 5");
  EXPECT_EQ(refusal("can0", 5), "accepted");
  EXPECT_EQ(refusal("can0", 7),
            "CAN bus socketcan:can0: the transmit queue holds 5 frames, a cycle sends 7 at once; "
            "'ip link set can0 txqueuelen 100'");
}

/// What tenon-exec says when it is to run the gantry on can0; it is to say it with status 2.
std::string executors_refusal() {
  const tests::ScratchFolder scratch;
  tests::ChildProcess exec(
      scratch.path(),
      {tests::executable("tenon-exec"), "--cell", tests::in_tree("hw/cells/gantry3.yaml"), "--plan",
       tests::shared_plan("box_1_gantry3"), "--can", "socketcan:can0", "--black-box",
       scratch.path() / "black-box.csv"});
  EXPECT_EQ(exec.wait(), 2);
  return exec.err();
}

TEST(Sja1000Opening, TheExecutorRefusesAnotherBitrate) {
  const Controllers controllers(250'000);
  const std::string line = executors_refusal();
  EXPECT_NE(line.find("socketcan:can0: runs at 250000 bit/s, wanted are 1000000"),
            std::string::npos)
      << line;
}

TEST(Sja1000Opening, TheExecutorRefusesAQueueShorterThanItsCycle) {
  const Controllers controllers(kMbit_bps);
  run("ip link set can0 txqueuelen 4");
  // SYNC, three commands, and the heartbeat.
  const std::string line = executors_refusal();
  EXPECT_NE(line.find("holds 4 frames, a cycle sends 5 at once"), std::string::npos) << line;
}

}  // namespace
}  // namespace tenon::socketcan

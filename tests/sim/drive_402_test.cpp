// The drive's state machine on a plant that follows perfectly, or not at all.

#include "sim/cell/devices/drive_402.h"

#include <gtest/gtest.h>

#include <utility>

#include "tests/sim/literal_client.h"

namespace tenon::sim {
namespace {

using State = Drive402::State;
constexpr std::int64_t kMillisecond = 1'000'000;
constexpr std::int64_t kStep_ns = 500'000;

/// One drive whose brake is quick, SYNC every 2 ms, and a plant that is where the demand is unless
/// it is stuck.
class LiteralDrive {
 public:
  explicit LiteralDrive(std::int8_t mode = 8)
      : drive({.node = 1, .mode = mode, .brake_release_s = 0.0, .brake_engage_s = 0.0}) {
    drive.node().power_on(0);
    pass(10);
    write({0x2B, 0x07, 0x60, 0, 3, 0, 0, 0});           // 6007h = 3
    write({0x2B, 0x5A, 0x60, 0, 6, 0, 0, 0});           // 605Ah = 6
    write({0x23, 0x85, 0x60, 0, 0x40, 0x42, 0x0F, 0});  // 6085h = 1,000,000 counts/s^2
    write({0x2F, 0xC2, 0x60, 1, 2, 0, 0, 0});           // 60C2h: 2 ms
    write({0x2F, 0xC2, 0x60, 2, 0xFD, 0, 0, 0});
    write({0x2F, 0x60, 0x60, 0, mode, 0, 0, 0});
    drive.node().receive(frame_of(0x000, {0x01, 0x01}), now_ns);
  }

  /// Physics and timers for so long.
  void pass(int milliseconds) {
    const std::int64_t end_ns = now_ns + milliseconds * kMillisecond;
    while (now_ns < end_ns) {
      const Drive402::Demand demand = drive.demand(kStep_ns);
      now_ns += kStep_ns;
      brake = demand.brake;
      if (!demand.brake && !stuck) {
        plant = {demand.position_counts, demand.velocity_countsps, 0.0};
      } else {
        plant.velocity_countsps = 0.0;
      }
      drive.measured(plant, kStep_ns);
      drive.advance(now_ns);
    }
  }
  CanFrame ask(std::initializer_list<int> request) {
    static_cast<void>(collect());
    drive.node().receive(frame_of(0x601, request), now_ns);
    return collect();
  }
  void write(std::initializer_list<int> request) {
    const CanFrame answer = ask(request);
    ASSERT_EQ(answer.data[0], 0x60) << text_of(answer);
  }
  void control(int word) { write({0x2B, 0x40, 0x60, 0, word & 0xFF, word >> 8, 0, 0}); }
  void target(int counts) {
    write({0x23, 0x7A, 0x60, 0, counts & 0xFF, counts >> 8 & 0xFF, counts >> 16 & 0xFF,
           counts >> 24 & 0xFF});
  }
  void sync() { drive.node().receive(frame_of(0x080, {}), now_ns); }
  /// 6041h as read over the bus.
  int status() { return i16_at(ask({0x40, 0x41, 0x60, 0, 0, 0, 0, 0}), 4) & 0xFFFF; }
  /// The emergencies so far, each once.
  std::vector<std::string> said() {
    static_cast<void>(collect());
    return std::exchange(emergencies, {});
  }
  /// Takes what the drive sends, keeps its emergencies, and returns the last frame.
  CanFrame collect() {
    std::vector<CanFrame> frames;
    drive.node().take(frames);
    for (const CanFrame& frame : frames) {
      if (frame.id == 0x081) emergencies.push_back(text_of(frame));
    }
    return frames.empty() ? CanFrame{} : frames.back();
  }
  void enable() {
    control(0x06);
    control(0x07);
    control(0x0F);
    pass(1);
    ASSERT_EQ(drive.state(), State::kOperationEnabled);
  }
  /// A ramp of one target a SYNC.
  void run(int cycles, int counts_a_cycle) {
    for (int i = 0; i < cycles; ++i) {
      commanded += counts_a_cycle;
      target(commanded);
      sync();
      pass(2);
    }
  }

  Drive402 drive;
  std::vector<std::string> emergencies;
  Drive402::Measurement plant;
  bool stuck = false;
  bool brake = true;
  int commanded = 0;
  std::int64_t now_ns = 0;
};

TEST(Drive402Test, IsNotReadyUntilItsSelfTestIsOver) {
  Drive402 drive({.node = 1});
  drive.node().power_on(0);
  EXPECT_EQ(drive.state(), State::kNotReady);
  drive.advance(4 * kMillisecond);
  EXPECT_EQ(drive.state(), State::kNotReady);
  drive.advance(5 * kMillisecond);
  EXPECT_EQ(drive.state(), State::kSwitchOnDisabled);
}

TEST(Drive402Test, WalksToOperationEnabledAndBackWithTheStatuswordsOfTheStandard) {
  LiteralDrive bench;
  EXPECT_EQ(bench.status() & 0x4F, 0x40);
  bench.control(0x0F);  // no short cut from switch on disabled
  EXPECT_EQ(bench.status() & 0x4F, 0x40);
  bench.control(0x06);
  EXPECT_EQ(bench.status() & 0x6F, 0x21);
  bench.control(0x07);
  EXPECT_EQ(bench.status() & 0x6F, 0x23);
  EXPECT_TRUE(bench.drive.brake_engaged());
  bench.control(0x0F);
  bench.pass(1);
  EXPECT_EQ(bench.status() & 0x6F, 0x27);
  EXPECT_EQ(bench.status() & 0x1210, 0x1210);  // follows, remote, voltage
  EXPECT_FALSE(bench.drive.brake_engaged());
  bench.control(0x06);
  EXPECT_EQ(bench.status() & 0x6F, 0x21);
  EXPECT_TRUE(bench.drive.brake_engaged());
  bench.control(0x0F);
  bench.pass(1);
  EXPECT_EQ(bench.status() & 0x6F, 0x27);
  bench.control(0x00);
  EXPECT_EQ(bench.status() & 0x4F, 0x40);
  EXPECT_TRUE(bench.drive.brake_engaged());
}

TEST(Drive402Test, DisablingOperationStopsByARampAndThenBrakes) {
  LiteralDrive bench;
  bench.enable();
  bench.run(50, 200);  // 100,000 counts/s
  bench.control(0x07);
  EXPECT_EQ(bench.status() & 0x6F, 0x27);  // still ramping: 20 ms at 6084h = 5,000,000 counts/s^2
  EXPECT_FALSE(bench.drive.brake_engaged());
  bench.pass(30);
  EXPECT_EQ(bench.status() & 0x6F, 0x23);
  EXPECT_TRUE(bench.drive.brake_engaged());
}

// SYNC 1: target 1000 ──> demand  250  500  750 1000   each half millisecond
TEST(Drive402Test, TargetsAreInterpolatedAcrossTheSyncPeriod) {
  LiteralDrive bench;
  bench.enable();
  bench.target(1000);
  bench.pass(4);
  EXPECT_EQ(bench.plant.position_counts, 0.0);  // no SYNC yet
  bench.sync();
  for (const double expected : {250.0, 500.0, 750.0, 1000.0}) {
    const Drive402::Demand demand = bench.drive.demand(kStep_ns);
    EXPECT_DOUBLE_EQ(demand.position_counts, expected);
    EXPECT_DOUBLE_EQ(demand.velocity_countsps, 500'000.0);
  }
}

// SYNC ──2 ms── (lost) ──2 ms── stop
TEST(Drive402Test, ALostSyncIsBridgedForOnePeriodAtConstantVelocity) {
  LiteralDrive bench;
  bench.enable();
  bench.target(1000);
  bench.sync();
  bench.pass(4);
  EXPECT_DOUBLE_EQ(bench.plant.position_counts, 2000.0);
  bench.pass(10);
  EXPECT_DOUBLE_EQ(bench.plant.position_counts, 2000.0);
  EXPECT_EQ(bench.plant.velocity_countsps, 0.0);
}

TEST(Drive402Test, InterpolatedPositionModeNeedsItsControlBit) {
  LiteralDrive bench(7);
  bench.enable();
  bench.write({0x23, 0xC1, 0x60, 1, 0xE8, 0x03, 0, 0});
  bench.sync();
  bench.pass(2);
  EXPECT_EQ(bench.plant.position_counts, 0.0);
  bench.control(0x1F);
  bench.sync();
  bench.pass(2);
  EXPECT_DOUBLE_EQ(bench.plant.position_counts, 1000.0);
}

TEST(Drive402Test, AModeThatItLacksIsRefused) {
  LiteralDrive bench;
  EXPECT_EQ(text_of(bench.ask({0x2F, 0x60, 0x60, 0, 7, 0, 0, 0})), "581#8060600030000906");
  EXPECT_EQ(text_of(bench.ask({0x40, 0x02, 0x65, 0, 0, 0, 0, 0})), "581#4302650080000000");
}

// v = 100,000 counts/s, a = 1,000,000 counts/s^2: 100 ms and v^2 / 2a = 5,000 counts to stop.
TEST(Drive402Test, QuickStopRampsDownAndHoldsWithTheBrakeOff) {
  LiteralDrive bench;
  bench.enable();
  bench.run(50, 200);
  const double start_counts = bench.plant.position_counts;
  bench.control(0x02);
  EXPECT_EQ(bench.status() & 0x6F, 0x07);
  bench.pass(90);
  EXPECT_GT(bench.plant.velocity_countsps, 0.0);
  bench.pass(20);
  EXPECT_EQ(bench.plant.velocity_countsps, 0.0);
  EXPECT_NEAR(bench.plant.position_counts - start_counts, 5000.0, 50.0);
  bench.pass(100);
  EXPECT_EQ(bench.status() & 0x6F, 0x07);
  EXPECT_FALSE(bench.drive.brake_engaged());
  bench.control(0x0F);
  EXPECT_EQ(bench.status() & 0x6F, 0x27);
}

TEST(Drive402Test, QuickStopWithOptionTwoEndsSwitchedOff) {
  LiteralDrive bench;
  bench.write({0x2B, 0x5A, 0x60, 0, 2, 0, 0, 0});
  bench.enable();
  bench.run(50, 200);
  bench.control(0x02);
  bench.pass(110);
  EXPECT_EQ(bench.status() & 0x4F, 0x40);
  EXPECT_TRUE(bench.drive.brake_engaged());
}

TEST(Drive402Test, FollowingErrorFaultsAndOnlyARisingEdgeResets) {
  LiteralDrive bench;
  bench.write({0x23, 0x65, 0x60, 0, 0x88, 0x13, 0, 0});  // 5,000 counts
  bench.write({0x2B, 0x66, 0x60, 0, 10, 0, 0, 0});       // for 10 ms
  bench.enable();
  bench.control(0x8F);  // the reset bit is up already when the fault comes
  bench.stuck = true;
  bench.run(20, 300);  // 6,000 counts away at the end, outside for 6 ms
  EXPECT_EQ(bench.drive.state(), State::kOperationEnabled);
  bench.run(6, 0);
  EXPECT_EQ(bench.said(), std::vector<std::string>{"081#1186210000000000"});
  EXPECT_EQ(bench.status() & 0x4F, 0x08);
  EXPECT_EQ(bench.drive.error_code(), 0x8611);
  EXPECT_TRUE(bench.drive.brake_engaged());
  bench.control(0x8F);
  EXPECT_EQ(bench.status() & 0x4F, 0x08);
  bench.control(0x06);
  EXPECT_EQ(bench.status() & 0x4F, 0x08);
  bench.control(0x86);
  EXPECT_EQ(bench.status() & 0x4F, 0x40);
  EXPECT_EQ(bench.drive.error_code(), 0);
  bench.control(0x06);
  EXPECT_EQ(bench.status() & 0x6F, 0x21);
}

TEST(Drive402Test, AFollowingWindowOfZeroIsOff) {
  LiteralDrive bench;
  bench.enable();
  bench.stuck = true;
  bench.run(100, 300);
  EXPECT_EQ(bench.drive.state(), State::kOperationEnabled);
}

TEST(Drive402Test, WithOptionOneALostConnectionIsAFaultOnlyWhileEnabled) {
  LiteralDrive bench;
  bench.write({0x2B, 0x07, 0x60, 0, 1, 0, 0, 0});
  bench.control(0x06);
  bench.drive.node().receive(frame_of(0x000, {0x82, 0x01}), bench.now_ns);
  EXPECT_EQ(bench.said(), std::vector<std::string>{});
  EXPECT_EQ(bench.status() & 0x4F, 0x40);
  bench.enable();
  bench.drive.node().receive(frame_of(0x000, {0x02, 0x01}), bench.now_ns);
  bench.pass(10);
  EXPECT_EQ(bench.drive.state(), State::kFault);
  EXPECT_TRUE(bench.drive.brake_engaged());
}

TEST(Drive402Test, ALostMasterIsAQuickStopThatEndsWithTheBrakeOn) {
  LiteralDrive bench;
  bench.write({0x23, 0x16, 0x10, 1, 100, 0, 0x7F, 0});  // node 127, 100 ms
  bench.drive.node().receive(frame_of(0x77F, {0x05}), bench.now_ns);
  bench.enable();
  bench.run(50, 200);
  EXPECT_FALSE(bench.brake);
  bench.pass(10);  // 101 ms without a heartbeat are over
  EXPECT_EQ(bench.said(), std::vector<std::string>{"081#3081110000000000"});
  EXPECT_EQ(bench.status() & 0x6F, 0x07);
  bench.pass(150);
  EXPECT_EQ(bench.status() & 0x4F, 0x40);
  EXPECT_TRUE(bench.drive.brake_engaged());
}

}  // namespace
}  // namespace tenon::sim

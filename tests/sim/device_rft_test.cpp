// The virtual Robotous RFT sensor's frames, as literal bytes, and its clock.

#include <gtest/gtest.h>

#include <vector>

#include "sim/cell/devices/rft_sensor.h"
#include "sim/cell/faults/fault_spec.h"

namespace tenon::sim {
namespace {

constexpr std::int64_t kMs = 1'000'000;

class RftSensorTest : public testing::Test {
 protected:
  RftSensorTest() { sensor.power_on(0); }

  static ForceTorqueSensor description() {
    return {.protocol = SensorProtocol::kRobotousRft,
            .request_id = 0x64,
            .sample_ids = {0x01, 0x02},
            .rate_hz = 200,
            .force_per_count_N = 0.02,
            .torque_per_count_Nm = 0.0005,
            .force_range_N = 200.0,
            .torque_range_Nm = 4.0};
  }
  std::vector<CanFrame> taken() {
    std::vector<CanFrame> frames;
    sensor.take(frames);
    return frames;
  }
  /// Every half millisecond it measures `wrench`; what it sends until then.
  std::vector<CanFrame> passed(double until_ms) {
    while (now_ns < static_cast<std::int64_t>(until_ms * kMs)) {
      now_ns += kMs / 2;
      sensor.advance(now_ns);
      sensor.measured(wrench, kMs / 2);
      if (sensor.is_due(now_ns)) sensor.stream(now_ns);
    }
    return taken();
  }
  void command(std::uint8_t what, std::uint8_t parameter = 0) {
    sensor.receive({0x64, false, false, 8, {what, parameter}}, now_ns);
  }

  RftSensor sensor{description(), 0, {}};
  Vector6 wrench = Vector6::Zero();
  std::int64_t now_ns = 0;
};

TEST_F(RftSensorTest, StreamsTwoFramesASampleWhoseTxStraddlesThem) {
  wrench << -20.0, 1.0, 100.0, -0.15, 1.0, -0.0005;
  command(0x0B);
  EXPECT_EQ(passed(5),
            (std::vector<CanFrame>{
                {0x01, false, false, 8, {0x0B, 0xFC, 0x18, 0x00, 0x32, 0x13, 0x88, 0xFE}},
                {0x02, false, false, 8, {0xD4, 0x07, 0xD0, 0xFF, 0xFF, 0x00, 0x00, 0x00}}}));
}

TEST_F(RftSensorTest, IsSilentUntilItIsStartedAndOnceItIsStopped) {
  EXPECT_TRUE(passed(20).empty());
  command(0x0B);
  EXPECT_EQ(passed(1020).size(), 2U * 200);
  command(0x0C);
  EXPECT_TRUE(passed(1100).empty());
}

TEST_F(RftSensorTest, ConfirmsItsRateAndKeepsIt) {
  command(0x0F, 0x04);
  EXPECT_EQ(taken(), (std::vector<CanFrame>{{0x01, false, false, 8, {0x0F, 0x01}},
                                            {0x02, false, false, 8, {}}}));
  command(0x0B);
  EXPECT_EQ(passed(1000).size(), 2U * 100);
  command(0x0F, 0x09);
  EXPECT_EQ(taken()[0], (CanFrame{0x01, false, false, 8, {0x0F, 0x00, 0x03}}));
}

TEST_F(RftSensorTest, SaysWhichAxesAreOverloaded) {
  wrench << -201.0, 0.0, 0.0, 0.0, 0.0, 4.5;
  command(0x0B);
  const auto frames = passed(5);
  ASSERT_EQ(frames.size(), 2U);
  // -200 N and 4 Nm are the ends: D8F0h and 1F40h.
  EXPECT_EQ(frames[0].data[1], 0xD8);
  EXPECT_EQ(frames[0].data[2], 0xF0);
  EXPECT_EQ(frames[1].data[3], 0x1F);
  EXPECT_EQ(frames[1].data[4], 0x40);
  EXPECT_EQ(frames[1].data[5], 0b100001);
}

TEST_F(RftSensorTest, AnOverloadIsABitBesideAWrenchWithinItsRange) {
  sensor.inject(parse_fault("overrange-force:time_s=0"));
  command(0x0B);
  const auto frames = passed(5);
  ASSERT_EQ(frames.size(), 2U);
  EXPECT_EQ(frames[0], (CanFrame{0x01, false, false, 8, {0x0B}}));
  EXPECT_EQ(frames[1], (CanFrame{0x02, false, false, 8, {0, 0, 0, 0, 0, 0b000100}}));
}

TEST_F(RftSensorTest, ATornSampleLacksAFrameAndAStaleOneBoth) {
  command(0x0B);
  (void)passed(10);
  sensor.inject(parse_fault("torn-force:time_s=0,duration_s=0.02"));
  std::vector<std::uint32_t> ids;
  for (const CanFrame& frame : passed(30)) ids.push_back(frame.id);
  EXPECT_EQ(ids, (std::vector<std::uint32_t>{1, 2, 1, 2}));
  sensor.inject(parse_fault("stale-force:time_s=0"));
  EXPECT_TRUE(passed(60).empty());
}

TEST_F(RftSensorTest, OthersFramesAreNotForIt) {
  sensor.receive({0x64, true, false, 8, {0x0B}}, 0);
  sensor.receive({0x64, false, false, 2, {0x0B}}, 0);
  sensor.receive({0x63, false, false, 8, {0x0B}}, 0);
  EXPECT_TRUE(passed(20).empty());
}

}  // namespace
}  // namespace tenon::sim

// The virtual ATI NETCANOEM board's frames, as literal bytes. Base 17h.

#include <gtest/gtest.h>

#include <vector>

#include "sim/cell/devices/netcanoem_sensor.h"
#include "sim/cell/faults/fault_spec.h"

namespace tenon::sim {
namespace {

class NetcanoemSensorTest : public testing::Test {
 protected:
  NetcanoemSensorTest() { board.power_on(0); }

  static ForceTorqueSensor description() {
    return {.protocol = SensorProtocol::kAtiNetcanoem,
            .request_id = 0x170,
            .sample_ids = {0x170, 0x171},
            .force_per_count_N = 0.01,
            .torque_per_count_Nm = 0.001,
            .force_range_N = 256.0,
            .torque_range_Nm = 16.0};
  }
  std::vector<CanFrame> asked(const CanFrame& frame) {
    board.receive(frame, 0);
    std::vector<CanFrame> frames;
    board.take(frames);
    return frames;
  }
  std::vector<CanFrame> gauges() { return asked({0x170, false, false, 0, {}}); }

  NetcanoemSensor board{description(), 0, {}};
};

TEST_F(NetcanoemSensorTest, AnswersWithUnitsCountsAndRows) {
  EXPECT_EQ(asked({0x178, false, false, 0, {}}),
            (std::vector<CanFrame>{{0x178, false, false, 2, {0x02, 0x03}}}));
  // A million a newton and a newton metre: F4240h.
  EXPECT_EQ(asked({0x177, false, false, 0, {}}),
            (std::vector<CanFrame>{
                {0x177, false, false, 8, {0x00, 0x0F, 0x42, 0x40, 0x00, 0x0F, 0x42, 0x40}}}));
  // 256 N are 256e6 counts and 16000 of the first gauge: 16000.0, and of the others less:
  // 1280.0, 640.0, 0.0, -640.0, -1280.0.
  EXPECT_EQ(asked({0x172, false, false, 1, {0}}),
            (std::vector<CanFrame>{
                {0x172, false, false, 8, {0x46, 0x7A, 0x00, 0x00, 0x44, 0xA0, 0x00, 0x00}},
                {0x173, false, false, 8, {0x44, 0x20, 0x00, 0x00, 0x00, 0x00, 0x00, 0x00}},
                {0x174, false, false, 8, {0xC4, 0x20, 0x00, 0x00, 0xC4, 0xA0, 0x00, 0x00}}}));
  // 16 Nm and the last gauge: 80.0, 40.0, 0.0, -40.0, -80.0, 1000.0.
  EXPECT_EQ(asked({0x172, false, false, 1, {5}}),
            (std::vector<CanFrame>{
                {0x172, false, false, 8, {0x42, 0xA0, 0x00, 0x00, 0x42, 0x20, 0x00, 0x00}},
                {0x173, false, false, 8, {0x00, 0x00, 0x00, 0x00, 0xC2, 0x20, 0x00, 0x00}},
                {0x174, false, false, 8, {0xC2, 0xA0, 0x00, 0x00, 0x44, 0x7A, 0x00, 0x00}}}));
  EXPECT_TRUE(asked({0x172, false, false, 1, {6}}).empty());
}

TEST_F(NetcanoemSensorTest, GaugesComeInTwoFramesEvenOnesFirst) {
  // The wrench that makes the gauges 100, -200, 300, -400, 500, -600.
  Vector6 wanted;
  wanted << 100, -200, 300, -400, 500, -600;
  board.measured(1e-6 * (board.matrix() * wanted), 1'000'000);
  EXPECT_EQ(gauges(),
            (std::vector<CanFrame>{
                {0x170, false, false, 8, {0x00, 0x00, 0x00, 0x64, 0x01, 0x2C, 0x01, 0xF4}},
                {0x171, false, false, 6, {0xFF, 0x38, 0xFE, 0x70, 0xFD, 0xA8}}}));
}

TEST_F(NetcanoemSensorTest, ATornSampleLacksAFrameAndAStaleOneBoth) {
  board.inject(parse_fault("torn-force:time_s=0"));
  const auto first = gauges();
  const auto second = gauges();
  ASSERT_EQ(first.size(), 1U);
  ASSERT_EQ(second.size(), 1U);
  EXPECT_EQ(first[0].id, 0x170U);
  EXPECT_EQ(second[0].id, 0x171U);
  board.inject(parse_fault("stale-force:time_s=0"));
  EXPECT_TRUE(gauges().empty());
}

TEST_F(NetcanoemSensorTest, SaturatedGaugesAreAtTheirEnds) {
  board.inject(parse_fault("saturated-force:time_s=0"));
  EXPECT_EQ(gauges()[0],
            (CanFrame{0x170, false, false, 8, {0x00, 0x00, 0x7F, 0xFF, 0x7F, 0xFF, 0x7F, 0xFF}}));
}

TEST_F(NetcanoemSensorTest, AnOverloadIsAGaugeAtItsEndTheOthersAsTheyAre) {
  board.inject(parse_fault("overrange-force:time_s=0"));
  EXPECT_EQ(gauges(),
            (std::vector<CanFrame>{
                {0x170, false, false, 8, {0x00, 0x00, 0x00, 0x00, 0x00, 0x00, 0x00, 0x00}},
                {0x171, false, false, 6, {0x00, 0x00, 0x7F, 0xFF, 0x00, 0x00}}}));
}

TEST_F(NetcanoemSensorTest, OthersFramesAreNotForIt) {
  EXPECT_TRUE(asked({0x170, true, false, 0, {}}).empty());
  EXPECT_TRUE(asked({0x170, false, false, 1, {}}).empty());
  EXPECT_TRUE(asked({0x180, false, false, 0, {}}).empty());
  EXPECT_TRUE(asked({0x17C, false, false, 0, {}}).empty());
}

}  // namespace
}  // namespace tenon::sim

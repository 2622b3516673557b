// An ATI NETCANOEM board, the master's side: every frame as literal bytes, what becomes of lost
// ones, and its start, with what it may say wrongly. Base 17h.

#include <gtest/gtest.h>

#include <array>
#include <limits>
#include <string>
#include <vector>

#include "hw/arm/describe_fault.h"
#include "hw/sensors/ati_netcanoem_source.h"
#include "hw/sensors/ati_netcanoem_start.h"
#include "hw/sensors/wrench_intake.h"
#include "tests/hw/gantry_on_bus.h"

namespace tenon::hw {
namespace {

using Taken = WrenchSource::Taken;

constexpr std::int64_t kMs = 1'000'000;

ForceTorqueSensor ati_sensor() {
  return {.protocol = SensorProtocol::kAtiNetcanoem,
          .profile = "ati_netcanoem",
          .request_id = 0x170,
          .sample_ids = {0x170, 0x171},
          .force_per_count_N = 0.01,
          .torque_per_count_Nm = 0.001,
          .force_range_N = 290.0,
          .torque_range_Nm = 10.0,
          .cycles_per_sample = 2};
}

ForceTorqueSensor small_sensor() {
  ForceTorqueSensor sensor = ati_sensor();
  sensor.force_range_N = 1.0;
  sensor.torque_range_Nm = 0.1;
  return sensor;
}

Robot robot_with_ati() {
  Robot robot = gantry_robot();
  robot.sensor = ati_sensor();
  return robot;
}

const CanFrame kRequest{0x170, false, false, 0, {}};
// Status good, gauges 0, 2, 4: 1, -2, 3.
const CanFrame kFirst{0x170, false, false, 8, {0x00, 0x00, 0x00, 0x01, 0xFF, 0xFE, 0x00, 0x03}};
// Gauges 1, 3, 5: 1000, -1000, 256.
const CanFrame kSecond{0x171, false, false, 6, {0x03, 0xE8, 0xFC, 0x18, 0x01, 0x00}};

class AtiNetcanoem : public testing::Test {
 protected:
  Taken take(const CanFrame& frame) { return intake.take(frame, 0); }

  AtiNetcanoemSource source{ati_sensor()};
  WrenchIntake intake{source, ati_sensor()};
};

TEST_F(AtiNetcanoem, AWrenchIsTheMatrixTimesAllSixGauges) {
  AtiNetcanoemSource::Matrix matrix = AtiNetcanoemSource::Matrix::Zero();
  matrix(0, 0) = 1.0;    // fx: gauge 0
  matrix(1, 1) = 0.01;   // fy: gauge 1
  matrix(2, 2) = 10.0;   // fz: gauge 2
  matrix(3, 3) = 0.001;  // tx: gauge 3
  matrix(4, 4) = 1.0;    // ty: gauge 4
  matrix(5, 5) = 0.01;   // tz: gauge 5, and gauge 0
  matrix(5, 0) = -1.0;
  source.calibrate(matrix);
  EXPECT_EQ(take(kFirst), Taken::kHalf);
  EXPECT_FALSE(intake.force_N());
  EXPECT_EQ(take(kSecond), Taken::kHalf);
  ASSERT_TRUE(intake.sample());
  Vector6 wrench;
  wrench << 1.0, 10.0, -20.0, -1.0, 3.0, 1.56;
  EXPECT_TRUE(intake.sample()->wrench.isApprox(wrench)) << intake.sample()->wrench.transpose();
  EXPECT_FALSE(intake.unwell());
  EXPECT_FALSE(intake.saturated());
}

TEST_F(AtiNetcanoem, IsAskedInEveryCycleInWhichASampleIsDue) {
  for (int sample = 0; sample < 3; ++sample) {
    EXPECT_EQ(intake.begin_cycle(), kRequest);
    EXPECT_FALSE(intake.answered());
    (void)take(kFirst);
    EXPECT_FALSE(intake.answered());
    (void)take(kSecond);
    EXPECT_TRUE(intake.answered());
    EXPECT_EQ(intake.begin_cycle(), std::nullopt);
    EXPECT_TRUE(intake.answered());
  }
  intake.reset();
  EXPECT_EQ(intake.begin_cycle(), kRequest);
}

TEST_F(AtiNetcanoem, NoHalfIsJoinedWithAnotherSamples) {
  (void)intake.begin_cycle();
  (void)take(kFirst);  // its second half is lost, and the first of the next
  (void)intake.begin_cycle();
  (void)intake.begin_cycle();
  (void)take(kSecond);
  EXPECT_FALSE(intake.sample());
  EXPECT_EQ(intake.torn(), 1U);
  (void)intake.begin_cycle();
  (void)intake.begin_cycle();
  (void)take(kFirst);
  (void)take(kSecond);
  EXPECT_TRUE(intake.sample());
  // An answer that comes after the next request is whole or nothing.
  (void)take(kFirst);
  (void)intake.begin_cycle();
  (void)intake.begin_cycle();
  (void)take(kSecond);
  EXPECT_FALSE(intake.sample());
  (void)take(kFirst);
  (void)take(kSecond);
  EXPECT_TRUE(intake.sample());
}

TEST_F(AtiNetcanoem, AStatusThatIsNotGoodIsToldWithItsBits) {
  CanFrame bad = kFirst;
  bad.data[0] = 0x80;
  bad.data[1] = 0x20;
  (void)take(bad);
  ASSERT_TRUE(intake.unwell());
  EXPECT_EQ(*intake.unwell(), 0x8020U);
  EXPECT_EQ(
      describe({ArmFaultKind::kSensorInvalid, 0, 0x200200, 0x8020}, robot_with_ati()),
      "force/torque sensor ati_netcanoem: reports status 0x8020 (supply too low, some error); "
      "check its supply and cable, and switch it off and on");
}

TEST_F(AtiNetcanoem, AGaugeAtItsEndIsNoForce) {
  CanFrame end = kFirst;
  end.data[2] = 0x7F;
  end.data[3] = 0xFF;
  (void)take(end);
  (void)take(kSecond);
  ASSERT_TRUE(intake.saturated());
  EXPECT_EQ(intake.saturated()->raw, 32767);
}

TEST_F(AtiNetcanoem, WhatHasAnotherLengthOrIdentifierIsNoHalf) {
  EXPECT_EQ(take(kRequest), Taken::kForeign);  // another master's
  CanFrame other = kSecond;
  other.length = 8;
  EXPECT_EQ(take(other), Taken::kMalformed);
  other = kFirst;
  other.id = 0x172;
  EXPECT_EQ(take(other), Taken::kForeign);
  other = kFirst;
  other.extended = true;
  EXPECT_EQ(take(other), Taken::kForeign);
}

// --- its start ---

/// The start on a bus whose other end the test is.
class AtiNetcanoemStarts : public testing::Test {
 protected:
  explicit AtiNetcanoemStarts(const ForceTorqueSensor& sensor = ati_sensor())
      : start(sensor, source) {}

  /// What the board is sent until then.
  std::vector<CanFrame> sent(int until_ms) {
    std::vector<CanFrame> frames;
    for (; now_ms < until_ms; ++now_ms) {
      start.update(now_ms * kMs, master);
      ReceivedFrame received;
      while (board.receive(received)) frames.push_back(received.frame);
    }
    return frames;
  }
  /// For the next millisecond.
  CanFrame next() {
    const auto frames = sent(now_ms + 1);
    return frames.size() == 1 ? frames[0] : CanFrame{};
  }
  void hear(std::uint32_t id, const std::vector<std::uint8_t>& bytes) {
    CanFrame frame{id, false, false, static_cast<std::uint8_t>(bytes.size()), {}};
    std::copy(bytes.begin(), bytes.end(), frame.data.begin());
    start.process(frame);
  }
  /// 1, 2 | 3, 4 | 5, 6 as floats.
  void hear_row() {
    hear(0x172, {0x3F, 0x80, 0x00, 0x00, 0x40, 0x00, 0x00, 0x00});
    hear(0x173, {0x40, 0x40, 0x00, 0x00, 0x40, 0x80, 0x00, 0x00});
    hear(0x174, {0x40, 0xA0, 0x00, 0x00, 0x40, 0xC0, 0x00, 0x00});
  }
  void rows() {
    for (std::uint8_t row = 0; row < 6; ++row) {
      EXPECT_EQ(next(), (CanFrame{0x172, false, false, 1, {row}}));
      hear_row();
    }
  }
  void counts(const std::vector<std::uint8_t>& bytes = {0, 0, 0, 100, 0, 0, 0x03, 0xE8}) {
    EXPECT_EQ(next(), (CanFrame{0x177, false, false, 0, {}}));
    hear(0x177, bytes);
  }
  void units(std::uint8_t force = 2, std::uint8_t torque = 3) {
    EXPECT_EQ(next(), (CanFrame{0x178, false, false, 0, {}}));
    hear(0x178, {force, torque});
  }
  /// Of six gauges that are all 1.
  Vector6 wrench_of_ones() { return source.wrench({1, 1, 1, 1, 1, 1}); }
  std::string said() { return describe(start.fault(), robot_with_ati()); }

  sim::VirtualBus bus{{.bitrate_bps = 0}};
  CanBus& master = bus.attach();
  CanBus& board = bus.attach();
  AtiNetcanoemSource source{ati_sensor()};
  AtiNetcanoemStart start;
  int now_ms = 0;
};

TEST_F(AtiNetcanoemStarts, ReadsMatrixCountsUnitsAndAFirstSample) {
  rows();
  counts();
  units();
  EXPECT_EQ(next(), kRequest);
  start.process(kSecond);
  start.process(kFirst);
  EXPECT_EQ(start.state(), SensorStart::State::kAsking);
  start.process(kSecond);
  ASSERT_EQ(start.state(), SensorStart::State::kDone);
  // 1 + 2 + .. + 6 = 21 counts, 100 a newton, 1000 a newton metre.
  Vector6 wrench;
  wrench << 0.21, 0.21, 0.21, 0.021, 0.021, 0.021;
  EXPECT_TRUE(wrench_of_ones().isApprox(wrench)) << wrench_of_ones().transpose();
  EXPECT_TRUE(sent(1000).empty());
}

TEST_F(AtiNetcanoemStarts, ACalibrationThatDoesNotComeToTheRangeIsRefusedByItsAxis) {
  rows();
  // 21 counts a gauge, 32767 gauges, 100'000 counts a newton: 6.9 N, where 290 are said.
  counts({0, 0x01, 0x86, 0xA0, 0, 0, 0x03, 0xE8});
  units();
  EXPECT_EQ(start.fault().kind, ArmFaultKind::kConfiguration);
  EXPECT_EQ(said(),
            "force/torque sensor ati_netcanoem: by its calibration and units fx reads no more than "
            "7 N with all gauges at their ends, its range is said to be 290: this is another "
            "sensor, calibration or unit, or correct force_range_N");
  start.restart();
  rows();
  counts();
  units(2, 4);  // N mm
  EXPECT_NE(said().find("tx reads no more than 1 Nm"), std::string::npos) << said();
}

/// Of a sensor whose range is within reach in any unit.
class AtiNetcanoemUnits : public AtiNetcanoemStarts {
 protected:
  AtiNetcanoemUnits() : AtiNetcanoemStarts(small_sensor()) {}
};

TEST_F(AtiNetcanoemUnits, BecomeNewtonsAndNewtonMetres) {
  // Of one unit in the maker's list, by definition: lbf, N, klbf, kN, kgf, gf.
  const std::array forces_N = {4.4482216, 1.0, 4448.2216, 1000.0, 9.80665, 9.80665e-3};
  // lbf in, lbf ft, N m, N mm, kgf cm, kN m.
  const std::array torques_Nm = {0.11298483, 1.3558179, 1.0, 1e-3, 0.0980665, 1000.0};
  for (std::uint8_t code = 1; code <= 6; ++code) {
    start.restart();
    rows();
    counts();
    units(code, code);
    const Vector6 wrench = wrench_of_ones();
    EXPECT_NEAR(wrench[0] / (0.21 * forces_N[code - 1U]), 1.0, 1e-7);
    EXPECT_NEAR(wrench[5] / (0.021 * torques_Nm[code - 1U]), 1.0, 1e-7);
  }
}

TEST_F(AtiNetcanoemStarts, SilenceIsNamedWithinASecond) {
  const CanFrame row{0x172, false, false, 1, {0}};
  EXPECT_EQ(sent(1000), (std::vector<CanFrame>{row, row, row}));
  EXPECT_EQ(start.fault().kind, ArmFaultKind::kNoAnswer);
  EXPECT_EQ(said(),
            "force/torque sensor ati_netcanoem: no answer to read matrix row 0 (operation 2) on "
            "0x172 in three tries; check power, wiring, bit rate, and that its base identifier is "
            "0x17");
}

TEST_F(AtiNetcanoemStarts, ASlowAnswerIsAskedForAgainAndHalfARowIsNoRow) {
  const CanFrame row{0x172, false, false, 1, {0}};
  EXPECT_EQ(next(), row);
  hear(0x172, {0x7F, 0xC0, 0, 0, 0, 0, 0, 0});  // of the first try, and never used
  EXPECT_EQ(sent(110), std::vector<CanFrame>{row});
  hear(0x174, {0x40, 0xA0, 0, 0, 0x40, 0xC0, 0, 0});
  hear(0x173, {0x40, 0x40, 0, 0, 0x40, 0x80, 0, 0});
  EXPECT_EQ(sent(120), std::vector<CanFrame>{});
  hear(0x172, {0x3F, 0x80, 0, 0, 0x40, 0x00, 0, 0});
  EXPECT_EQ(next(), (CanFrame{0x172, false, false, 1, {1}}));
}

TEST_F(AtiNetcanoemStarts, GarbageIsNoAnswer) {
  (void)next();
  hear(0x172, {0x3F, 0x80});
  hear(0x175, {0, 0, 0, 0, 0, 0, 0, 0});
  hear(0x182, {0, 0, 0, 0, 0, 0, 0, 0});
  hear(0x170, {});
  (void)sent(1000);
  EXPECT_EQ(start.fault().kind, ArmFaultKind::kNoAnswer);
}

TEST_F(AtiNetcanoemStarts, AMatrixThatIsNoneIsRefusedByItsRow) {
  for (int i = 0; i < 2; ++i) {
    (void)next();
    hear_row();
  }
  (void)next();
  for (std::uint32_t id = 0x172; id < 0x175; ++id) hear(id, {0, 0, 0, 0, 0, 0, 0, 0});
  EXPECT_EQ(start.fault().kind, ArmFaultKind::kConfiguration);
  EXPECT_EQ(said(),
            "force/torque sensor ati_netcanoem: row 2 (fz) of its calibration matrix is zero or no "
            "numbers; it is not calibrated, or another calibration must be chosen in it");
  start.restart();
  (void)next();
  hear(0x172, {0x3F, 0x80, 0, 0, 0x7F, 0xC0, 0, 0});
  hear(0x173, {0x3F, 0x80, 0, 0, 0x3F, 0x80, 0, 0});
  hear(0x174, {0x3F, 0x80, 0, 0, 0x3F, 0x80, 0, 0});
  EXPECT_NE(said().find("row 0 (fx) of its calibration matrix"), std::string::npos);
}

TEST_F(AtiNetcanoemStarts, CountsOfZeroAreRefused) {
  rows();
  counts({0, 0, 0, 100, 0, 0, 0, 0});
  EXPECT_EQ(start.fault().kind, ArmFaultKind::kConfiguration);
  EXPECT_EQ(said(),
            "force/torque sensor ati_netcanoem: its counts a unit of torque are 0; it is not "
            "calibrated, or another calibration must be chosen in it");
}

TEST_F(AtiNetcanoemStarts, UnitsThatNobodyKnowsAreRefused) {
  for (const auto& [force, torque, what] : {std::tuple{0, 3, "force has the code 0"},
                                            {7, 3, "force has the code 7"},
                                            {2, 255, "torque has the code 255"}}) {
    start.restart();
    rows();
    counts();
    units(static_cast<std::uint8_t>(force), static_cast<std::uint8_t>(torque));
    EXPECT_EQ(start.fault().kind, ArmFaultKind::kConfiguration);
    EXPECT_NE(said().find(std::string("its unit of ") + what + ", must be 1 to 6"),
              std::string::npos)
        << said();
  }
}

TEST_F(AtiNetcanoemStarts, ABadStatusIsRefusedBeforeAnythingMoves) {
  rows();
  counts();
  units();
  (void)next();
  CanFrame bad = kFirst;
  bad.data[1] = 0x40;
  start.process(bad);
  EXPECT_EQ(start.fault().kind, ArmFaultKind::kConfiguration);
  EXPECT_NE(said().find("reports status 0x0040 (bad calibration)"), std::string::npos) << said();
}

}  // namespace
}  // namespace tenon::hw

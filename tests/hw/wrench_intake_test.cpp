// What is judged of a wrench, whichever sensor sends it, and the bytes of the CANopen node.

#include "hw/sensors/wrench_intake.h"

#include <gtest/gtest.h>

#include "hw/arm/describe_fault.h"
#include "hw/arm/saturation_fault.h"
#include "hw/sensors/canopen_wrench_source.h"
#include "hw/sensors/wrench_staleness.h"

namespace tenon::hw {
namespace {

using Taken = WrenchSource::Taken;

ForceTorqueSensor intake_test_sensor() {
  ForceTorqueSensor sensor;
  sensor.node = 4;
  sensor.force_per_count_N = 0.01;
  sensor.torque_per_count_Nm = 0.0005;
  sensor.force_range_N = 300.0;
  sensor.torque_range_Nm = 15.0;
  return sensor;
}

CanFrame canopen_force_frame() {
  // 1.00, -0.02, 2.56 N; counter 0201h
  return {0x181, false, false, 8, {0x64, 0x00, 0xFE, 0xFF, 0x00, 0x01, 0x01, 0x02}};
}
CanFrame canopen_torque_frame() {
  // 0.05, -0.0005, 0 Nm; counter 0201h
  return {0x182, false, false, 8, {0x64, 0x00, 0xFF, 0xFF, 0x00, 0x00, 0x01, 0x02}};
}

class WrenchIntakeOfCanopenNode : public testing::Test {
 protected:
  CanopenWrenchSource source{intake_test_sensor(), {0x181, 0x182}};
  WrenchIntake intake{source, intake_test_sensor()};
};

TEST_F(WrenchIntakeOfCanopenNode, TwoFramesAreAWrenchInNewtonsAndTheForceIsKnownWithTheFirst) {
  (void)intake.begin_cycle();
  EXPECT_EQ(intake.take(canopen_force_frame(), 0), Taken::kHalf);
  ASSERT_TRUE(intake.force_N());
  EXPECT_TRUE(intake.force_N()->isApprox(Vector3(1.0, -0.02, 2.56)));
  EXPECT_FALSE(intake.sample());
  EXPECT_FALSE(intake.answered());
  EXPECT_EQ(intake.take(canopen_torque_frame(), 0), Taken::kHalf);
  EXPECT_FALSE(intake.force_N());
  ASSERT_TRUE(intake.sample());
  Vector6 expected;
  expected << 1.0, -0.02, 2.56, 0.05, -0.0005, 0.0;
  EXPECT_TRUE(intake.sample()->wrench.isApprox(expected));
  EXPECT_EQ(intake.sample()->counter, 0x0201);
  EXPECT_FALSE(intake.saturated());
  EXPECT_TRUE(intake.answered());
}

TEST_F(WrenchIntakeOfCanopenNode, ARepeatedSampleIsNone) {
  for (const bool fresh : {true, false}) {
    (void)intake.take(canopen_force_frame(), 0);
    (void)intake.take(canopen_torque_frame(), 0);
    EXPECT_EQ(intake.sample().has_value(), fresh);
  }
  EXPECT_EQ(intake.torn(), 0U);
}

TEST_F(WrenchIntakeOfCanopenNode, HalvesOfTwoSamplesAreTornAndNoWrench) {
  CanFrame torque = canopen_torque_frame();
  torque.data[6] = 0x02;
  (void)intake.take(canopen_force_frame(), 0);
  (void)intake.take(torque, 0);
  EXPECT_FALSE(intake.sample());
  EXPECT_TRUE(intake.answered());
  EXPECT_EQ(intake.torn(), 1U);
  intake.reset();
  (void)intake.begin_cycle();
  EXPECT_FALSE(intake.answered());
  EXPECT_EQ(intake.torn(), 0U);
}

//  cycle   1   2   3   4   5   6   7
//  sample          x           -   x      m = 3; the one of cycle 6 comes late
TEST(WrenchIntakeOfASlowSensor, IsWaitedForInTheCyclesInWhichASampleIsDue) {
  ForceTorqueSensor sensor = intake_test_sensor();
  sensor.cycles_per_sample = 3;
  CanopenWrenchSource source(sensor, {0x181, 0x182});
  WrenchIntake intake(source, sensor);
  CanFrame force = canopen_force_frame();
  CanFrame torque = canopen_torque_frame();
  const bool due[] = {false, false, true, false, false, true, true};
  for (int cycle = 1; cycle <= 7; ++cycle) {
    (void)intake.begin_cycle();
    EXPECT_EQ(intake.answered(), !due[cycle - 1]) << "cycle " << cycle;
    if (cycle != 3 && cycle != 7) continue;
    (void)intake.take(force, 0);
    EXPECT_FALSE(intake.answered()) << "half a wrench";
    (void)intake.take(torque, 0);
    EXPECT_TRUE(intake.sample());
    EXPECT_TRUE(intake.answered());
    ++force.data[6];
    ++torque.data[6];
  }
}

ArmFeedback fresh(std::uint16_t counter) {
  ArmFeedback feedback;
  feedback.wrench_fresh = true;
  feedback.wrench_counter = counter;
  return feedback;
}

/// A sensor that numbers a sample every `per_sample` cycles, beginning shortly before its counter
/// wraps, and whose answers come `late` cycles after they were asked for.
struct NumberedSensor {
  explicit NumberedSensor(int per_sample = 1)
      : per_sample(per_sample), wrench(sensor(per_sample)) {}

  static ForceTorqueSensor sensor(int per_sample) {
    ForceTorqueSensor sensor;
    sensor.cycles_per_sample = per_sample;
    return sensor;
  }
  /// @return cycles until it is stale, at most so many
  int cycles(int most, int late) {
    for (int k = 0; k < most; ++k) {
      ++cycle;
      const int asked = cycle - late;
      const auto counter = static_cast<std::uint16_t>(65'400 + asked / per_sample);
      const bool answers = asked % per_sample == 0 && asked > newest;
      if (answers) newest = asked;
      wrench.update(answers ? fresh(counter) : ArmFeedback{}, true);
      if (wrench.stale()) return k + 1;
    }
    return most;
  }

  int per_sample;
  WrenchStaleness wrench;
  int cycle = 0;
  int newest = 0;
};

//  cycle    1  2  3  4  5  6  7  8        late by 3: they miss nothing after the first three
//  sample   1  2  3  -  -  -  4  5
TEST(WrenchStaleness, SamplesThatComeLateByWholeCyclesAreNotThisCycles) {
  for (const int per_sample : {1, 3}) {
    NumberedSensor sensor(per_sample);
    EXPECT_EQ(sensor.cycles(10'000, 0), 10'000) << "its counter wraps meanwhile";
    EXPECT_EQ(sensor.cycles(10'000, per_sample), 10'000) << "one is borne";
    EXPECT_LE(sensor.cycles(100, 3 * per_sample), 6 * per_sample + 1) << per_sample;
    EXPECT_GE(sensor.wrench.samples_behind(), 2U);
    EXPECT_LE(sensor.wrench.samples_behind(), 3U);
  }
}

TEST(WrenchStaleness, OfASensorThatCountsOtherwiseNothingIsKnown) {
  for (const double per_cycle : {0.45, 0.9, 0.996, 1.004, 2.0}) {
    WrenchStaleness wrench{ForceTorqueSensor{}};
    std::uint16_t last = 0;
    for (int cycle = 1; cycle < 20'000; ++cycle) {
      const auto counter = static_cast<std::uint16_t>(static_cast<int>(per_cycle * cycle));
      wrench.update(counter == last ? ArmFeedback{} : fresh(counter), true);
      last = counter;
      ASSERT_FALSE(wrench.stale()) << per_cycle << " in cycle " << cycle;
    }
  }
  ForceTorqueSensor streams;
  streams.protocol = SensorProtocol::kRobotousRft;
  WrenchStaleness wrench{streams};
  for (std::uint16_t cycle = 0; cycle < 2000; ++cycle) {
    wrench.update(fresh(static_cast<std::uint16_t>(cycle < 1000 ? cycle : cycle / 2)), true);
    ASSERT_FALSE(wrench.stale());
  }
}

TEST(WrenchStaleness, ASyncInAHundredMayBeMissedAndOneThatNobodyHeardIsNone) {
  WrenchStaleness wrench{ForceTorqueSensor{}};
  std::uint16_t counter = 0;
  for (int cycle = 1; cycle < 20'000; ++cycle) {
    const bool missed = cycle > 1000 && cycle % 120 == 0;
    const bool lost = cycle > 1000 && cycle % 7 == 0;
    wrench.update(missed || lost ? ArmFeedback{} : fresh(++counter), !lost);
    ASSERT_FALSE(wrench.stale()) << cycle;
  }
  wrench.update(fresh(0), true);
  for (std::uint16_t after = 1; after < 1000; ++after) {
    wrench.update(fresh(after), true);
    ASSERT_FALSE(wrench.stale()) << "its counter began anew";
  }
}

TEST(WrenchStaleness, ASensorOwesAsManySamplesHoweverLongTheyTake) {
  for (const int cycles_per_sample : {1, 3}) {
    ForceTorqueSensor sensor;
    sensor.cycles_per_sample = cycles_per_sample;
    WrenchStaleness wrench(sensor);
    int missing = 0;
    int cycles = 0;
    for (; !wrench.stale(); ++cycles) {
      EXPECT_LE(wrench.cycles(), WrenchStaleness::cycles_max(sensor));
      wrench.update({}, true);
      missing += wrench.missing() ? 1 : 0;
    }
    EXPECT_EQ(cycles, 5 * cycles_per_sample + 1);
    EXPECT_EQ(missing, cycles_per_sample == 1 ? 6 : 5);
    wrench.update(fresh(1), true);
    EXPECT_FALSE(wrench.stale());
    EXPECT_FALSE(wrench.missing());
  }
}

TEST_F(WrenchIntakeOfCanopenNode, TheFirstAxisAtTheEndOfItsRangeIsNamed) {
  CanFrame torque = canopen_torque_frame();
  torque.data[2] = 0x30;  // ty: 30000 counts, 15 Nm
  torque.data[3] = 0x75;
  torque.data[4] = 0x00;  // tz: -32768 counts
  torque.data[5] = 0x80;
  (void)intake.take(canopen_force_frame(), 0);
  (void)intake.take(torque, 0);
  ASSERT_TRUE(intake.saturated());
  EXPECT_EQ(intake.saturated()->place, 4);
  EXPECT_EQ(intake.saturated()->raw, 30000);
}

// Its other half may come late, or never: a force that is at its end is judged as its frame comes.
TEST_F(WrenchIntakeOfCanopenNode, AForceAtTheEndOfItsRangeIsNamedByItsHalfAlone) {
  CanFrame force = canopen_force_frame();
  force.data[2] = 0xD0;  // fy: -30000 counts, -300 N
  force.data[3] = 0x8A;
  (void)intake.take(force, 0);
  EXPECT_FALSE(intake.sample());
  ASSERT_TRUE(intake.saturated());
  EXPECT_EQ(intake.saturated()->place, 1);
  EXPECT_EQ(intake.saturated()->reading, -300.0);
  (void)intake.take(canopen_force_frame(), 0);
  EXPECT_FALSE(intake.saturated());
}

TEST_F(WrenchIntakeOfCanopenNode, FramesOfOthersAndOfAnotherLengthBringNothing) {
  CanFrame frame = canopen_force_frame();
  frame.id = 0x183;
  EXPECT_EQ(intake.take(frame, 0), Taken::kForeign);
  frame.id = 0x181;
  frame.extended = true;
  EXPECT_EQ(intake.take(frame, 0), Taken::kForeign);
  frame.extended = false;
  frame.remote = true;
  EXPECT_EQ(intake.take(frame, 0), Taken::kForeign);
  frame.remote = false;
  frame.length = 7;
  EXPECT_EQ(intake.take(frame, 0), Taken::kMalformed);
  EXPECT_FALSE(intake.force_N());
  EXPECT_FALSE(intake.sample());
}

/// Big-endian values in one identifier, first half or second by its last byte; no force by itself.
class HandMadeWrenchSource final : public WrenchSource {
 public:
  [[nodiscard]] Taken take(const CanFrame& frame, std::int64_t /*time_ns*/,
                           WrenchHalf& half) noexcept override {
    if (frame.id != 0x50) return Taken::kForeign;
    half.place = frame.data[7];
    half.counter = frame.data[6];
    for (std::size_t i = 0; i < 3; ++i) {
      half.raw[i] = static_cast<std::int16_t>(frame.data[2 * i] << 8 | frame.data[2 * i + 1]);
    }
    return Taken::kHalf;
  }
  [[nodiscard]] std::optional<Vector3> force_N(const WrenchHalf& /*half*/) const noexcept override {
    return std::nullopt;
  }
  /// Axes in the opposite order.
  [[nodiscard]] Vector6 wrench(const std::array<std::int16_t, 6>& raw) const noexcept override {
    Vector6 wrench;
    for (std::size_t i = 0; i < 6; ++i) wrench[static_cast<Eigen::Index>(5 - i)] = raw[i];
    return wrench;
  }
};

TEST(WrenchIntake, TheRangeOfASensorOfAnotherLayoutIsThatOfItsWrenchAndNotOfItsRawValues) {
  HandMadeWrenchSource source;
  WrenchIntake intake(source, intake_test_sensor());
  EXPECT_EQ(intake.take({0x50, false, false, 8, {0x00, 0x01, 0x00, 0x02, 0x00, 0x03, 9, 0}}, 0),
            Taken::kHalf);
  EXPECT_FALSE(intake.force_N());
  EXPECT_EQ(intake.take({0x50, false, false, 8, {0x00, 0x04, 0x00, 0x05, 0x01, 0x2C, 9, 1}}, 0),
            Taken::kHalf);
  ASSERT_TRUE(intake.sample());
  EXPECT_DOUBLE_EQ(intake.sample()->wrench[0], 300.0);  // raw value 5 is 012Ch
  EXPECT_DOUBLE_EQ(intake.sample()->wrench[5], 1.0);
  ASSERT_TRUE(intake.saturated());
  EXPECT_EQ(intake.saturated()->place, 0);
}

// What is said of a wrench beyond its range is the wrench, whatever the raw values were made into.
TEST(WrenchIntake, AFaultTellsTheReadingOfTheWrenchAndNotARawValueScaled) {
  Robot robot;
  robot.sensor = intake_test_sensor();
  HandMadeWrenchSource source;
  WrenchIntake intake(source, robot.sensor);
  (void)intake.take({0x50, false, false, 8, {0x00, 0x01, 0x00, 0x02, 0x00, 0x03, 9, 0}}, 0);
  (void)intake.take({0x50, false, false, 8, {0x00, 0x04, 0x00, 0x05, 0xFE, 0xD4, 9, 1}}, 0);
  ASSERT_TRUE(intake.saturated());
  EXPECT_EQ(describe(saturation_fault(4, *intake.saturated()), robot),
            "node 4 (force/torque sensor): fx = -300.00 N is at or beyond the range of 300.00; the "
            "load is too high or the sensor is damaged");
}

// Gauges that are at their end make a wrench that is anything.
TEST(WrenchIntake, ARawValueAtItsEndIsToldAsThatAndAsNoAxis) {
  Robot robot;
  robot.sensor = intake_test_sensor();
  robot.sensor.force_range_N = 0.0;  // not given
  robot.sensor.torque_range_Nm = 0.0;
  HandMadeWrenchSource source;
  WrenchIntake intake(source, robot.sensor);
  (void)intake.take({0x50, false, false, 8, {0x00, 0x01, 0x00, 0x02, 0x00, 0x03, 9, 0}}, 0);
  (void)intake.take({0x50, false, false, 8, {0x00, 0x04, 0x80, 0x00, 0x00, 0x06, 9, 1}}, 0);
  ASSERT_TRUE(intake.saturated());
  EXPECT_EQ(describe(saturation_fault(4, *intake.saturated()), robot),
            "node 4 (force/torque sensor): its raw value 5 of 6 is -32768, the end of its 16 bits; "
            "the load is too high or the sensor is damaged");
}

}  // namespace
}  // namespace tenon::hw

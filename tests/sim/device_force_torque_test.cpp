// The force/torque node's measuring: units, quantisation, noise, drift, filter, saturation, tare.

#include <gtest/gtest.h>

#include <cmath>

#include "tests/sim/device_bench.h"

namespace tenon::sim {
namespace {

double force_x_N(SensorBench& bench) {
  return 0.01 * static_cast<double>(bench.signed_value({0x6401, 1}));
}

TEST(DeviceForceTorqueTest, BothHalvesComeWithEverySyncInCounts) {
  SensorBench bench;
  bench.wrench << 1.0, -2.0, 300.0, 0.004, -0.005, 1.0;
  bench.pass(1);
  bench.start();
  bench.sync();
  EXPECT_EQ(bench.pdos(0x185), (std::vector<Bytes>{{100, 0, 0x38, 0xFF, 0x30, 0x75, 1, 0}}));
  EXPECT_EQ(bench.pdos(0x285), (std::vector<Bytes>{{4, 0, 0xFB, 0xFF, 0xE8, 0x03, 1, 0}}));
}

TEST(DeviceForceTorqueTest, QuantisesToTheNearestCount) {
  SensorBench bench;
  bench.start();
  for (const auto& [force_N, counts] : {std::pair(0.0049, 0), std::pair(0.0051, 1),
                                        std::pair(-0.0149, -1), std::pair(-0.0151, -2)}) {
    bench.wrench[0] = force_N;
    bench.pass(1);
    bench.sync();
    EXPECT_EQ(bench.signed_value({0x6401, 1}), counts) << force_N;
  }
}

TEST(DeviceForceTorqueTest, SaturatesAtItsRangeAndSaysSo) {
  SensorBench bench;
  bench.start();
  bench.wrench[2] = -301.0;
  bench.wrench[4] = 15.1;
  bench.pass(1);
  bench.sync();
  EXPECT_EQ(bench.signed_value({0x6401, 3}), -30000);
  EXPECT_EQ(bench.signed_value({0x6401, 5}), 15000);
  EXPECT_EQ(bench.value({0x2002}), 1U);
  bench.wrench[2] = -299.0;
  bench.wrench[4] = 14.9;
  bench.pass(1);
  bench.sync();
  EXPECT_EQ(bench.value({0x2002}), 0U);
}

TEST(DeviceForceTorqueTest, NoiseHasTheDataSheetsDeviationAndRepeatsWithItsSeed) {
  const auto samples = [](std::uint64_t seed) {
    SensorBench bench(0.1, seed);
    bench.start();
    std::vector<double> forces;
    for (int i = 0; i < 4000; ++i) {
      bench.sync();
      forces.push_back(force_x_N(bench));
    }
    return forces;
  };
  const std::vector<double> forces = samples(7);
  double sum = 0.0;
  double squares = 0.0;
  for (const double force : forces) {
    sum += force;
    squares += force * force;
  }
  const double count = static_cast<double>(forces.size());
  EXPECT_NEAR(sum / count, 0.0, 4.0 * 0.1 / std::sqrt(count));
  EXPECT_NEAR(std::sqrt(squares / count), 0.1, 0.1 * 4.0 / std::sqrt(2.0 * count));
  EXPECT_EQ(samples(7), forces);
  EXPECT_NE(samples(8), forces);
}

// A step through 1 / (1 + s T) with T = 10 ms: 1 - exp(-t / T).
TEST(DeviceForceTorqueTest, TheFilterIsOfFirstOrder) {
  SensorBench bench(0.0, 1, {.filter_s = 0.010});
  bench.start();
  bench.wrench[0] = 100.0;
  for (int i = 1; i <= 5; ++i) {
    bench.pass(5);
    bench.sync();
    EXPECT_NEAR(force_x_N(bench), 100.0 * (1.0 - std::exp(-0.5 * i)), 0.0051) << i;
  }
}

TEST(DeviceForceTorqueTest, ABiasIsThereFromTheStartAndATareTakesItAway) {
  ForceTorqueNode::Imperfections imperfections;
  imperfections.bias[0] = 2.5;
  SensorBench bench(0.0, 1, imperfections);
  bench.start();
  bench.sync();
  EXPECT_DOUBLE_EQ(force_x_N(bench), 2.5);
  bench.wrench[0] = 1.0;
  bench.pass(1);
  EXPECT_EQ(bench.write_u8({0x2003}, 1), 0U);
  bench.sync();
  EXPECT_DOUBLE_EQ(force_x_N(bench), 0.0);
  bench.wrench[0] = 3.0;
  bench.pass(1);
  bench.sync();
  EXPECT_DOUBLE_EQ(force_x_N(bench), 2.0);
  EXPECT_EQ(bench.write_u8({0x2003}, 0), 0U);
  bench.sync();
  EXPECT_DOUBLE_EQ(force_x_N(bench), 5.5);
}

// A random walk of 0.5 N/sqrt(s): after 4 s its deviation is 1 N.
TEST(DeviceForceTorqueTest, TheBiasDriftsAsARandomWalk) {
  double squares = 0.0;
  constexpr int kSeeds = 300;
  for (std::uint64_t seed = 0; seed < kSeeds; ++seed) {
    ForceTorqueNode sensor(SensorBench::sheet(0.0), seed, {.force_drift_N_sqrts = 0.5});
    sensor.node().power_on(1'000'000'000);  // what passed before is no drift
    sensor.node().receive({.id = 0x000, .length = 2, .data = {0x01, 0x05}}, 0);
    for (int i = 1; i <= 400; ++i) sensor.advance(1'000'000'000 + i * std::int64_t{10'000'000});
    sensor.node().receive({.id = 0x080}, 0);
    const double force_N =
        0.01 * static_cast<double>(sensor.node().dictionary().value(object_id(0x6401, 1)));
    squares += force_N * force_N;
  }
  EXPECT_NEAR(std::sqrt(squares / kSeeds), 1.0, 4.0 / std::sqrt(2.0 * kSeeds));
}

TEST(DeviceForceTorqueTest, AResetCountsSamplesFromZeroAgain) {
  SensorBench bench;
  bench.start();
  bench.sync(5);
  EXPECT_EQ(bench.value({0x2001}), 5U);
  bench.tell(bench.client.nmt(0x81));
  EXPECT_EQ(bench.value({0x2001}), 0U);
}

}  // namespace
}  // namespace tenon::sim

// One seed stands for many streams: where the environment is, the sensor's noise, its drift. None
// repeats another.

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstdint>
#include <vector>

#include "sim/cell/devices/force_torque_node.h"
#include "sim/cell/virtual_arm/environment_offset.h"
#include "tests/sim/device_bench.h"
#include "tests/sim/literal_cell.h"

namespace tenon::sim {
namespace {

constexpr std::uint64_t kSeeds = 400;

/// Over all seeds, of two quantities with mean 0.
double correlation(const std::vector<double>& a, const std::vector<double>& b) {
  double aa = 0.0;
  double bb = 0.0;
  double ab = 0.0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    aa += a[i] * a[i];
    bb += b[i] * b[i];
    ab += a[i] * b[i];
  }
  return ab / std::sqrt(aa * bb);
}

/// Forces along x of the first samples: noise and drift as told.
std::array<double, 2> first_samples_N(std::uint64_t seed, double noise_N, double drift_N_sqrts) {
  SensorBench bench(noise_N, seed, {.force_drift_N_sqrts = drift_N_sqrts});
  bench.start();
  std::array<double, 2> samples_N{};
  for (double& sample_N : samples_N) {
    bench.sync();
    sample_N = 0.01 * static_cast<double>(bench.signed_value({0x6401, 1}));
  }
  return samples_N;
}

TEST(RandomStreamsTest, NoiseDriftAndTheEnvironmentsOffsetDoNotRepeatEachOther) {
  const Task task = wall_task();
  std::array<std::vector<double>, 2> offset;
  std::array<std::vector<double>, 2> noise;
  std::vector<double> drift;
  for (std::uint64_t seed = 1; seed <= kSeeds; ++seed) {
    const Vector6 drawn = draw_offset(task, task.starts[0], seed);
    const auto noisy_N = first_samples_N(seed, 10.0, 0.0);
    for (std::size_t i = 0; i < 2; ++i) {
      offset[i].push_back(drawn[static_cast<Eigen::Index>(i)]);
      noise[i].push_back(noisy_N[i]);
    }
    drift.push_back(first_samples_N(seed, 0.0, 100.0)[0]);
  }
  // Of independent ones the correlation's standard deviation is 1 / sqrt(seeds).
  const double bound = 4.5 / std::sqrt(static_cast<double>(kSeeds));
  for (std::size_t i = 0; i < 2; ++i) {
    for (std::size_t j = 0; j < 2; ++j) {
      EXPECT_LT(std::abs(correlation(offset[i], noise[j])), bound) << i << ", sample " << j;
    }
    EXPECT_LT(std::abs(correlation(offset[i], drift)), bound);
    EXPECT_LT(std::abs(correlation(noise[i], drift)), bound);
  }
  EXPECT_LT(std::abs(correlation(offset[0], offset[1])), bound);
  EXPECT_LT(std::abs(correlation(noise[0], noise[1])), bound);
}

}  // namespace
}  // namespace tenon::sim

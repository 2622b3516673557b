// How often a force/torque sensor has a new sample, as a robot file says it.

#include <gtest/gtest.h>

#include <algorithm>
#include <string>

#include "shared/config/load.h"
#include "tests/shared/slide_robot.h"
#include "tests/support/refusal.h"
#include "tests/support/scratch_folder.h"

namespace tenon {
namespace {

using tests::kSlideRobot;
using tests::refusal;

/// The slide's robot file, cycle 4 ms, with a line more under its sensor.
std::string with_period(const std::string& line) {
  return tests::replaced(kSlideRobot, "node: 4\n", "node: 4\n" + line);
}

TEST(SensorPeriod, IsAWholeNumberOfCyclesAndOneWhereNothingIsSaid) {
  const tests::ScratchFolder folder;
  folder.put("slide.urdf", tests::kSlideUrdf);
  const auto loaded = [&](const std::string& line) {
    return load_robot(folder.put("robot.yaml", with_period(line)));
  };
  EXPECT_EQ(loaded("").sensor.cycles_per_sample, 1);
  EXPECT_EQ(loaded("  period_us: 4000\n").sensor.cycles_per_sample, 1);
  const Robot slow = loaded("  period_us: 12000\n");
  EXPECT_EQ(slow.sensor.cycles_per_sample, 3);
  EXPECT_DOUBLE_EQ(sample_period_s(slow), 0.012);
  // (1 + 3 / 2) * 4 ms + 8 ms
  EXPECT_DOUBLE_EQ(latency_s(slow), 0.018);
}

TEST(SensorPeriod, AnyOtherIsRefusedWithItsPlace) {
  const tests::ScratchFolder folder;
  folder.put("slide.urdf", tests::kSlideUrdf);
  const auto refused = [&](const std::string& value) {
    const auto file = folder.put("robot.yaml", with_period("  period_us: " + value + "\n"));
    std::string line = refusal([&] { (void)load_robot(file); });
    return line.substr(std::min(line.size(), file.string().size()));
  };
  EXPECT_EQ(refused("5000"),
            ":25: sensor.period_us = 5000, must be a multiple of the cycle of 4000 us");
  EXPECT_EQ(refused("2000"), ":25: sensor.period_us = 2000, must be in [4000, 80000]");
  EXPECT_EQ(refused("84000"), ":25: sensor.period_us = 84000, must be in [4000, 80000]");
}

}  // namespace
}  // namespace tenon

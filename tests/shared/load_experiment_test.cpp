// The loader of experiment files: what it reads, and how it refuses.

#include <gtest/gtest.h>

#include <fstream>
#include <string>

#include "shared/config/load.h"
#include "tests/support/places.h"
#include "tests/support/refusal.h"
#include "tests/support/scratch_folder.h"

namespace tenon {
namespace {

class LoadExperimentTest : public ::testing::Test {
 protected:
  WorldRanges load(const std::string& text) const {
    std::ofstream(folder.path() / "x.yaml") << text;
    return load_experiment(folder.path() / "x.yaml");
  }
  std::string refusal(const std::string& text) const {
    const std::string line = tests::refusal([&] { static_cast<void>(load(text)); });
    const std::size_t file = line.find("x.yaml");
    return file == std::string::npos ? line : line.substr(file);
  }

  tests::ScratchFolder folder;
};

TEST_F(LoadExperimentTest, EveryKeyIsOptionalAndMeansNoDifference) {
  const WorldRanges ranges = load("name: nothing\n");
  EXPECT_EQ(ranges.name, "nothing");
  EXPECT_FALSE(ranges.friction);
  EXPECT_FALSE(ranges.contact_stiffness_Npm);
  for (const Spread& spread :
       {ranges.clearance_m, ranges.size_error_m, ranges.task_in_base_error_rad,
        ranges.payload_mass_error_kg, ranges.extra_delay_s, ranges.backlash_rad,
        ranges.force_drift_N_sqrts}) {
    EXPECT_EQ(spread.low, 0.0);
    EXPECT_EQ(spread.high, 0.0);
    EXPECT_EQ(spread.sigma, 0.0);
  }
  EXPECT_EQ(ranges.servo_stiffness_factor.low, 1.0);
  EXPECT_EQ(ranges.servo_stiffness_factor.high, 1.0);
  EXPECT_EQ(ranges.sensor_noise_factor.low, 1.0);
}

TEST_F(LoadExperimentTest, RangesAndSigmasGoWhereTheyBelong) {
  const WorldRanges ranges = load(
      "name: some\nfriction: [0.1, 0.6]\nclearance_m: {sigma: 2e-4}\n"
      "tool_in_flange_error_rad: [-0.01, 0.02]\nbacklash_rad: [0, 1e-3]\n");
  ASSERT_TRUE(ranges.friction);
  EXPECT_EQ(ranges.friction->low, 0.1);
  EXPECT_EQ(ranges.friction->high, 0.6);
  EXPECT_EQ(ranges.clearance_m.sigma, 2e-4);
  EXPECT_EQ(ranges.tool_in_flange_error_rad.low, -0.01);
  EXPECT_EQ(ranges.tool_in_flange_error_rad.high, 0.02);
  EXPECT_EQ(ranges.tool_in_flange_error_m.high, 0.0);
  EXPECT_EQ(ranges.backlash_rad.high, 1e-3);
  EXPECT_FALSE(ranges.drive_friction);
}

TEST_F(LoadExperimentTest, FrictionOfTheDrivesIsOneArmsWithASeedAndEachWorldsOwnWithout) {
  const WorldRanges one = load("name: a\ndrive_friction: {share: [0.02, 0.1], seed: 7}\n");
  ASSERT_TRUE(one.drive_friction);
  EXPECT_EQ(one.drive_friction->share.low, 0.02);
  EXPECT_EQ(one.drive_friction->share.high, 0.1);
  EXPECT_EQ(one.drive_friction->seed, 7U);
  const WorldRanges many = load("name: a\ndrive_friction: {share: [0.05, 0.05]}\n");
  ASSERT_TRUE(many.drive_friction);
  EXPECT_FALSE(many.drive_friction->seed);
  EXPECT_NE(refusal("name: a\ndrive_friction: {share: [0.1, 0.6]}\n")
                .find("x.yaml:2: drive_friction.share[1] = 0.6, must be in [0.1, 0.5]"),
            std::string::npos);
}

TEST_F(LoadExperimentTest, RefusalsNameLineKeyValueAndBound) {
  EXPECT_EQ(refusal("friction: [0.1, 0.2]\n"), "x.yaml:1: the required key name is missing");
  EXPECT_NE(refusal("name: a\nfriction: [0.6, 0.1]\n").find("x.yaml:2: friction[1] = 0.1, must be"),
            std::string::npos);
  EXPECT_NE(refusal("name: a\nfriction: {sigma: 0.1}\n").find("x.yaml:2: friction"),
            std::string::npos);
  EXPECT_NE(refusal("name: a\nfriction: [-0.1, 0.1]\n").find("friction[0] = -0.1, must be"),
            std::string::npos);
  EXPECT_NE(refusal("name: a\nclearance_m: {sigma: -1e-4}\n").find("clearance_m.sigma = -1e-4"),
            std::string::npos);
  EXPECT_NE(refusal("name: a\nclearance_m: 0.001\n").find("x.yaml:2: clearance_m"),
            std::string::npos);
  EXPECT_NE(refusal("name: a\nclearance_mm: [0, 1]\n").find("clearance_mm"), std::string::npos);
}

// Each of them looked for among all others would take ten minutes.
TEST_F(LoadExperimentTest, OfAHundredThousandUnknownKeysTheFirstIsNamed) {
  std::string text = "name: a\n";
  for (int i = 0; i < 100'000; ++i) text += "k" + std::to_string(i) + ": 1\n";
  EXPECT_TRUE(refusal(text).starts_with("x.yaml:2: k0: is an unknown key")) << refusal(text);
}

TEST_F(LoadExperimentTest, TheExperimentsOfTheTreeLoad) {
  const WorldRanges ranges = load_experiment(tests::in_tree("sim/experiments/box_on_table.yaml"));
  EXPECT_EQ(ranges.name, "box_on_table");
  EXPECT_GT(ranges.task_in_base_error_m.sigma, 0.0);
}

}  // namespace
}  // namespace tenon

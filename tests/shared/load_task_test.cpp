// Variants, rings and the inserted predicate of a task file.

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <numbers>
#include <string>

#include "shared/config/load.h"
#include "shared/task/inserted.h"
#include "shared/task/spread.h"
#include "tests/shared/slide_robot.h"
#include "tests/support/places.h"
#include "tests/support/refusal.h"
#include "tests/support/scratch_folder.h"

namespace tenon {
namespace {

using tests::refusal;
using tests::replaced;
using tests::ScratchFolder;

constexpr const char* kPegTask = R"(name: peg
coordinates: [x, z]
held:
  - {name: peg, cylinder: {diameter_m: 0.02, length_m: 0.1}, pose: {position_m: [0, 0, 0.05]}}
environment:
  - {name: left, box_m: [0.1, 0.1, 0.1], pose: {position_m: [-0.062, 0, -0.05]}}
  - {name: right, box_m: [0.1, 0.1, 0.1], pose: {position_m: [0.062, 0, -0.05]}}
starts:
  - {name: above, pose: {position_m: [0, 0, 0.1]}, sigma_m: [0.01, 0.01]}
goal: {pose: {position_m: [0, 0, -0.04]}, tolerance_m: 0.01, uncertainty_m2: 2e-6}
primitives: {step_m: 0.1, long_step_m: 1.0, direct_reach_m: 0.3}
speeds: {approach_mps: 0.1, contact_mps: 0.05}
contact: {force_on_N: 6, force_keep_N: 3, force_off_N: 1.5, debounce_s: 0.006, force_limit_N: 20}
compliance: {axes: [x, z], mass_kg: 2, damping_Nspm: 1500, stiffness_Npm: 1000}
physics: {friction: {low: 0.1, nominal: 0.3, high: 0.6}, contact_stiffness_Npm: 5e4}
variants:
  fine:
    goal: {tolerance_m: 0.002}
    starts: [{name: near, pose: {position_m: [0, 0, 0.02]}, sigma_m: [0.001, 0.002]}]
    search: {w1: 3}
  tight:
    environment:
      left: {pose: {position_m: [-0.0605, 0, -0.05]}}
      right: {box_m: [0.2, 0.1, 0.1], pose: {position_m: [0.1105, 0, -0.05]}}
)";

Task load(const ScratchFolder& folder, const char* variant) {
  return load_task(folder.put("peg.yaml", kPegTask).string() + variant);
}

std::string refused(const ScratchFolder& folder, const char* what, const char* by,
                    const char* variant) {
  const std::string file = folder.put("peg.yaml", replaced(kPegTask, what, by)).string();
  const std::string line = refusal([&] { (void)load_task(file + variant); });
  return line.starts_with(file) ? line.substr(file.size()) : line;
}

TEST(LoadTask, HashIsThatOfTheBytes) {
  const ScratchFolder folder;
  const std::uint64_t hash = load_task(folder.put("a.yaml", kPegTask)).hash;
  EXPECT_EQ(load_task(folder.put("b.yaml", kPegTask)).hash, hash);
  EXPECT_NE(load_task(folder.put("c.yaml", std::string(kPegTask) + "\n")).hash, hash);
}

TEST(TaskErrors, UniformOnesReachToTheirBounds) {
  const ScratchFolder folder;
  const char* const normal = "pose: {position_m: [0, 0, 0.1]}, sigma_m: [0.01, 0.01]}";
  const Task task = load_task(folder.put(
      "uniform.yaml",
      replaced(kPegTask, normal, "pose: {position_m: [0, 0, 0.1]}, uniform_m: [0.01, 0.02]}")));
  EXPECT_EQ(task.errors, Distribution::kUniform);
  const Start& start = task.starts[0];
  EXPECT_NEAR(start.sigma[0], 0.01 / std::numbers::sqrt3, 1e-15);
  EXPECT_NEAR(start.sigma[2], 0.02 / std::numbers::sqrt3, 1e-15);
  EXPECT_NEAR(task.particle_sigmas * start.sigma[2], 0.02, 1e-15);
  EXPECT_NEAR(sigmas_out(task, start, start.sigma), 1.0, 1e-12);
  EXPECT_EQ(drawn_sigmas(task), task.particle_sigmas);
  EXPECT_EQ(out_text(task, 0.5 * task.particle_sigmas), "at 50 % of the bounds");

  const Task other = load(folder, "");
  EXPECT_NEAR(sigmas_out(other, other.starts[0], other.starts[0].sigma), std::numbers::sqrt2,
              1e-12);
  EXPECT_EQ(drawn_sigmas(other), other.particle_sigmas + 1.0);
  EXPECT_EQ(out_text(other, 1.732), "1.73 sigma out");

  EXPECT_EQ(
      refused(folder, "sigma_m: [0.01, 0.01]}", "sigma_m: [0.01, 0.01], uniform_m: [0.01, 0.01]}",
              ""),
      ":9: starts[0].sigma_m: normal errors (sigma_m, sigma_rad) and uniform ones (uniform_m, "
      "uniform_rad) do not mix in a task");
  EXPECT_EQ(refused(folder, "sigma_m: [0.01, 0.01]}", "uniform_m: [0.01, 0]}", ""),
            ":9: starts[0].uniform_m[1] = 0, must be in (0, 1]; where z is known, leave it out of "
            "coordinates");
  EXPECT_EQ(
      refused(folder, "sigma_m: [0.01, 0.01]}\n", "uniform_m: [0.01, 0.01]}\nparticle_sigmas: 3\n",
              ""),
      ":10: particle_sigmas: counts standard deviations of normal errors (sigma_m, sigma_rad); "
      "a plan for uniform ones holds to their bounds");
}

TEST(TaskGoal, SaysWhichAxesHaveAToleranceOfTheirOwnAndWhichHaveNone) {
  const ScratchFolder folder;
  constexpr const char* kWhat = "tolerance_m: 0.01,";
  const auto loaded = [&](const char* by) {
    return load_task(folder.put("own.yaml", replaced(kPegTask, kWhat, by)));
  };
  EXPECT_FALSE(load(folder, "").goal_axes.any());
  const Task own = loaded("tolerance_m: 0.01, tolerances: {z_m: 0.003}, free: [x],");
  EXPECT_EQ(own.goal_axes.tolerance, 0.003 * Vector6::Unit(2));
  EXPECT_EQ(own.goal_axes.free, 0b000001);
  EXPECT_EQ(tolerance_text(own.goal_tolerance_m, own.goal_axes), "10 mm, x any, z 3 mm");

  EXPECT_EQ(refused(folder, kWhat, "tolerance_m: 0.01, tolerances: {z_m: 0},", ""),
            ":10: goal.tolerances.z_m = 0, must be in (0, 1]");
  EXPECT_EQ(refused(folder, kWhat, "tolerance_m: 0.01, tolerances: {y_m: 0.1},", ""),
            ":10: goal.tolerances.y_m: names y, which is not a search coordinate");
  EXPECT_EQ(refused(folder, kWhat, "tolerance_m: 0.01, free: [rz],", ""),
            ":10: goal.free: names rz, which is not a search coordinate");
  EXPECT_EQ(refused(folder, kWhat, "tolerance_m: 0.01, tolerances: {z_m: 0.1}, free: [z],", ""),
            ":10: goal.free: names z, which has a tolerance");
  EXPECT_EQ(refused(folder, kWhat, "tolerance_m: 0.01, tolerances: {z: 0.1},", ""),
            ":10: goal.tolerances.z: is an unknown key, known here: x_m, y_m, z_m, rx_rad, ry_rad, "
            "rz_rad");
}

TEST(TaskVariant, ChangesWhatItNamesAndNothingElse) {
  const ScratchFolder folder;
  const Task base = load(folder, "");
  const Task fine = load(folder, "#fine");
  EXPECT_EQ(fine.goal_tolerance_m, 0.002);
  EXPECT_EQ(fine.goal_uncertainty_m2, base.goal_uncertainty_m2);
  EXPECT_EQ(fine.goal, base.goal);
  EXPECT_EQ(fine.w1, 3.0);
  EXPECT_EQ(fine.w2, base.w2);
  ASSERT_EQ(fine.starts.size(), 1U);
  EXPECT_EQ(fine.starts[0].name, "near");
  EXPECT_EQ(fine.starts[0].sigma[2], 0.002);
  EXPECT_EQ(fine.environment[0].pose, base.environment[0].pose);

  EXPECT_EQ(base.goal_tolerance_m, 0.01);
  EXPECT_EQ(base.starts[0].name, "above");
}

TEST(TaskVariant, ChangesTheEntriesOfAListByName) {
  const ScratchFolder folder;
  const Task task = load(folder, "#tight");
  ASSERT_EQ(task.environment.size(), 2U);
  EXPECT_EQ(task.environment[0].name, "left");
  EXPECT_EQ(task.environment[0].size_m, Vector3(0.1, 0.1, 0.1));
  EXPECT_EQ(task.environment[0].pose.position_m, Vector3(-0.0605, 0, -0.05));
  EXPECT_EQ(task.environment[1].size_m, Vector3(0.2, 0.1, 0.1));
  EXPECT_EQ(task.environment[1].pose.position_m, Vector3(0.1105, 0, -0.05));
}

TEST(TaskVariant, LeavesAliasesOfWhatItChangesAlone) {
  const ScratchFolder folder;
  const std::string text = replaced(replaced(kPegTask, "goal: {pose: {position_m: [0, 0, -0.04]}",
                                             "goal: {pose: {position_m: *place}"),
                                    "above, pose: {position_m: [0, 0, 0.1]}",
                                    "above, pose: {position_m: &place [0, 0, 0.1]}");
  const std::string file =
      folder
          .put("peg.yaml", replaced(text, "goal: {tolerance_m: 0.002}",
                                    "goal: {pose: {position_m: [0, 0, -0.03]}}"))
          .string();
  EXPECT_EQ(load_task(file).goal.position_m, Vector3(0, 0, 0.1));
  const std::string kept = replaced(folder.get("peg.yaml"),
                                    "    starts: [{name: near, pose: {position_m: [0, 0, 0.02]}, "
                                    "sigma_m: [0.001, 0.002]}]\n",
                                    "");
  const Task fine = load_task(folder.put("kept.yaml", kept).string() + "#fine");
  EXPECT_EQ(fine.goal.position_m, Vector3(0, 0, -0.03));
  EXPECT_EQ(fine.starts[0].pose.position_m, Vector3(0, 0, 0.1));
}

TEST(TaskVariant, HasANameAndAHashOfItsOwn) {
  const ScratchFolder folder;
  EXPECT_EQ(load(folder, "").name, "peg");
  EXPECT_EQ(load(folder, "#fine").name, "peg/fine");
  EXPECT_EQ(load(folder, "#tight").name, "peg/tight");
  EXPECT_NE(load(folder, "#fine").hash, load(folder, "").hash);
  EXPECT_NE(load(folder, "#fine").hash, load(folder, "#tight").hash);
  EXPECT_EQ(load(folder, "#fine").hash, load(folder, "#fine").hash);
  EXPECT_EQ(task_variants(folder.path() / "peg.yaml"), (std::vector<std::string>{"fine", "tight"}));
}

TEST(TaskVariant, AFileWhoseNameHoldsTheMarkIsThatFile) {
  const ScratchFolder folder;
  const auto file = folder.put("peg#fine.yaml", kPegTask);
  EXPECT_EQ(load_task(file).name, "peg");
  EXPECT_EQ(load_task(file.string() + "#fine").name, "peg/fine");
}

TEST(TaskVariant, RefusesEachBadLineWithItsPlace) {
  const ScratchFolder folder;
  const struct {
    const char* what;
    const char* by;
    const char* variant;
    const char* message;
  } lines[] = {
      {"w1: 3", "w1: 3", "#coarse", ":17: variants: has no 'coarse', there are: fine, tight"},
      {"w1: 3", "w1: 3", "#", ":17: variants: has no '', there are: fine, tight"},
      {"variants:", "search:", "#fine", ":1: has no variant 'fine', nor any other"},
      {"tolerance_m: 0.002", "tolerance_m: 2", "#fine",
       ":18: variants.fine.goal.tolerance_m = 2, must be in (0, 1]; is it in mm? then write 0.002 "
       "m"},
      {"tolerance_m: 0.01", "tolerance_m: 2", "#tight",
       ":10: goal.tolerance_m = 2, must be in (0, 1]; is it in mm? then write 0.002 m"},
      {"{tolerance_m: 0.002}", "{tolerance: 2}", "#fine",
       ":18: variants.fine.goal.tolerance: is an unknown key, known here: pose, tolerance_m, "
       "tolerances, free, uncertainty_m2, inserted; did you mean tolerance_m?"},
      {"    search: {w1: 3}", "    serach: {w1: 3}", "#fine",
       ":20: variants.fine.serach: is an unknown key, known here: name, coordinates, held, "
       "environment, starts, error_about_m, particle_sigmas, goal, primitives, speeds, contact, "
       "compliance, "
       "search, physics, variants; did you mean search?"},
      {"{w1: 3}", "{w1: 3, w1: 4}", "#fine", ":20: variants.fine.search.w1: is given twice"},
      {"sigma_m: [0.001, 0.002]", "sigma_m: [0.001]", "#fine",
       ":19: variants.fine.starts[0].sigma_m: has 1 entry, must have 2, for x z"},
      {"      left: {", "      middle: {", "#tight",
       ":23: variants.tight.environment.middle: is not a name in the list environment"},
      {"      left: {", "      right: {", "#tight",
       ":24: variants.tight.environment.right: is given twice"},
      {"    search: {w1: 3}", "    variants: {}", "#fine",
       ":20: variants.fine.variants: a variant has none itself"},
      {"  fine:\n", "  fine: 3\n  else:\n", "#fine",
       ":17: variants.fine = 3, must be a mapping with the keys name, coordinates, held, "
       "environment, starts, error_about_m, particle_sigmas, goal, primitives, speeds, contact, "
       "compliance, "
       "search, physics, variants"},
      {"  fine:", "  variant_whose_name_is_so_long_that_no_plan_file_could_hold_it:",
       "#variant_whose_name_is_so_long_that_no_plan_file_could_hold_it",
       ":1: name: with its variant, "
       "'peg/variant_whose_name_is_so_long_that_no_plan_file_could_hold_it', longer than 63 "
       "characters"},
  };
  for (const auto& line : lines) {
    EXPECT_EQ(refused(folder, line.what, line.by, line.variant), line.message) << line.by;
  }
}

TEST(TaskVariant, AllThatShipLoadWithTheirFiles) {
  int files = 0;
  for (const std::string& file : tests::task_files()) {
    const std::string base = load_task(file).name;
    for (const std::string& variant : task_variants(file)) {
      EXPECT_EQ(load_task(file + "#" + variant).name, base + "/" + variant);
    }
    ++files;
  }
  EXPECT_GT(files, 0);
}

constexpr const char* kBlock =
    "  - {name: left, box_m: [0.1, 0.1, 0.1], pose: {position_m: [-0.062, 0, -0.05]}}\n";

Task with_hole(const ScratchFolder& folder, const std::string& sizes) {
  const std::string ring = "  - {name: hole, ring: {" + sizes +
                           "}, pose: {position_m: [0.3, 0.2, -0.05], rotation_rad: [0, 0, 0.1]}}\n";
  return load_task(folder.put("hole.yaml", replaced(kPegTask, kBlock, ring)));
}

// Whether a point of the ring's own frame lies in one of the first `count` boxes.
bool filled(const Task& task, const Pose& ring, const Vector3& point_m, std::size_t count) {
  for (std::size_t i = 0; i < count; ++i) {
    const Shape& box = task.environment[i];
    const Pose in_task = compose(ring, {point_m, Eigen::Quaterniond::Identity()});
    const Vector3 inside_m = compose(inverse(box.pose), in_task).position_m;
    if ((inside_m.cwiseAbs().array() < 0.5 * box.size_m.array()).all()) return true;
  }
  return false;
}

TEST(TaskRing, FillsTheSpaceBetweenTwoPolygonsAroundItsCircles) {
  const ScratchFolder folder;
  const Task task =
      with_hole(folder, "inner_diameter_m: 0.022, outer_diameter_m: 0.06, length_m: 0.04");
  ASSERT_EQ(task.environment.size(), 17U);
  EXPECT_EQ(task.environment[0].name, "hole[0]");
  EXPECT_EQ(task.environment[15].name, "hole[15]");
  EXPECT_EQ(task.environment[16].name, "right");

  const Pose ring = {{0.3, 0.2, -0.05}, rotation_of({0.0, 0.0, 0.1})};
  const double side_rad = 2.0 * std::numbers::pi / 16.0;
  for (int i = 0; i < 1000; ++i) {
    const double angle_rad = 2.0 * std::numbers::pi * i / 1000.0;
    // From the nearest face's normal: a regular polygon's radius in closed form.
    const double off_rad = std::remainder(angle_rad, side_rad);
    const double longer = 1.0 / std::cos(off_rad);
    EXPECT_LE(longer, 1.0197);
    const auto at = [&](double radius_m, double z_m) {
      return Vector3(radius_m * std::cos(angle_rad), radius_m * std::sin(angle_rad), z_m);
    };
    constexpr double kTiny_m = 1e-9;
    EXPECT_FALSE(filled(task, ring, at(0.011 * longer - kTiny_m, 0.0), 16)) << angle_rad;
    EXPECT_TRUE(filled(task, ring, at(0.011 * longer + kTiny_m, 0.0), 16)) << angle_rad;
    EXPECT_TRUE(filled(task, ring, at(0.02, 0.0199), 16)) << angle_rad;
    EXPECT_FALSE(filled(task, ring, at(0.02, 0.0201), 16)) << angle_rad;
    EXPECT_TRUE(filled(task, ring, at(0.03 * longer - kTiny_m, 0.0), 16)) << angle_rad;
    EXPECT_FALSE(filled(task, ring, at(0.03 * longer + kTiny_m, 0.0), 16)) << angle_rad;
  }
}

TEST(TaskRing, TakesItsNumberOfSegments) {
  const ScratchFolder folder;
  const std::string sizes = "inner_diameter_m: 0.022, outer_diameter_m: 0.06, length_m: 0.04";
  EXPECT_EQ(with_hole(folder, sizes + ", segments: 32").environment.size(), 33U);
  const std::string file = (folder.path() / "hole.yaml").string();
  EXPECT_EQ(refusal([&] { (void)with_hole(folder, sizes + ", segments: 7"); }),
            file + ":6: environment[0].ring.segments = 7, must be in [8, 64]");
  EXPECT_EQ(refusal([&] {
              (void)with_hole(folder,
                              "inner_diameter_m: 0.06, outer_diameter_m: 0.06, length_m: 0.04");
            }),
            file + ":6: environment[0].ring.outer_diameter_m = 0.06, must be in (0.06, 100]");
}

TEST(TaskInserted, IsABoxAroundTheTip) {
  const ScratchFolder folder;
  EXPECT_TRUE(inserted(load(folder, ""), {{9.0, 9.0, 9.0}, {}}));

  // Turned by a quarter about z: its x edge lies along the task's y.
  const Task task = load_task(folder.put(
      "peg.yaml",
      replaced(kPegTask, "uncertainty_m2: 2e-6}",
               "uncertainty_m2: 2e-6, inserted: {box_m: [0.02, 0.04, 0.06], pose: "
               "{position_m: [0, 0, -0.05], rotation_rad: [0, 0, 1.5707963267948966]}}}")));
  const auto at = [&task](double x_m, double y_m, double z_m) {
    return inserted(task, {{x_m, y_m, z_m}, rotation_of({0.3, 0.0, 0.0})});
  };
  EXPECT_TRUE(at(0.0, 0.0, -0.05));
  EXPECT_TRUE(at(0.019, 0.009, -0.021));
  EXPECT_TRUE(at(-0.019, -0.009, -0.079));
  EXPECT_FALSE(at(0.021, 0.0, -0.05));
  EXPECT_FALSE(at(0.0, -0.011, -0.05));
  EXPECT_FALSE(at(0.0, 0.0, -0.019));
  EXPECT_FALSE(at(0.0, 0.0, -0.081));
}

TEST(TaskInserted, MustContainTheGoal) {
  const ScratchFolder folder;
  EXPECT_EQ(refused(folder, "uncertainty_m2: 2e-6}",
                    "uncertainty_m2: 2e-6, inserted: {box_m: [0.02, 0.02, 0.02], pose: "
                    "{position_m: [0, 0, -0.06]}}}",
                    ""),
            ":10: goal.inserted: must contain the goal's position");
}

// The file has no step of its own that could be too long: it is the errors that are.
TEST(LoadTask, StartsWhoseErrorsAskForEndlessMovesAreAskedForTheirUnit) {
  const ScratchFolder folder;
  std::string text = replaced(kPegTask, "sigma_m: [0.01, 0.01]", "uniform_m: [0.5, 0.5]");
  text.resize(text.find("variants:"));
  const std::size_t at = text.find("primitives:");
  text.erase(at, text.find('\n', at) + 1 - at);
  const std::string told = refusal([&] { (void)load_task(folder.put("x.yaml", text)); });
  EXPECT_NE(
      told.find(":9: starts: errors up to 0.5 m, of a part that measures 0.1 m, ask for moves "
                "that take "),
      std::string::npos)
      << told;
  EXPECT_NE(told.find("are all lengths in m"), std::string::npos) << told;
}

}  // namespace
}  // namespace tenon

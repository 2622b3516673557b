// What is written is read, and each bad line is refused with its place.

#include "shared/config/load.h"

#include <gtest/gtest.h>

#include "tests/shared/slide_robot.h"
#include "tests/support/refusal.h"
#include "tests/support/scratch_folder.h"

namespace tenon {
namespace {

using tests::kSlideRobot;
using tests::kSlideUrdf;
using tests::refusal;
using tests::replaced;
using tests::ScratchFolder;

constexpr const char* kTinyTask = R"(name: tiny
coordinates: [x, rz]
held:
  - {name: peg, cylinder: {diameter_m: 0.02, length_m: 0.1}, pose: {position_m: [0, 0, 0.05]}}
environment:
  - {name: wall, box_m: [1, 2, 3], pose: {position_m: [0, 0, 1], rotation_rad: [0, 0, 0.5]}}
starts:
  - {name: left, pose: {position_m: [-0.1, 0, 0]}, sigma_m: [0.03], sigma_rad: [0.02]}
  - {name: right, pose: {position_m: [0.1, 0, 0]}, sigma_m: [0.04], sigma_rad: [0.02]}
goal: {pose: {position_m: [0.2, 0, 0]}, tolerance_m: 0.002, uncertainty_m2: 2e-6}
primitives: {step_m: 0.1, step_rad: 0.05, long_step_m: 1.0, direct_reach_m: 0.3}
speeds: {approach_mps: 0.1, contact_mps: 0.05}
contact:
  force_on_N: 6.0
  force_keep_N: 3.0
  force_off_N: 1.5
  debounce_s: 0.006
  force_limit_N: 20.0
compliance: {axes: [x, y, rz], mass_kg: 2, damping_Nspm: 1500, stiffness_Npm: 1000}
search: {w1: 3, w2: 1.5, move_weight: 0}
physics:
  friction: {low: 0.1, nominal: 0.3, high: 0.6}
  contact_stiffness_Npm: 5e4
  oversize_m: 2.5e-4
  rollout_step_s: 0.002
)";

constexpr const char* kCell = R"(name: bench
robot: robots/slide.yaml
task_in_base: {position_m: [0.1, 0.05, 0]}
tool_in_flange: {position_m: [0, 0, -0.15]}
sensor_in_flange: {position_m: [0, 0, 0]}
payload: {mass_kg: 0.5, com_m: [0, 0, -0.1]}
contact_stiffness_Npm: 5e4
faults: {force_N: 60, torque_Nm: 10}
)";

/// In a good file, `what` becomes `by`, and the message is the file's name and `message`.
struct BadLine {
  const char* what;
  const char* by;
  const char* message;
};

template <typename Load>
void expect_refusals(const char* good, const std::vector<BadLine>& lines, Load load) {
  const ScratchFolder folder;
  folder.put("robots/slide.yaml", kSlideRobot);
  folder.put("robots/slide.urdf", kSlideUrdf);
  folder.put("slide.urdf", kSlideUrdf);
  EXPECT_NO_THROW(load(folder.put("good.yaml", good)));
  for (const BadLine& line : lines) {
    const std::filesystem::path file = folder.put("bad.yaml", replaced(good, line.what, line.by));
    EXPECT_EQ(refusal([&] { load(file); }), file.string() + line.message) << line.by;
  }
}

TEST(LoadTask, ReadsEveryValue) {
  const ScratchFolder folder;
  const Task task = load_task(folder.put("task.yaml", kTinyTask));
  EXPECT_EQ(task.name, "tiny");
  EXPECT_EQ(task.coordinates, 0b100001);
  ASSERT_EQ(task.held.size(), 1U);
  EXPECT_EQ(task.held[0].kind, Shape::Kind::kCylinder);
  EXPECT_EQ(task.held[0].size_m, Vector3(0.02, 0.02, 0.1));
  EXPECT_EQ(task.held[0].pose.position_m, Vector3(0, 0, 0.05));
  ASSERT_EQ(task.environment.size(), 1U);
  EXPECT_EQ(task.environment[0].kind, Shape::Kind::kBox);
  EXPECT_EQ(task.environment[0].size_m, Vector3(1, 2, 3));
  EXPECT_NEAR(task.environment[0].pose.orientation.z(), std::sin(0.25), 1e-15);
  ASSERT_EQ(task.starts.size(), 2U);
  EXPECT_EQ(task.starts[1].name, "right");
  EXPECT_EQ(task.starts[1].sigma, (Vector6() << 0.04, 0, 0, 0, 0, 0.02).finished());
  EXPECT_EQ(task.goal.position_m, Vector3(0.2, 0, 0));
  EXPECT_EQ(task.goal_uncertainty_m2, 2e-6);
  EXPECT_EQ(task.step_rad, 0.05);
  EXPECT_EQ(task.motion.speeds.contact_mps, 0.05);
  EXPECT_EQ(task.motion.thresholds.debounce_us, 6000U);
  EXPECT_EQ(task.motion.timeout_us, 10'000'000U);
  EXPECT_EQ(task.compliance.compliant_axes, 0b100011);
  EXPECT_EQ(task.w1, 3.0);
  EXPECT_EQ(task.w2, 1.5);
  EXPECT_EQ(task.distance_weight_per_m, Task{}.distance_weight_per_m);
  EXPECT_EQ(task.move_weight, 0.0);
  EXPECT_EQ(task.friction.high, 0.6);
  EXPECT_EQ(task.oversize_m, 2.5e-4);
  EXPECT_EQ(task.tilt_rad, 3e-3);
  EXPECT_EQ(task.sensor_error_m, 1e-3);
  EXPECT_EQ(task.contact_give_mpN, 3e-5);
  EXPECT_EQ(task.rollout_step_us, 2000);

  const std::string level = replaced(kTinyTask, "  oversize_m: 2.5e-4\n",
                                     "  tilt_rad: 0\n  sensor_error_m: 5e-4\n"
                                     "  contact_give_mpN: 1e-5\n");
  EXPECT_EQ(load_task(folder.put("level.yaml", level)).tilt_rad, 0.0);
  EXPECT_EQ(load_task(folder.put("level.yaml", level)).sensor_error_m, 5e-4);
  EXPECT_EQ(load_task(folder.put("level.yaml", level)).contact_give_mpN, 1e-5);

  // A fast tool gets a step in which it goes no further than 0.5 mm.
  const std::string fast = replaced(replaced(kTinyTask, "  rollout_step_s: 0.002\n", ""),
                                    "approach_mps: 0.1", "approach_mps: 1.0");
  EXPECT_EQ(load_task(folder.put("fast.yaml", fast)).rollout_step_us, 500);
}

TEST(LoadTask, WhatAnyEndWillDoForNeedNotYield) {
  const ScratchFolder folder;
  constexpr const char* kTolerance = "tolerance_m: 0.002";
  const std::string free = replaced(kTinyTask, kTolerance, "tolerance_m: 0.002, free: [rz]");
  std::string rigid = free;
  rigid.replace(rigid.find("[x, y, rz]"), 10, "[x, y]");
  const Task task = load_task(folder.put("free.yaml", rigid));
  EXPECT_EQ(task.compliance.compliant_axes, 0b000011);
  EXPECT_EQ(task.coordinates, 0b100001);
}

TEST(LoadTask, RefusesEachBadCoordinateAndSpreadWithItsPlace) {
  const std::vector<BadLine> lines = {
      {"sigma_m: [0.03]", "sigma_m: [-0.03]",
       ":8: starts[0].sigma_m[0] = -0.03, must be in (0, 1]"},
      {"sigma_m: [0.03]", "sigma_m: [0]",
       ":8: starts[0].sigma_m[0] = 0, must be in (0, 1]; where x is known, leave it out of "
       "coordinates"},
      {"sigma_m: [0.03]", "sigma_m: [.nan]",
       ":8: starts[0].sigma_m[0] = .nan, must be a number in (0, 1]"},
      {"sigma_m: [0.03]", "sigma_m: [nan]", ":8: starts[0].sigma_m[0] = nan, must be in (0, 1]"},
      {"sigma_m: [0.03]", "sigma_m: [1e999]",
       ":8: starts[0].sigma_m[0] = 1e999, must be a number in (0, 1]"},
      {"sigma_m: [0.03]", "sigma_m: [0.03, 0.03]",
       ":8: starts[0].sigma_m: has 2 entries, must have 1, for x"},
      {"sigma_m: [0.03]", "sigma_m: 0.03", ":8: starts[0].sigma_m = 0.03, must be a list of 1"},
      {", sigma_rad: [0.02]", "",
       ":8: starts[0]: the required key sigma_rad is missing, a list of 1, for rz"},
      {"coordinates: [x, rz]", "coordinates: [x]",
       ":8: starts[0].sigma_rad: no search coordinate has this unit: must have none"},
      {"coordinates: [x, rz]", "coordinates: [x, w]",
       ":2: coordinates[1] = w, must be one of: x, y, z, rx, ry, rz"},
      {"[x, rz]", "[x, x]", ":2: coordinates[1] = x, must be listed once"},
      {"coordinates: [x, rz]", "coordinates: []",
       ":2: coordinates is empty, must be a list of 1 to 6"},
  };
  expect_refusals(kTinyTask, lines,
                  [](const std::filesystem::path& file) { (void)load_task(file); });
}

TEST(LoadTask, RefusesEachBadNameAndShapeWithItsPlace) {
  const std::vector<BadLine> lines = {
      {"name: right", "name: left", ":9: starts[1].name = left, must be unique among the starts"},
      {"name: wall", "name: peg", ":6: environment[0].name = peg, must be unique among the shapes"},
      {"[-0.1, 0, 0]", "[-0.1, 0, 0.01]",
       ":8: starts[0].pose: is 0.010000 m off the goal along z, which is not a search coordinate; "
       "add z to coordinates, or let start and goal agree along it"},
      {"box_m: [1, 2, 3]", "box_m: [1, 0, 3]",
       ":6: environment[0].box_m[1] = 0, must be in (0, 100]"},
      {"box_m: [1, 2, 3], ", "",
       ":6: environment[0]: needs one of box_m: [x, y, z], cylinder: {diameter_m: d, length_m: l}, "
       "ring: {inner_diameter_m: i, outer_diameter_m: o, length_m: l}, "
       "extrusion: {profile_m: [[x, y], ...], length_m: l}, mesh: {file: f, scale: s}"},
      {"box_m: [1, 2, 3]", "box_m: [60, 60, 160]",
       ":6: environment[0].box_m[2] = 160, must be in (0, 100]; is it in mm? then write 0.16 m"},
      {"length_m: 0.1", "length: 0.1",
       ":4: held[0].cylinder.length: is an unknown key, known here: diameter_m, length_m; did "
       "you mean length_m?"},
      {"length_m: 0.1", "length_m: 0.1, diameter_m: 1",
       ":4: held[0].cylinder.diameter_m: is given twice"},
      {"name: tiny\n", "name: tiny\ncolour: red\n",
       ":2: colour: is an unknown key, known here: name, coordinates, held, environment, starts, "
       "error_about_m, particle_sigmas, goal, primitives, speeds, contact, compliance, search, "
       "physics, variants"},
      {"name: tiny\n", "", ":1: the required key name is missing"},
      {"name: tiny", "name: tin\xC3\xBF",
       ":1: name = tin\xC3\xBF, must be a name of 1 to 63 printable ASCII characters"},
      {"name: tiny", "name: [a]",
       ":1: name is a list, must be a name of 1 to 63 printable ASCII characters"},
  };
  expect_refusals(kTinyTask, lines,
                  [](const std::filesystem::path& file) { (void)load_task(file); });
}

TEST(LoadTask, RefusesEachBadNumberWithItsPlace) {
  const std::vector<BadLine> lines = {
      {"tolerance_m: 0.002", "tolerance_m: two",
       ":10: goal.tolerance_m = two, must be a number in (0, 1]"},
      {"tolerance_m: 0.002", "tolerance_m: \"0.002\"",
       ":10: goal.tolerance_m = 0.002, must be a number in (0, 1]; leave the quotes out"},
      {"tolerance_m: 0.002", "tolerance_m: 3/1000",
       ":10: goal.tolerance_m = 3/1000, must be a number in (0, 1]; write the quotient as a "
       "number"},
      {"tolerance_m: 0.002", "tolerance_m: +-0.002",
       ":10: goal.tolerance_m = +-0.002, must be a number in (0, 1]"},
      {"tolerance_m: 0.002", "tolerance_m: +2",
       ":10: goal.tolerance_m = +2, must be in (0, 1]; is it in mm? then write 0.002 m"},
      {"tolerance_m: 0.002",
       "tolerance_m:", ":10: goal.tolerance_m is empty, must be a number in (0, 1]"},
      {"pose: {position_m: [0.2, 0, 0]}, ", "", ":10: goal: the required key pose is missing"},
      {"contact_mps: 0.05", "contact_mps: 0.005",
       ":11: primitives: a step takes 20 s at contact speed, contact.timeout_s is 10 s: shorter "
       "steps, more speed or more time"},
      {"contact_mps: 0.05", "contact_mps: 0.2",
       ":12: speeds.contact_mps = 0.2, must be in (0, 0.1]: no more than approach_mps"},
      {"long_step_m: 1.0", "long_step_m: 0.01",
       ":11: primitives.long_step_m = 0.01, must be in [0.1, 10]"},
      {"force_keep_N: 3.0", "force_keep_N: 7.0",
       ":14: contact: 0 < force_off < force_keep < force_on does not hold: 1.5, 7, 6 N"},
      {"force_limit_N: 20.0", "force_limit_N: 8.0",
       ":14: contact: force_on = 6 N must be at most force_limit / 1.5 = 5.33333 N"},
      {"axes: [x, y, rz]", "axes: [x, y]",
       ":19: compliance.axes: lacks the search coordinate rz: a rigid axis feels no contact"},
      {"w1: 3", "w1: 0.9", ":20: search.w1 = 0.9, must be in [1, 1000]"},
      {"move_weight: 0", "move_weight: -1", ":20: search.move_weight = -1, must be in [0, 1e+09]"},
      {"high: 0.6", "high: 0.2",
       ":22: physics.friction.high = 0.2, must be in [0.3, 2]: low, nominal and high ascend"},
      {"oversize_m: 2.5e-4", "oversize_m: 0.02",
       ":24: physics.oversize_m = 0.02, must be in [0, 0.01]"},
      {"rollout_step_s: 0.002", "tilt_rad: 0.06",
       ":25: physics.tilt_rad = 0.06, must be in [0, 0.05]"},
      {"rollout_step_s: 0.002", "sensor_error_m: -0.001",
       ":25: physics.sensor_error_m = -0.001, must be in [0, 0.02]"},
      {"rollout_step_s: 0.002", "contact_give_mpN: 0.03",
       ":25: physics.contact_give_mpN = 0.03, must be in [0, 0.001]"},
      {"rollout_step_s: 0.002", "rollout_step_s: 0.006",
       ":25: physics.rollout_step_s = 0.006, must be in [0.0001, 0.005]"},
      {"coordinates: [x, rz]", "coordinates: [x, rz",
       ":3: is not YAML: end of sequence flow not found; here or above, a [...] is not closed, or "
       "has no comma between two of its entries"},
      {"physics:\n", "---\n", ": must hold one YAML document, holds 2 or more"},
  };
  expect_refusals(kTinyTask, lines,
                  [](const std::filesystem::path& file) { (void)load_task(file); });
}

TEST(LoadTask, RefusesFrictionThatLooksLikeContact) {
  const ScratchFolder folder;
  const auto file = folder.put("task.yaml", replaced(kTinyTask, "high: 0.6", "high: 1.2"));
  const std::string line = refusal([&] { (void)load_task(file); });
  EXPECT_TRUE(line.starts_with(file.string() + ":14: contact: force_on = 6 N must be at least"))
      << line;
}

TEST(LoadRobot, ReadsEveryValue) {
  const ScratchFolder folder;
  folder.put("slide.urdf", kSlideUrdf);
  const Robot robot = load_robot(folder.put("robot.yaml", kSlideRobot));
  EXPECT_EQ(robot.bitrate_bps, 500'000U);
  EXPECT_EQ(robot.cycle_us, 4000U);
  EXPECT_EQ(robot.heartbeat_timeout_ms, 300U);
  EXPECT_EQ(robot.master_node, 127);
  EXPECT_EQ(robot.targets_per_frame, 1);
  ASSERT_EQ(robot.joints.size(), 2U);
  // The chain's order, not the list's.
  EXPECT_EQ(robot.joints[0].name, "x");
  EXPECT_EQ(robot.joints[0].node, 1);
  EXPECT_EQ(robot.joints[0].counts_per_unit, -1e6);
  EXPECT_EQ(robot.joints[0].rated_effort, 200.0);
  EXPECT_EQ(robot.joints[0].stiffness, 1e6);
  EXPECT_EQ(robot.joints[1].name, "turn");
  EXPECT_EQ(robot.joints[1].node, 2);
  EXPECT_EQ(robot.joints[1].zero_counts, 100.0);
  EXPECT_EQ(robot.joints[1].acceleration_max, 10.0);
  EXPECT_EQ(robot.joints[1].following_error_max, 0.01);
  EXPECT_EQ(robot.joints[1].stiffness, 2e4);
  EXPECT_EQ(robot.sensor.torque_per_count_Nm, 0.0005);
  EXPECT_EQ(robot.response_lag_s, 0.008);
  EXPECT_EQ(robot.measurement_delay_cycles, 1);

  folder.put("packed.yaml",
             replaced(kSlideRobot, "master_node: 127", "master_node: 127, targets_per_frame: 2"));
  EXPECT_EQ(load_robot(folder.path() / "packed.yaml").targets_per_frame, 2);
}

TEST(LoadRobot, RefusesEachBadLineWithItsPlace) {
  const std::vector<BadLine> lines = {
      {"cycle_us: 4000", "cycle_us: 2500", ":3: bus.cycle_us = 2500, must be a multiple of 1000"},
      {"cycle_us: 4000", "cycle_us: 4e3",
       ":3: bus.cycle_us = 4e3, must be an integer in [1000, 20000]"},
      {"bitrate_bps: 500000", "bitrate_bps: 600000",
       ":3: bus.bitrate_bps = 600000, must be one of: 20000, 50000, 125000, 250000, 500000, "
       "800000, 1000000"},
      {"heartbeat_timeout_ms: 300", "heartbeat_timeout_ms: 100",
       ":3: bus.heartbeat_timeout_ms = 100, must be in [101, 65535]"},
      {"master_node: 127", "master_node: 127, targets_per_frame: 3",
       ":3: bus.targets_per_frame = 3, must be in [1, 2]"},
      {"node: 2", "node: 4", ":24: sensor.node = 4, must be a node that nothing else uses"},
      {"node: 4", "node: 128", ":24: sensor.node = 128, must be in [1, 127]"},
      {"master_node: 127", "master_node: 4",
       ":3: bus.master_node = 4, must be a node that nothing else uses"},
      {"mode: 8", "mode: 9", ":17: joints[1].mode = 9, must be one of: 7, 8"},
      {"  - name: x\n", "  -\n", ":16: joints[1]: the required key name is missing"},
      {"name: x", "name: z",
       ":15: joints[1].name = z, must be a revolute or prismatic joint of slide.urdf"},
      {"name: x", "name: screws",
       ":15: joints[1].name = screws, must be a revolute or prismatic joint of slide.urdf"},
      {"name: x", "name: turn", ":15: joints[1].name = turn, must be listed once"},
      {"    mode: 8\n", "    mode: 8\n    axis: [1, 0, 0]\n",
       ":18: joints[1].axis: is an unknown key, known here: name, node, drive, mode, zero_counts, "
       "counts_per_m, acceleration_max_mps2, rated_effort_N, following_error_max_m, stiffness_Npm"},
      {"counts_per_m: -1e6", "counts_per_m: 0",
       ":18: joints[1].counts_per_m = 0, must be other than 0"},
      {"stiffness_Nmpr: 2e4", "stiffness_Nmpr: 0",
       ":14: joints[0].stiffness_Nmpr = 0, must be in (0, 1e+09]"},
      {"force_range_N: 300", "force_range_N: 400",
       ":27: sensor.force_range_N = 400, must be in (0, 327.67]"},
      {"response_lag_s: 0.008", "response_lag_s: 0.0079",
       ":4: arm.response_lag_s = 0.0079, must be at least 0.008 s, the two cycles that the "
       "protocol takes"},
      {"urdf: slide.urdf\n", "", ":1: the required key urdf is missing"},
  };
  expect_refusals(kSlideRobot, lines,
                  [](const std::filesystem::path& file) { (void)load_robot(file); });
}

TEST(LoadRobot, NamesTheJointThatOnlyTheUrdfHas) {
  const ScratchFolder folder;
  folder.put("slide.urdf", kSlideUrdf);
  const std::string text = kSlideRobot;
  const std::size_t from = text.find("  - name: x");
  const auto file =
      folder.put("robot.yaml", text.substr(0, from) + text.substr(text.find("sensor:")));
  EXPECT_EQ(refusal([&] { (void)load_robot(file); }),
            file.string() + ":6: joints: lacks joint x of slide.urdf");
}

TEST(LoadCell, ReadsEveryValueAndTheRobotBesideIt) {
  const ScratchFolder folder;
  folder.put("robots/slide.yaml", kSlideRobot);
  folder.put("robots/slide.urdf", kSlideUrdf);
  const Cell cell = load_cell(folder.put("cell.yaml", kCell));
  EXPECT_EQ(cell.name, "bench");
  EXPECT_EQ(cell.robot.name, "slide");
  EXPECT_EQ(cell.up_B, Vector3::UnitZ());
  EXPECT_EQ(cell.X_BT.position_m, Vector3(0.1, 0.05, 0));
  EXPECT_EQ(cell.X_FP.position_m, Vector3(0, 0, -0.15));
  EXPECT_EQ(cell.payload_com_m, Vector3(0, 0, -0.1));
  EXPECT_EQ(cell.force_fault_N, 60.0);

  folder.put("hanging.yaml", replaced(kCell, "payload:", "up_in_base: [0, 0.6, -0.8]\npayload:"));
  EXPECT_TRUE(load_cell(folder.path() / "hanging.yaml").up_B.isApprox(Vector3(0, 0.6, -0.8)));

  EXPECT_FALSE(cell.sensor_bias);
  EXPECT_EQ(cell.contact_stiffness_Nmpr, 0.0);
  const Cell known = load_cell(folder.put(
      "known.yaml",
      replaced(
          kCell, "faults:",
          "contact_stiffness_Nmpr: 800\nsensor_bias: {force_N: [4, -2, 1], torque_Nm: [0.1, 0, "
          "-0.2], force_tolerance_N: 3, torque_tolerance_Nm: 0.5}\nfaults:")));
  EXPECT_EQ(known.contact_stiffness_Nmpr, 800.0);
  ASSERT_TRUE(known.sensor_bias);
  EXPECT_EQ(known.sensor_bias->wrench[1], -2.0);
  EXPECT_EQ(known.sensor_bias->wrench[5], -0.2);
  EXPECT_EQ(known.sensor_bias->force_tolerance_N, 3.0);
  EXPECT_EQ(known.sensor_bias->torque_tolerance_Nm, 0.5);
}

TEST(LoadCell, RefusesEachBadLineWithItsPlace) {
  const std::vector<BadLine> lines = {
      {"mass_kg: 0.5", "mass_kg: -0.5", ":6: payload.mass_kg = -0.5, must be in [0, 100]"},
      {"force_N: 60", "force_N: 301", ":8: faults.force_N = 301, must be in (0, 300]"},
      {"contact_stiffness_Npm: 5e4", "contact_stiffness_Npm: 2e6",
       ":7: contact_stiffness_Npm = 2e6, must be in [100, 1e+06]"},
      {"torque_Nm: 10", "torque_Nm: 0", ":8: faults.torque_Nm = 0, must be in (0, 15]"},
      {"faults:",
       "sensor_bias: {force_N: [0, 0, 0], torque_Nm: [0, 0, 0], force_tolerance_N: 0, "
       "torque_tolerance_Nm: 1}\nfaults:",
       ":8: sensor_bias.force_tolerance_N = 0, must be in (0, 300]"},
      {"payload:", "up_in_base: [0, 0, -0.9]\npayload:", ":6: up_in_base: must have length 1"},
  };
  expect_refusals(kCell, lines, [](const std::filesystem::path& file) { (void)load_cell(file); });
}

TEST(LoadCell, NamesTheRobotFileThatIsMissing) {
  const ScratchFolder folder;
  const auto file = folder.put("cell.yaml", kCell);
  EXPECT_EQ(refusal([&] { (void)load_cell(file); }),
            (folder.path() / "robots/slide.yaml").string() +
                ": cannot be read: No such file or directory");
}

}  // namespace
}  // namespace tenon

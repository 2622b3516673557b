#include "tests/support/rough_arm.h"

#include <gtest/gtest.h>

#include <fstream>
#include <iterator>

#include "executor/identification/identify_friction_motion.h"
#include "executor/loop/cycle_runner.h"
#include "hw/arm/canopen_arm.h"
#include "shared/config/load.h"
#include "sim/cell/lockstep/lockstep.h"
#include "sim/cell/lockstep/virtual_link.h"
#include "sim/cell/virtual_arm/virtual_cell.h"
#include "tests/support/places.h"
#include "tests/support/planned.h"
#include "tests/support/scratch_folder.h"

namespace tenon::tests {
namespace {

/// Something small to hold, and nothing near.
Task nothing_near() {
  Task task;
  task.name = "nothing near";
  task.held = {{"cube", Shape::Kind::kBox, {0.02, 0.02, 0.02}, {}}};
  task.environment = {
      {"far", Shape::Kind::kBox, {0.1, 0.1, 0.1}, {{0.0, 0.0, -50.0}, {1, 0, 0, 0}}}};
  task.starts = {{"start", {}, Vector6::Zero()}};
  return task;
}

JointVector bent(const Cell& cell) {
  JointVector joints{};
  if (cell.robot.joints.size() == 6) joints = {0.3, 0.6, -1.2, 0.4, 0.8, 0.2};
  return joints;
}

}  // namespace

std::string torque_cell_text(const std::string& name, const std::string& friction) {
  std::ifstream file(in_tree("hw/cells/" + name + ".yaml"));
  std::string text((std::istreambuf_iterator<char>(file)), {});
  const std::string up = "../robots";
  text.replace(text.find(up), up.size(), in_tree("hw/robots"));
  return text + "\njoint_torque: {" + (friction.empty() ? "" : "friction: " + friction) + "}\n";
}

Cell torque_cell(const std::string& name) {
  const ScratchFolder folder;
  return load_cell(folder.put("cell.yaml", torque_cell_text(name, "")));
}

sim::WorldDraw rough_world(double low, double high, std::uint64_t seed) {
  WorldRanges ranges;
  ranges.drive_friction = DriveFrictionRange{.share = {.low = low, .high = high}, .seed = seed};
  return sim::draw_world(ranges, box_task(), seed);
}

executor::FrictionIdentification identified(const Cell& cell, const sim::WorldDraw& world) {
  executor::IdentifyFrictionMotion motion(cell, {});
  sim::VirtualLink link({.bitrate_bps = cell.robot.bitrate_bps}, cell.robot.master_node);
  hw::CanopenArm arm(cell.robot, link.master());
  sim::VirtualCell::Options options;
  options.world = world;
  options.joints = bent(cell);
  sim::VirtualCell virtual_cell(cell, nothing_near(), options);
  executor::CycleRunner runner(arm, motion, nullptr, {});
  sim::Lockstep time(arm, virtual_cell, link,
                     {.cycle_ns = std::int64_t{1000} * cell.robot.cycle_us});
  EXPECT_TRUE(time.prepare());
  while (time.cycle(runner) && time.statistics().cycles < 400'000) {
  }
  EXPECT_EQ(motion.ending().reason, executor::EndReason::kMeasured)
      << executor::describe(motion.ending(), Plan{}, cell);
  return executor::identify_friction(cell.robot, motion.samples());
}

}  // namespace tenon::tests

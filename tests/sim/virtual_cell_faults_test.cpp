// Faults of devices and brakes in the whole virtual cell: what frames and truth show of them.

#include <gtest/gtest.h>

#include <algorithm>
#include <string>

#include "sim/cell/faults/fault_spec.h"
#include "sim/cell/virtual_arm/virtual_cell.h"
#include "tests/sim/literal_cell.h"
#include "tests/sim/six_axis_cell.h"
#include "tests/support/refusal.h"

namespace tenon::sim {
namespace {

VirtualCell::Options with(FaultKind kind, int node, double time_s, double value = 0.0) {
  Fault fault;
  fault.kind = kind;
  fault.node = static_cast<std::uint8_t>(node);
  fault.time_s = time_s;
  fault.value = value;
  VirtualCell::Options options;
  options.faults = {fault};
  return options;
}

bool tells(const Truth& truth, const std::string& what) {
  return std::any_of(truth.events.begin(), truth.events.end(),
                     [&](const TruthEvent& event) { return event.what == what; });
}

/// A task high above its table, so that there is room to fall.
Task high_task() {
  Task task = wall_task();
  task.starts[0].pose.position_m.z() = 0.3;
  return task;
}

// A fall of 0.1 s is 49 mm.
TEST(VirtualCellFaultsTest, AVerticalAxisWithoutItsBrakeDropsFreelyAndTheOthersStay) {
  LiteralCell bench(gantry_cell(), high_task(), with(FaultKind::kBrakeFailure, 3, 0.1));
  while (bench.now_ns < 100'000'000) bench.step();  // switched on at 1 ms
  const Truth before = bench.cell.truth();
  EXPECT_NEAR(before.drives[2].position, 0.45, 1e-6);
  while (bench.now_ns < 201'000'000) bench.step();
  const Truth truth = bench.cell.truth();
  const double fall_m = 0.5 * 9.80665 * 0.1 * 0.1;
  EXPECT_NEAR(before.drives[2].position - truth.drives[2].position, fall_m, 1e-3);
  EXPECT_NEAR(before.tool.position_m.z() - truth.tool.position_m.z(), fall_m, 1e-3);
  EXPECT_NEAR(truth.drives[0].position, before.drives[0].position, 1e-6);
  EXPECT_TRUE(truth.drives[2].brake_engaged) << "its output says so";
  EXPECT_TRUE(tells(truth, "fault brake-failure, node 3"));
  EXPECT_FALSE(bench.cell.at_standstill());
}

TEST(VirtualCellFaultsTest, AServoWithoutTorqueLetsItsAxisGoUntilItsBrakeCatchesIt) {
  LiteralCell bench(gantry_cell(), high_task(), with(FaultKind::kTorqueLoss, 3, 0.5));
  ASSERT_TRUE(bench.enable());
  ASSERT_LT(bench.now_ns, 500'000'000);
  const std::int32_t before = bench.position_counts[2];
  while (bench.now_ns < 490'000'000) bench.cycle();
  EXPECT_NEAR(bench.position_counts[2], before, 5);
  while (bench.now_ns < 1'000'000'000) bench.cycle();
  // A following error of 5 mm for 20 ms, a ramp that has no torque, then the brake.
  EXPECT_LT(bench.position_counts[2], before - 5'000);
  EXPECT_GT(bench.position_counts[2], before - 100'000);
  EXPECT_EQ(bench.status[2] & 0x4F, 0x08);
  EXPECT_TRUE(bench.cell.at_standstill());
}

TEST(VirtualCellFaultsTest, AnEncoderThatJumpsMovesNothingButItsReading) {
  LiteralCell bench(gantry_cell(), wall_task(), with(FaultKind::kEncoderJump, 1, 0.5, 0.0005));
  ASSERT_TRUE(bench.enable());
  const std::int32_t before = bench.position_counts[0];
  while (bench.now_ns < 490'000'000) bench.cycle();
  EXPECT_NEAR(bench.position_counts[0], before, 5);
  while (bench.now_ns < 510'000'000) bench.cycle();
  const Truth truth = bench.cell.truth();
  EXPECT_NEAR(bench.position_counts[0] - 1e6 * truth.drives[0].position, 500.0, 5.0);
}

TEST(VirtualCellFaultsTest, ANodeThatResetsBootsUpAnew) {
  LiteralCell bench(gantry_cell(), wall_task(), with(FaultKind::kNodeReset, 2, 0.1));
  while (bench.now_ns < 95'000'000) bench.step();
  const auto boots = [&] { return std::count(bench.log.begin(), bench.log.end(), "702#00"); };
  EXPECT_EQ(boots(), 1);
  while (bench.now_ns < 120'000'000) bench.step();
  EXPECT_EQ(boots(), 2);
}

TEST(VirtualCellFaultsTest, AStaleSensorRepeatsItsCounter) {
  LiteralCell bench(gantry_cell(), wall_task(), with(FaultKind::kStaleForce, 0, 0.5));
  ASSERT_TRUE(bench.enable());
  while (bench.now_ns < 510'000'000) bench.cycle();
  const int sample = bench.sample[0];
  const Vector6 wrench = bench.wrench;
  for (int i = 0; i < 5; ++i) bench.cycle();
  EXPECT_EQ(bench.sample[0], sample);
  EXPECT_EQ(bench.wrench, wrench);
}

TEST(VirtualCellFaultsTest, AFaultOfANodeThatDoesNotExistIsRefused) {
  EXPECT_EQ(tests::refusal([] {
              const VirtualCell cell(gantry_cell(), wall_task(),
                                     with(FaultKind::kBrakeFailure, 9, 0.0));
            }),
            "fault brake-failure: node 9 is neither a joint nor the sensor of robot gantry");
  EXPECT_EQ(tests::refusal([] {
              const VirtualCell cell(gantry_cell(), wall_task(), with(FaultKind::kDrop, 9, 0.0));
            }),
            "fault drop: node 9 is neither a joint, nor the sensor, nor the master of robot "
            "gantry; see its robot file");
}

// Joints 1 to 3 slide, 4 is the sensor, 127 the master.
TEST(VirtualCellFaultsTest, AFaultThatCanStrikeNothingIsRefused) {
  for (const auto& [spec, why] : {
           std::pair{"drop:node=77", "nor the master"},
           std::pair{"queue-full:node=77", "nor the master"},
           std::pair{"frozen-drive:node=4", "node 4 is the force/torque sensor"},
           std::pair{"brake-failure:node=4", "node 4 is the force/torque sensor"},
           std::pair{"stale-force:node=1", "node 1 is the joint"},
           std::pair{"encoder-jump:node=1,jump_rad=0.1", "slides; give jump_m"},
           std::pair{"drop:id=answers,node=127", "node 127 is the master"},
           std::pair{"drop:id=emcy,node=127", "node 127 is the master"},
           std::pair{"drop:id=sync,node=1", "node 1 sends no sync"},
           std::pair{"drop:id=rpdo,node=4", "there is no rpdo"},
       }) {
    VirtualCell::Options options;
    options.faults = {parse_fault(spec)};
    const std::string line =
        tests::refusal([&] { const VirtualCell cell(gantry_cell(), wall_task(), options); });
    EXPECT_NE(line.find(why), std::string::npos) << spec << ": " << line;
  }
  VirtualCell::Options turning;
  turning.faults = {parse_fault("encoder-jump:node=4,jump_m=0.1")};
  turning.joints = JointVector{0.3, -0.6, 1.1, -0.4, 0.9, 0.5, 0.0};
  const std::string line =
      tests::refusal([&] { const VirtualCell cell(six_axis_cell(), empty_task(), turning); });
  EXPECT_NE(line.find("turns; give jump_rad"), std::string::npos) << line;
}

TEST(VirtualCellFaultsTest, ASixAxisArmWhoseShoulderBrakeFailsFallsWithAllThatItCarries) {
  VirtualCell::Options options = with(FaultKind::kBrakeFailure, 4, 0.05);
  options.joints = JointVector{0.3, -0.6, 1.1, -0.4, 0.9, 0.5, 0.0};
  VirtualCell cell(six_axis_cell(), empty_task(), options);
  LiteralBus bus;
  for (std::int64_t now_ns = 0; now_ns <= 50'000'000; now_ns += 1'000'000) cell.step(now_ns, bus);
  const Truth before = cell.truth();
  for (std::int64_t now_ns = 51'000'000; now_ns <= 350'000'000; now_ns += 1'000'000) {
    cell.step(now_ns, bus);
  }
  const Truth after = cell.truth();
  EXPECT_LT(after.tool.position_m.z(), before.tool.position_m.z() - 0.1);
  EXPECT_GT(std::abs(after.drives[1].position - before.drives[1].position), 0.2);
  EXPECT_NEAR(after.drives[2].position, before.drives[2].position, 1e-5);
  EXPECT_EQ(after.solver_messages, 0U);
}

}  // namespace
}  // namespace tenon::sim

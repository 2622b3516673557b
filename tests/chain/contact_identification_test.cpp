// The identifications of tenon-exec, and what they are for, over CAN against the virtual arm: what
// they find against what the arm was made with.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <random>
#include <string>
#include <vector>

#include "executor/identification/identify_contact_motion.h"
#include "executor/identification/identify_payload_motion.h"
#include "executor/loop/cycle_runner.h"
#include "hw/arm/canopen_arm.h"
#include "shared/system/fan_out.h"
#include "sim/cell/lockstep/lockstep.h"
#include "sim/cell/lockstep/virtual_link.h"
#include "sim/cell/virtual_arm/virtual_cell.h"
#include "tests/support/planned.h"

namespace tenon::tests {
namespace {

constexpr std::int64_t kCyclesMax = 200'000;
constexpr double kRelaxation_s = 2e-3;

using executor::EndReason;

// Runs a motion to its end. @param arm_cell what the virtual arm really is
void run_motion(executor::IdentificationMotion& motion, const Cell& arm_cell, const Task& task,
                std::uint64_t seed, EndReason expected = EndReason::kMeasured) {
  const Robot& robot = arm_cell.robot;
  sim::VirtualLink link({.bitrate_bps = robot.bitrate_bps}, robot.master_node);
  hw::CanopenArm arm(robot, link.master());
  sim::VirtualCell::Options world;
  world.seed = seed;
  sim::VirtualCell virtual_cell(arm_cell, task, world);
  executor::CycleRunner runner(arm, motion, nullptr, {});
  sim::Lockstep time(arm, virtual_cell, link, {.cycle_ns = std::int64_t{1000} * robot.cycle_us});
  ASSERT_TRUE(time.prepare());
  std::int64_t cycles = 0;
  while (time.cycle(runner) && ++cycles < kCyclesMax) {
  }
  EXPECT_LT(cycles, kCyclesMax);
  EXPECT_EQ(motion.ending().reason, expected)
      << executor::describe(motion.ending(), Plan{}, arm_cell);
  EXPECT_TRUE(motion.ending().disable_confirmed);
}

// A small cube on air, a wall 4 mm in front of its +x face.
Task wall_before_x() {
  Task task;
  task.name = "wall";
  task.coordinates = 0x01;
  Shape wall{"wall", Shape::Kind::kBox, {0.1, 0.4, 0.4}, {}};
  wall.pose.position_m.x() = 0.02 + 0.004 + 0.05;
  task.held = {{"cube", Shape::Kind::kBox, {0.04, 0.04, 0.04}, {}}};
  task.environment = {wall};
  task.starts = {{"before the wall", {}, Vector6::Zero()}};
  return task;
}

struct Drawn {
  double stiffness_Npm = 0.0;
  double lag_s = 0.0;  ///< of the drives' protocol and of the servos
  executor::ContactIdentification found;
};

void identify(Drawn& drawn, std::uint64_t seed) {
  Cell cell = gantry_cell();
  executor::IdentifyContactMotion motion(cell, {});  // knows nothing of what was drawn
  cell.contact_stiffness_Npm = drawn.stiffness_Npm;
  cell.robot.response_lag_s = drawn.lag_s;
  for (Joint& joint : cell.robot.joints) joint.following_error_max = 0.02;
  run_motion(motion, cell, wall_before_x(), seed);
  EXPECT_TRUE(motion.met());
  drawn.found = executor::identify_contact(motion.samples(), 1e-6 * cell.robot.cycle_us);
}

void expect_found(int contacts) {
  std::mt19937_64 random(7);
  const auto uniform = [&](double low, double high) {
    return low + (high - low) * static_cast<double>(random() >> 11) * 0x1.0p-53;
  };
  const double protocol_s = 2e-6 * gantry_cell().robot.cycle_us;
  std::vector<Drawn> all;
  for (int i = 0; i < contacts; ++i) {
    all.push_back(
        {5e3 * std::pow(20.0, uniform(0.0, 1.0)), std::max(protocol_s, uniform(0.0, 0.020)), {}});
  }
  fan_out(all.size(), 2, [&](std::size_t i, std::size_t /*worker*/) { identify(all[i], i); });
  double worst_stiffness = 0.0;
  double worst_lag_s = 0.0;
  for (const Drawn& drawn : all) {
    ASSERT_EQ(drawn.found.status, executor::ContactIdentification::Status::kIdentified);
    const double stiffness = drawn.found.stiffness_Npm / drawn.stiffness_Npm - 1.0;
    // The virtual contact's damping answers two milliseconds early.
    const double lag_s = drawn.found.lag_s - (drawn.lag_s - kRelaxation_s);
    EXPECT_LT(std::abs(stiffness), 0.03) << drawn.stiffness_Npm << " N/m";
    EXPECT_LT(std::abs(lag_s), 1.2e-3) << drawn.stiffness_Npm << " N/m, " << drawn.lag_s << " s";
    worst_stiffness = std::max(worst_stiffness, std::abs(stiffness));
    worst_lag_s = std::max(worst_lag_s, std::abs(lag_s));
  }
  std::printf("%zu contacts: stiffness within %.1f %%, lag within %.2f ms\n", all.size(),
              100.0 * worst_stiffness, 1e3 * worst_lag_s);
}

TEST(ContactIdentification, FindsTheStiffnessAndTheLagThatTheVirtualArmWasMadeWith) {
  expect_found(6);
}

// Where a release needs it (label full).
TEST(ManyContactIdentifications, FindTheStiffnessAndTheLagThatTheVirtualArmWasMadeWith) {
  expect_found(24);
}

TEST(ContactIdentification, WhereNothingStandsItGoesBackAndSaysSo) {
  Task task = wall_before_x();
  task.environment.front().pose.position_m.x() += 0.2;
  executor::IdentifyContactMotion motion(gantry_cell(), {});
  run_motion(motion, gantry_cell(), task, 1, EndReason::kNothingMet);
  EXPECT_EQ(executor::describe(motion.ending(), Plan{}, gantry_cell()),
            "nothing was met within 0.05 m along +x");
  EXPECT_FALSE(motion.met());
  EXPECT_TRUE(motion.samples().empty());
}

TEST(PayloadIdentification, AGantrySeesTheWeightAloneAndSaysSo) {
  executor::IdentifyPayloadMotion motion(gantry_cell(), {});
  run_motion(motion, gantry_cell(), wall_before_x(), 1);
  const auto found = executor::identify_payload(motion.readings());
  EXPECT_EQ(found.status, executor::PayloadIdentification::Status::kNotTurned);
  EXPECT_NEAR(found.apparent_mass_kg, gantry_cell().payload_mass_kg, 0.01);
}

// --- six axes -----------------------------------------------------------------------------------

// Nothing but air, and the tool in the middle of it.
Task air_task() {
  Task task;
  task.name = "air";
  task.held = {{"cube", Shape::Kind::kBox, {0.04, 0.04, 0.04}, {}}};
  task.starts = {{"aloft", {}, Vector6::Zero()}};
  task.starts.front().pose.position_m = {0.0, 0.0, 0.15};
  return task;
}

Cell six_axis_cell(const std::string& name) {
  Cell cell = shipped_cell(name);
  cell.payload_mass_kg = 1.3;
  cell.payload_com_m = {0.012, -0.021, 0.094};
  cell.robot.sensor.force_noise_N = 0.2;
  return cell;
}

class SixAxisIdentification : public ::testing::TestWithParam<const char*> {};

TEST_P(SixAxisIdentification, ThePayloadIsFoundWithinAPercentAndAMillimetre) {
  const Cell cell = six_axis_cell(GetParam());
  Cell assumed = cell;  // what a cell file says before anybody has measured
  assumed.payload_mass_kg = 1.0;
  assumed.payload_com_m = {0.0, 0.0, 0.12};
  executor::IdentifyPayloadMotion motion(assumed, {});
  run_motion(motion, cell, air_task(), 1);
  const auto found = executor::identify_payload(motion.readings());
  ASSERT_EQ(found.status, executor::PayloadIdentification::Status::kIdentified)
      << executor::describe(found);
  EXPECT_NEAR(found.mass_kg, cell.payload_mass_kg, 0.01 * cell.payload_mass_kg);
  EXPECT_LT((found.com_m - cell.payload_com_m).norm(), 1e-3);
  std::printf("%s: mass off by %+.2f %%, centre by %.2f mm, residual %.3f N\n", GetParam(),
              100.0 * (found.mass_kg / cell.payload_mass_kg - 1.0),
              1e3 * (found.com_m - cell.payload_com_m).norm(), found.force_residual_N);
}

// Rests in many poses around the one in which it was tared.
class PoseTour : public executor::IdentificationMotion {
 public:
  static constexpr int kPoses = 100;
  explicit PoseTour(const Cell& cell) : IdentificationMotion(cell) {}
  double worst_N = 0.0;
  double turn_max_rad = 0.0;
  int poses = 0;

 private:
  static constexpr int kSamples = 50;
  static constexpr double kSettle_s = 0.3;
  static constexpr double kSpread_rad = 0.4;

  void begin() override {
    first_ = joints().position();
    upright_ = supervision().tool().orientation;
    go_on();
  }
  void go_on() {
    JointVector next = first_;
    for (std::size_t i = 0; i < cell().robot.joints.size(); ++i) {
      const Joint& joint = cell().robot.joints[i];
      const double share = static_cast<double>(random_() >> 11) * 0x1.0p-53;
      next[i] = std::clamp(first_[i] + kSpread_rad * (2.0 * share - 1.0), joint.lower + 0.1,
                           joint.upper - 0.1);
    }
    SpeedLimits quick;
    quick.contact_mps = 1.0;
    quick.contact_radps = 2.0;
    move_ = executor::JointMove(joints().position(), next, cell().robot, kinematics(), quick);
    since_s_ = 0.0;
    samples_ = 0;
    sum_.setZero();
  }
  Turn run(const ArmFeedback& /*feedback*/) override {
    since_s_ += cycle_s();
    if (const auto refused = joints().follow(move_.at(since_s_))) return *refused;
    if (since_s_ < move_.duration_s() + kSettle_s || !supervision().wrench_usable()) return {};
    sum_ += supervision().wrench();
    if (++samples_ < kSamples) return {};
    worst_N = std::max(worst_N, (sum_ / kSamples).head<3>().norm());
    turn_max_rad =
        std::max(turn_max_rad, upright_.angularDistance(supervision().tool().orientation));
    if (++poses == kPoses) return executor::Ending{.reason = EndReason::kMeasured};
    go_on();
    return {};
  }

  JointVector first_{};
  executor::JointMove move_;
  double since_s_ = 0.0;
  int samples_ = 0;
  Vector6 sum_ = Vector6::Zero();
  Eigen::Quaterniond upright_ = Eigen::Quaterniond::Identity();
  std::mt19937_64 random_{3};
};

TEST_P(SixAxisIdentification, AKnownPayloadLeavesLessThanThreeTenthsOfANewtonInAHundredPoses) {
  const Cell cell = six_axis_cell(GetParam());
  PoseTour tour(cell);
  run_motion(tour, cell, air_task(), 1);
  EXPECT_EQ(tour.poses, PoseTour::kPoses);
  EXPECT_GT(tour.turn_max_rad, 0.5);
  EXPECT_LT(tour.worst_N, 0.3);
  std::printf("%s: at most %.3f N of %.1f N weight, turned by up to %.2f rad\n", GetParam(),
              tour.worst_N, 9.80665 * cell.payload_mass_kg, tour.turn_max_rad);
}

std::string arm_name(const ::testing::TestParamInfo<const char*>& info) { return info.param; }

INSTANTIATE_TEST_SUITE_P(Arms, SixAxisIdentification, ::testing::Values("csp6"), arm_name);
INSTANTIATE_TEST_SUITE_P(Full, SixAxisIdentification, ::testing::Values("lwa4p"), arm_name);

}  // namespace
}  // namespace tenon::tests

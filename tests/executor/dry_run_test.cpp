// Plans gone through with an arm in mind: what fits, what is slowed, what is refused and by which
// numbers.

#include "executor/dry_run/dry_run.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "executor/dry_run/dry_run_report.h"
#include "executor/dry_run/slow_down.h"
#include "shared/base/text.h"
#include "shared/motion/motion_profile.h"
#include "tests/executor/bench.h"
#include "tests/support/hand_made.h"

namespace tenon::executor {
namespace {

const double kCos30 = std::sqrt(3.0) / 2.0;

// The only refusal of a plan and a cell.
std::string refusal(const Plan& plan, const Cell& cell) {
  const DryRun run = dry_run(plan, cell);
  EXPECT_EQ(run.refusals.size(), 1U);
  return run.refusals.empty() ? "" : run.refusals.front();
}

TEST(DryRun, AGantrysDemandIsWhatTheTurnedFramesMakeOfThePlansSpeed) {
  const DryRun run = dry_run(touch_and_slide_plan(), hand_made_cell());
  EXPECT_TRUE(run.refusals.empty());
  ASSERT_EQ(run.steps.size(), 2U);
  // +x at contact speed 0.05 m/s and 1 m/s^2, the task turned by 30 degrees; 0.5 m/s and 10 m/s^2
  // are the joints' own.
  EXPECT_EQ(run.steps[0].speed.joint, 0);
  EXPECT_NEAR(run.steps[0].speed.value, 0.05 * kCos30 / 0.5, 1e-9);
  EXPECT_NEAR(run.steps[0].acceleration.value, 1.0 * kCos30 / 10.0, 1e-9);
  EXPECT_NEAR(run.steps[0].conditioning, 1.0, 1e-9);
  EXPECT_EQ(run.steps[0].slow_down, 1.0);
  EXPECT_EQ(run.plan.parameter_sets, touch_and_slide_plan().parameter_sets);
}

TEST(DryRun, AJointThatIsTooSlowSlowsItsStepsAlone) {
  Cell cell = hand_made_cell();
  cell.robot.joints[1].speed_max = 0.03;
  const Plan plan = touch_and_slide_plan();
  const DryRun run = dry_run(plan, cell);
  EXPECT_TRUE(run.refusals.empty());
  // Step 0 asks joint y for 0.05 / 2 m/s, step 1 for 0.05 cos 30 m/s; 0.9 of 0.03 m/s is granted.
  const double factor = 0.9 * 0.03 / (0.05 * kCos30);
  EXPECT_EQ(run.steps[0].slow_down, 1.0);
  EXPECT_NEAR(run.steps[1].slow_down, factor, 1e-9);
  EXPECT_EQ(move_parameters(run.plan, 0).speeds, plan.parameter_sets[0].speeds);
  const MoveParameters slow = move_parameters(run.plan, 1);
  EXPECT_NEAR(slow.speeds.contact_mps, 0.05 * factor, 1e-9);
  EXPECT_NEAR(slow.speeds.acceleration_mps2, factor * factor, 1e-9);
  EXPECT_NEAR(slow.timeout_us, 10e6 / factor, 1.0);
  EXPECT_EQ(slow.thresholds, plan.parameter_sets[0].thresholds);
  EXPECT_EQ(
      slowed_steps(run, cell),
      "step 1 runs at 0.624 of its speed: joint y is asked for 0.0433 m/s, its limit is 0.03\n");
}

TEST(DryRun, AJointThatAcceleratesTooSlowlySlowsTheStepByTheRootOfIt) {
  Cell cell = hand_made_cell();
  cell.robot.joints[0].acceleration_max = 0.5;
  const DryRun run = dry_run(touch_and_slide_plan(), cell);
  EXPECT_TRUE(run.refusals.empty());
  EXPECT_NEAR(run.steps[0].slow_down, std::sqrt(0.9 * 0.5 / kCos30), 1e-9);
}

TEST(DryRun, AStepThatWouldHaveToCrawlIsRefusedWithItsNumbers) {
  Cell cell = hand_made_cell();
  cell.robot.joints[1].speed_max = 0.005;
  EXPECT_EQ(
      refusal(touch_and_slide_plan(), cell),
      "step 0: joint y is asked for 0.025 m/s, its limit is 0.005: the step would have to run "
      "at 0.18 of its speed, at least 0.2 is allowed");
}

TEST(DryRun, ASlowedProfileIsTheSameProfileInMoreTime) {
  ParameterSet set;
  const ParameterSet slow = slowed(set, 0.4);
  const auto profile = [](const SpeedLimits& v) {
    return MotionProfile(
        {0.3, 0.2, v.approach_mps, v.contact_mps, v.acceleration_mps2, v.jerk_mps3});
  };
  const MotionProfile before = profile(set.speeds);
  const MotionProfile after = profile(slow.speeds);
  for (int i = 0; i <= 20; ++i) {
    const double time_s = before.duration_s() * i / 20.0;
    EXPECT_NEAR(after.at(time_s / 0.4).position, before.at(time_s).position, 1e-9);
  }
  EXPECT_EQ(slow.timeout_us, 25'000'000U);
}

// Diagonal +x +y: a tool that leans on a wall in front of +x slides along +y alone.
TEST(DryRun, AHeldContactTurnsTheWayAndItsDemand) {
  Cell cell = hand_made_cell();
  cell.robot.joints[1].speed_max = 5.0;
  Plan plan = touch_and_slide_plan();
  plan.steps[1].displacement[0] = 0.04;
  const double diagonal = std::sqrt(0.5);
  for (const bool may_hold : {false, true}) {
    plan.steps[0].outcomes[1].envelope.possible.bits =
        may_hold ? ContactSignature::bit(0, -1) : std::uint16_t{0};
    const DryRun run = dry_run(plan, cell);
    ASSERT_EQ(run.steps.size(), 2U);
    EXPECT_EQ(run.steps[1].speed.joint, 0);
    EXPECT_NEAR(run.steps[1].speed.value, (may_hold ? 0.5 : diagonal * (kCos30 - 0.5)) * 0.05 / 0.5,
                1e-9);
  }
}

TEST(DryRun, ALongCommandThatIsSureToTouchNeedsNoReachBeyondItsEnvelope) {
  Plan plan = touch_and_slide_plan();
  plan.steps[0].displacement[0] = 5.0;
  EXPECT_TRUE(dry_run(plan, hand_made_cell()).refusals.empty());
  plan.check_envelopes = false;
  EXPECT_EQ(refusal(plan, hand_made_cell()).rfind("step 0: joint x would be at 4.", 0), 0U);
}

TEST(DryRun, AJointNeedsRoomToStopBeforeItsLimit) {
  Cell cell = hand_made_cell();
  cell.robot.joints[2].acceleration_max = 2.0;
  Plan plan = hand_made_plan();
  plan.parameter_sets[0].speeds.contact_mps = 0.2;
  plan.parameter_sets[0].speeds.acceleration_mps2 = 0.5;
  plan.steps.push_back(hand_made_step(2, 0.1, {{Outcome::kReached, kSuccessorDone}}));
  // z ends at 0.02 + 0.1 + 0.002 m. From 0.2 m/s it stops in v^2 / 2a + v t_j / 2 = 12 mm.
  cell.robot.joints[2].upper = 0.122 + 0.012 + 0.005 + 1e-4;
  EXPECT_TRUE(dry_run(plan, cell).refusals.empty());
  cell.robot.joints[2].upper -= 2e-4;
  EXPECT_EQ(
      refusal(plan, cell),
      "step 0: joint z would be at 0.1220 m and would stop 0.0120 m further, must be in [-0.5, "
      "0.1389] less 0.005 margin");
}

// A SCARA arm of two links of 0.3 m; elbow to the left is q2 > 0.
Cell scara_cell() {
  Cell cell = hand_made_cell();
  cell.X_BT = cell.X_FP = cell.X_FS = Pose{};
  cell.robot.joints.clear();
  const auto add = [&](Joint::Kind kind, double x_m, double low, double high) {
    Joint joint;
    joint.name = "arm_" + std::to_string(cell.robot.joints.size() + 1);
    joint.kind = kind;
    joint.origin.position_m.x() = x_m;
    joint.axis = Vector3::UnitZ();
    joint.lower = low;
    joint.upper = high;
    joint.speed_max = 2.0;
    joint.acceleration_max = 20.0;
    cell.robot.joints.push_back(joint);
  };
  add(Joint::Kind::kRevolute, 0.0, -2.0, 0.3);
  add(Joint::Kind::kRevolute, 0.3, -2.9, 2.9);
  add(Joint::Kind::kPrismatic, 0.3, -0.2, 0.2);
  add(Joint::Kind::kRevolute, 0.0, -6.0, 6.0);
  return cell;
}

//        (-0.35, -0.15) <---------- (0.35, -0.15): below the base, whose first joint has [-2, 0.3].
// The start fits with the elbow to the left alone, the end with the elbow to the right alone.
TEST(DryRun, AnEndThatOnlyAnotherBranchReachesIsRefused) {
  const Cell cell = scara_cell();
  Plan plan = hand_made_plan();
  plan.start.position_m = Vector3(0.35, -0.15, 0.0);
  plan.steps.push_back(hand_made_step(0, -0.7, {{Outcome::kReached, kSuccessorDone}}));
  const double reach_m = std::hypot(0.35, 0.15);
  const double bend_rad = std::acos(reach_m / 0.6);
  const double towards_end_rad = std::atan2(-0.15, -0.35);
  const JointVector right{towards_end_rad + bend_rad, -2.0 * bend_rad, 0.0,
                          -towards_end_rad + bend_rad};
  const SerialChain chain(cell.robot);
  ASSERT_LT((chain.flange(right).position_m - Vector3(-0.35, -0.15, 0.0)).norm(), 1e-9);
  ASSERT_GT(right[0], cell.robot.joints[0].lower + 0.1);

  const std::string line = refusal(plan, cell);
  EXPECT_EQ(line.rfind("step 0: joint arm_1 would be at -3.6", 0), 0U) << line;
  EXPECT_NE(line.find("must be in [-2, 0.3]"), std::string::npos) << line;
}

TEST(DryRun, ASixAxisArmStartsWhereThePlanDoes) {
  const Cell cell = hand_made_arm_cell();
  const DryRun run = dry_run(arm_plan(), cell);
  for (const std::string& line : run.refusals) ADD_FAILURE() << line;
  ASSERT_TRUE(run.start);
  const Pose tool =
      compose(compose(inverse(cell.X_BT), SerialChain(cell.robot).flange(*run.start)), cell.X_FP);
  EXPECT_LT(displacement_between(tool, arm_plan().start).norm(), 1e-8);
  for (const StepDemand& step : run.steps) {
    EXPECT_GT(step.conditioning, 0.1);
    EXPECT_GT(step.limit.value, 0.5);
  }
}

TEST(DryRun, AWayOverTheArmsOwnFirstAxisIsRefusedByAJoint) {
  Plan plan = arm_plan();
  plan.start.position_m = Vector3(-0.2, 0.002, 0.25);
  plan.steps.assign(1, hand_made_step(0, -0.4, {{Outcome::kReached, kSuccessorDone}}));
  const std::string line = refusal(plan, hand_made_arm_cell());
  EXPECT_EQ(line.rfind("step 0: ", 0), 0U) << line;
  EXPECT_NE(line.find("joint arm_"), std::string::npos) << line;
}

TEST(DryRun, APoseBeyondTheArmIsRefusedByItsStep) {
  Plan plan = arm_plan();
  plan.steps.assign(1, hand_made_step(0, 0.5, {{Outcome::kReached, kSuccessorDone}}));
  const std::string line = refusal(plan, hand_made_arm_cell());
  EXPECT_EQ(line.rfind("step 0: ", 0), 0U) << line;
  EXPECT_NE(line.find("out of continuous reach"), std::string::npos) << line;
}

TEST(DryRun, TheExecutedJointsStayWithinWhatItPromised) {
  Cell cell = hand_made_arm_cell();
  for (Joint& joint : cell.robot.joints) joint.speed_max = 0.12;  // slow enough to matter
  const DryRun run = dry_run(arm_plan(), cell);
  ASSERT_EQ(run.refusals, std::vector<std::string>{});
  EXPECT_LT(run.steps[0].slow_down, 0.9);
  Bench bench(arm_plan(), {}, cell, *run.start);
  bench.arm.walls.push_back({0, +1, 0.03});
  bench.run();
  ASSERT_EQ(bench.controller.ending().reason, EndReason::kPlanDone) << bench.ending();

  double share = 0.0;
  const auto& records = bench.keeper.records;
  for (std::size_t i = 1; i < records.size(); ++i) {
    if (!records[i].moving || records[i].phase != GuardedMove::Phase::kMoving) continue;
    for (std::size_t joint = 0; joint < 6; ++joint) {
      const double way =
          records[i].position_commanded[joint] - records[i - 1].position_commanded[joint];
      share = std::max(share, std::abs(way) / 2e-3 / 0.12);
    }
  }
  EXPECT_LT(share, 0.91);  // of the joint's own: the 0.9 that is granted
  EXPECT_GT(share, 0.80);  // and not slower than it has to be
}

TEST(DryRun, TheTableAndTheJsonTellTheSame) {
  const Cell cell = hand_made_cell();
  Plan plan = touch_and_slide_plan();
  const DryRun run = dry_run(plan, cell);
  const auto json = nlohmann::json::parse(to_json(run, plan, cell));
  EXPECT_EQ(json.at("status"), "accepted");
  ASSERT_EQ(json.at("steps").size(), 2U);
  EXPECT_EQ(json["steps"][1].at("speed_joint"), "y");
  EXPECT_EQ(json["steps"][1].at("slow_down"), 1.0);
  EXPECT_EQ(json.at("start_joints")[2].at("joint"), "z");
  const std::string table = to_table(run, cell);
  EXPECT_EQ(std::count(table.begin(), table.end(), '\n'), 4);
  EXPECT_NE(table.find("   8.7 %"), std::string::npos) << table;
  const std::string margin = format("%.4f m ", json["steps"][1]["limit_margin"].get<double>());
  EXPECT_NE(table.find(margin), std::string::npos) << table;
}

TEST(DryRun, AGantryCannotYieldInRotation) {
  Plan plan = touch_and_slide_plan();
  plan.compliance.compliant_axes = 0x27;
  EXPECT_EQ(refusal(plan, hand_made_cell()),
            "compliant axes x y z rz: the robot can move the tool along x y z only");
}

TEST(DryRun, ATurnedStartIsRefusedOnAGantry) {
  Plan plan = touch_and_slide_plan();
  plan.start.orientation = rotation_of(Vector3(0, 0, 0.2));
  EXPECT_EQ(
      refusal(plan, hand_made_cell()),
      "start 's1': the robot's tool is turned by 0.2 rad against it, and the robot moves only x "
      "y z");
}

TEST(DryRun, AStartBeyondAJointIsRefusedByThatJoint) {
  Plan plan = touch_and_slide_plan();
  plan.start.position_m.z() = 0.9;  // flange and base are 0.22 m below each other
  const std::string line = refusal(plan, hand_made_cell());
  EXPECT_EQ(line,
            "start 's1': joint z would be at 0.9200 m, must be in [-0.5, 0.5] less 0.005 margin");
}

// start 0 -> +z at most 0.3 -> +z at most 0.3: the second step leaves the range of joint z
TEST(DryRun, AStepWhoseEnvelopeLeavesTheRangeIsRefusedByItsNumber) {
  Plan plan = hand_made_plan();
  plan.steps.push_back(hand_made_step(2, 0.3, {{Outcome::kReached, Successor{1}}}));
  plan.steps.push_back(hand_made_step(2, 0.3, {{Outcome::kReached, kSuccessorDone}}));
  const std::string line = refusal(plan, hand_made_cell());
  EXPECT_EQ(line.rfind("step 1: joint z would be at 0.6", 0), 0U) << line;
  plan.steps[1].displacement[2] = -0.3;
  plan.steps[1].outcomes[0].envelope.travelled_min[2] = -0.302;
  plan.steps[1].outcomes[0].envelope.travelled_max[2] = 0.0;
  EXPECT_TRUE(dry_run(plan, hand_made_cell()).refusals.empty());
}

}  // namespace
}  // namespace tenon::executor

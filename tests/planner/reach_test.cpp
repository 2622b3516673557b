// What the arm of a cell cannot reach does not exist for the planner.

#include <gtest/gtest.h>

#include <array>
#include <optional>
#include <string>
#include <utility>

#include "executor/dry_run/cell_reach.h"
#include "executor/dry_run/dry_run.h"
#include "planner/belief/move_reach.h"
#include "tests/planner/room_plan.h"
#include "tests/support/hand_made.h"

namespace tenon::planner {
namespace {

// A gantry along the room's axes that serves a rectangle of it.
Cell gantry(double x_low_m, double x_high_m, double y_low_m, double y_high_m) {
  Cell cell = executor::hand_made_cell();
  cell.X_BT = {};
  cell.X_FP = {};
  cell.robot.joints[0].lower = x_low_m;
  cell.robot.joints[0].upper = x_high_m;
  cell.robot.joints[1].lower = y_low_m;
  cell.robot.joints[1].upper = y_high_m;
  return cell;
}

// All of the room and what of it may lie elsewhere; and each of its walls out of reach.
constexpr double kFar_m = 2.0;
Cell whole_room() { return gantry(-kFar_m, kFar_m, -kFar_m, kFar_m); }
std::array<Cell, 4> short_of_a_wall() {
  return {gantry(-0.45, kFar_m, -kFar_m, kFar_m), gantry(-kFar_m, 0.45, -kFar_m, kFar_m),
          gantry(-kFar_m, kFar_m, -0.35, kFar_m), gantry(-kFar_m, kFar_m, -kFar_m, 0.35)};
}

PlanReport planned_for(const Cell& cell, const Task& task) {
  const executor::CellReach reach(cell);
  PlannerOptions options;
  options.reach = &reach;
  return planned(task, room(), options);
}

TEST(Reach, APlanForACellKeepsAwayFromTheWallThatItsArmCannotReach) {
  for (const Task& task : {room_task(), own_room_task()}) {
    const PlanReport anywhere = planned(task);
    ASSERT_EQ(anywhere.status, PlanStatus::kPlanned) << anywhere.reason;
    int refused = 0;
    for (const Cell& cell : short_of_a_wall()) {
      refused += executor::dry_run(*anywhere.plan, cell).refusals.empty() ? 0 : 1;
      const PlanReport report = planned_for(cell, task);
      ASSERT_EQ(report.status, PlanStatus::kPlanned) << report.reason;
      for (const std::string& refusal : executor::dry_run(*report.plan, cell).refusals) {
        ADD_FAILURE() << refusal;
      }
    }
    EXPECT_GT(refused, 0);  // who does not ask the arm touches one of them
  }
}

TEST(Reach, AnArmThatReachesEverythingChangesNoByte) {
  for (const Task& task : {room_task(), own_room_task()}) {
    const PlanReport anywhere = planned(task);
    ASSERT_EQ(anywhere.status, PlanStatus::kPlanned) << anywhere.reason;
    EXPECT_EQ(planned_for(whole_room(), task).bytes, anywhere.bytes);
  }
}

TEST(Reach, AStartOrGoalThatTheArmCannotHoldIsSaidWithItsNumbers) {
  const PlanReport start = planned_for(gantry(-0.2, 1.0, -1.0, 1.0), room_task());
  EXPECT_EQ(start.status, PlanStatus::kOutOfReach);
  EXPECT_EQ(start.reason,
            "the arm cannot hold start 'a': joint x would be at -0.2300 m, must be in [-0.2, 1] "
            "less 0.005 margin");
  const PlanReport goal = planned_for(gantry(-1.0, 0.1, -1.0, 1.0), room_task());
  EXPECT_EQ(goal.status, PlanStatus::kOutOfReach);
  EXPECT_EQ(goal.reason,
            "the arm cannot hold the goal: joint x would be at 0.1700 m, must be in [-1, 0.1] "
            "less 0.005 margin");
}

TEST(Reach, WhereNoWallIsInReachTheReasonSaysWhichPushLacksHowMuch) {
  const PlanReport report = planned_for(gantry(-0.45, 0.45, -0.35, 0.35), room_task());
  EXPECT_NE(report.status, PlanStatus::kPlanned);
  EXPECT_NE(report.reason.find("out of the arm's reach, the first that would touch: joint "),
            std::string::npos)
      << report.reason;
  EXPECT_NE(report.reason.find("less 0.005 margin"), std::string::npos) << report.reason;
}

// Reaches everything, and keeps what it is asked for.
class AskedPlace final : public ArmPlace {
 public:
  std::shared_ptr<const ArmPlace> after(const Step& step, ContactSignature /*contacts*/,
                                        std::string& /*why*/) const override {
    asked = step;
    return std::make_shared<AskedPlace>();
  }
  std::shared_ptr<const ArmPlace> elsewhere(const Pose& /*tool*/,
                                            std::string& /*why*/) const override {
    return std::make_shared<AskedPlace>();
  }
  mutable Step asked;
};

TEST(MoveReach, AsksForTheDrawsBeyondTheParticlesButForNoneThatGoesFartherThanItIsTold) {
  const auto place = std::make_shared<AskedPlace>();
  MoveReach::Parameters parameters;
  parameters.margins.head<2>().setConstant(0.001);
  parameters.draws_over_particles = 1.5;
  MoveReach reach(place, parameters);

  // Particles met a wall after 0.10 to 0.18 m of 0.19, and slid by 4 mm: draws meet it after 0.08,
  // or are through.
  MoveReach::Travel travel;
  travel.way.least.head<2>() << 0.10, -0.002;
  travel.way.most.head<2>() << 0.18, 0.002;
  travel.place.least.head<2>() << 0.30, 0.10;
  travel.place.most.head<2>() << 0.32, 0.10;
  ASSERT_TRUE(reach.after(*place, 0.19 * Vector6::Unit(0), {}, travel, true));
  const Envelope& asked = place->asked.rule(Outcome::kReached).envelope;
  EXPECT_NEAR(asked.travelled_min[0], 0.08 - 0.001, 1e-12);
  EXPECT_NEAR(asked.travelled_max[0], 0.19 + 0.001, 1e-12);
  EXPECT_NEAR(asked.travelled_min[1], -0.003 - 0.001, 1e-12);
  EXPECT_NEAR(asked.travelled_max[1], 0.003 + 0.001, 1e-12);
  EXPECT_EQ(asked.travelled_max[2], 0.0);
  EXPECT_NEAR(asked.place_min[0], 0.295 - 0.001, 1e-12);
  EXPECT_NEAR(asked.place_max[0], 0.325 + 0.001, 1e-12);
  EXPECT_NEAR(asked.place_max[1], 0.10 + 0.001, 1e-12);
  EXPECT_TRUE(reach.refused_text().empty());
}

}  // namespace
}  // namespace tenon::planner

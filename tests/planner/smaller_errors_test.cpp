// Why a start has no plan: its errors, or something that smaller ones would not mend.

#include "planner/smaller_errors.h"

#include <gtest/gtest.h>

#include "tests/planner/room_plan.h"

namespace tenon::planner {
namespace {

/// What follows the reason that there is no plan, in a world whose y nothing settles.
std::string said_of(const Task& task, PlannerOptions options = {}) {
  WallRollout::World along_x;
  along_x.low_m.x() = -0.5;
  const WallRollout rollout(along_x);
  options.expansions_max = 100;
  const Start& start = task.starts.front();
  const PlanReport failed = make_plan(task, start, rollout, options, stopped_clock);
  EXPECT_NE(failed.status, PlanStatus::kPlanned);
  return smaller_errors_text(failed, task, start, rollout, options, stopped_clock);
}

//       -y |<- 1 mm ->| goal, half of its tolerance
// 3/4 ....... 1.2 mm  .
// 1/2 ........  0.8 mm .
Task known_to_0_8_mm_along_y() {
  Task task = room_task();
  task.starts.front().sigma.head<2>() << 0.01, 0.0008;  // particles sit two of them out
  return task;
}

TEST(SmallerErrors, OfWhichThereIsAPlanAreNamedAndTheNextThatHaveNone) {
  EXPECT_EQ(
      said_of(known_to_0_8_mm_along_y()),
      "; with half of its errors (sigma_m: [0.005, 0.0004]) it has a plan, with three quarters "
      "none was found");
}

TEST(SmallerErrors, ThatWouldNotHelpAreSaidNotTo) {
  Task task = known_to_0_8_mm_along_y();
  task.starts.front().sigma[1] = 0.1;
  EXPECT_EQ(said_of(task),
            "; nor was one found with a quarter of its errors (sigma_m: [0.0025, 0.025])");
}

TEST(SmallerErrors, AreNotAskedOfBaselinesNorOfAStartThatHasNone) {
  Task task = known_to_0_8_mm_along_y();
  PlanReport failed;
  failed.status = PlanStatus::kExhausted;
  PlannerOptions options;
  const WallRollout rollout(room());
  const auto text = [&] {
    return smaller_errors_text(failed, task, task.starts.front(), rollout, options, stopped_clock);
  };
  EXPECT_NE(text(), "");
  failed.status = PlanStatus::kOutOfReach;
  EXPECT_EQ(text(), "");
  failed.status = PlanStatus::kExhausted;
  options.method = PlanMethod::kContactGreedy;
  EXPECT_EQ(text(), "");
  options.method = PlanMethod::kMha;
  task.starts.front().sigma.setZero();
  EXPECT_EQ(text(), "");
}

// Half of the moves that planning was allowed: too few here for even one look.
TEST(SmallerErrors, TakeAtMostHalfOfTheAllowedMoves) {
  PlannerOptions options;
  options.moves_max = 40;
  EXPECT_NE(said_of(known_to_0_8_mm_along_y(), options).find("nor was one found"),
            std::string::npos);
}

}  // namespace
}  // namespace tenon::planner

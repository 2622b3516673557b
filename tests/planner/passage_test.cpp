// Where a plan places a part before it goes in.

#include "planner/judge/passage.h"

#include <gtest/gtest.h>

#include <vector>

#include "planner/judge/plan_draft.h"
#include "tests/planner/room_task.h"

namespace tenon::planner {
namespace {

constexpr double kPlay_m = 1e-3;  // to either side

class Passage : public ::testing::Test {
 protected:
  /// By how much, where the usual and the extreme starts stand so far aside of what the plan, over
  /// the slot and in, goes by.
  [[nodiscard]] Vector6 shifted(const std::vector<double>& usual_m,
                                const std::vector<double>& extreme_m) {
    const RunStarts run = [this](const Plan& plan, std::span<const JudgedStart> some,
                                 const std::function<bool(const Draw&)>& until) {
      ++runs;
      return run_starts(plan, task, some, pool, until);
    };
    const Plan plan = draft_plan(task, task.starts.front(), {}, displacements);
    // What the search has seen goes through the middle.
    const std::vector<Draw> known = run_starts(plan, task, aside({middle_m}), pool);
    EXPECT_EQ(arrived(known), 1U);
    const PassageStarts starts{aside(usual_m), aside(extreme_m)};
    const auto centred =
        with_passage_centred(plan, good_chains(known), task, starts, pool.front(), run);
    if (!centred) return Vector6::Zero();
    EXPECT_EQ(centred->steps.back().displacement, plan.steps.back().displacement);
    return centred->steps.front().displacement - plan.steps.front().displacement;
  }
  [[nodiscard]] Vector6 shifted(const std::vector<double>& aside_m) {
    return shifted(aside_m, aside_m);
  }

  [[nodiscard]] static std::vector<JudgedStart> aside(const std::vector<double>& aside_m) {
    std::vector<JudgedStart> starts;
    for (const double x_m : aside_m) {
      JudgedStart start;
      start.particle.pose.position_m = {-0.2 + x_m, -0.2, 0.0};
      starts.push_back(start);
    }
    return starts;
  }

  [[nodiscard]] static WallRollout::World slot() {
    WallRollout::World world = room();
    world.mouth_y_m = 0.1;
    world.slot_from_x_m = -kPlay_m;
    world.slot_to_x_m = kPlay_m;
    return world;
  }
  [[nodiscard]] static Task into_the_slot() {
    Task task = room_task();
    task.goal.position_m = {0.0, 0.2, 0.0};
    task.goal_tolerance_m = 2.0 * kPlay_m;
    return task;
  }

  const Task task = into_the_slot();
  std::vector<Vector6> displacements = {Vector6::Unit(0) * 0.2, Vector6::Unit(1) * 0.4};
  RolloutPool pool{WallRollout(slot()), 1};
  double middle_m = 0.0;  ///< of what the search has seen
  int runs = 0;
};

TEST_F(Passage, TakesThoseFarthestToEitherSideThroughTheMiddle) {
  const Vector6 by = shifted({0.0, 0.0, 0.0, 0.8 * kPlay_m});
  EXPECT_NEAR(by[0], -0.4 * kPlay_m, 0.1 * kPlay_m);
  EXPECT_EQ(by.tail<5>(), Vector6::Zero().tail<5>());
  EXPECT_NEAR(shifted({-0.9 * kPlay_m, 0.3 * kPlay_m})[0], 0.3 * kPlay_m, 0.1 * kPlay_m);
}

TEST_F(Passage, StaysWhereTheMiddleIs) {
  EXPECT_EQ(shifted({-0.5 * kPlay_m, 0.0, 0.5 * kPlay_m}), Vector6::Zero());
  EXPECT_GT(runs, 10);
}

// One that misses as it is says nothing of the others' middle; certification says that it misses.
TEST_F(Passage, GoesByThoseThatArrive) {
  EXPECT_NEAR(shifted({0.0, 0.8 * kPlay_m, 5.0 * kPlay_m})[0], -0.4 * kPlay_m, 0.1 * kPlay_m);
}

TEST_F(Passage, IsTheUsualOnesMiddleAsFarAsTheExtremeOnesBearIt) {
  // These bear shifts by -1 to 0.6 mm.
  const std::vector<double> extreme = {0.0, 0.4 * kPlay_m};
  EXPECT_NEAR(shifted({-0.5 * kPlay_m, 0.2 * kPlay_m}, extreme)[0], 0.15 * kPlay_m, 0.1 * kPlay_m);
  EXPECT_NEAR(shifted({-0.9 * kPlay_m, -0.8 * kPlay_m}, extreme)[0], 0.52 * kPlay_m, 0.1 * kPlay_m);
}

// What is shifted inside the slot pushes against its walls.
TEST_F(Passage, IsTheLastPlaceThatIsFreeToEitherSide) {
  displacements = {Vector6::Unit(0) * 0.2, Vector6::Unit(1) * 0.35, Vector6::Unit(1) * 0.05};
  EXPECT_NEAR(shifted({0.0, 0.8 * kPlay_m})[0], -0.4 * kPlay_m, 0.1 * kPlay_m);
}

TEST_F(Passage, OfAPlanWithoutAPlaceBeforeItsLastMoveIsNone) {
  displacements = {Vector6::Unit(1) * 0.4};
  middle_m = 0.2;
  EXPECT_EQ(shifted({0.2, 0.2 + 0.8 * kPlay_m}), Vector6::Zero());
  EXPECT_EQ(runs, 0);
}

}  // namespace
}  // namespace tenon::planner

// Where a plan places a part before it goes in.

#include "planner/judge/passage.h"

#include <gtest/gtest.h>

#include <memory>
#include <vector>

#include "planner/judge/plan_draft.h"
#include "tests/planner/room_task.h"

namespace tenon::planner {
namespace {

constexpr double kPlay_m = 1e-3;  // to either side

/// Walls that turn with their environment, for a tool that has turned with them as much and whose
/// moves go along its own axes.
class TurnedRollout final : public Rollout {
 public:
  explicit TurnedRollout(const WallRollout::World& world) : world_(world), walls_(world) {}

  [[nodiscard]] RolloutResult simulate(const Particle& particle, const MoveParameters& move,
                                       std::int64_t step_us,
                                       std::vector<TraceSample>* trace) override {
    Particle level = particle;
    level.pose = particle.tool();
    level.environment = {};
    RolloutResult result = walls_.simulate(level, move, step_us, trace);
    result.move.pose = seen_as(particle.environment, result.move.pose);
    return result;
  }
  [[nodiscard]] bool in_collision(const Pose& tool) override { return walls_.in_collision(tool); }
  [[nodiscard]] std::unique_ptr<Rollout> clone() const override {
    return std::make_unique<TurnedRollout>(world_);
  }

 private:
  WallRollout::World world_;
  WallRollout walls_;
};

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

  [[nodiscard]] std::vector<JudgedStart> aside(const std::vector<double>& aside_m) const {
    std::vector<JudgedStart> starts;
    for (const double x_m : aside_m) {
      JudgedStart start;
      const double turn_rad = turn_each_rad * static_cast<double>(starts.size());
      start.particle.environment.orientation = rotation_of(turn_rad * Vector3::UnitZ());
      Pose seen;
      seen.position_m = {-0.2 + x_m, -0.2, 0.0};
      start.particle.pose = seen_as(start.particle.environment, seen);
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

  Task task = into_the_slot();
  std::vector<Vector6> displacements = {Vector6::Unit(0) * 0.2, Vector6::Unit(1) * 0.4};
  RolloutPool pool{TurnedRollout(slot()), 1};
  double middle_m = 0.0;       ///< of what the search has seen
  double turn_each_rad = 0.0;  ///< start by start, of the slot, and of the tool with it
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

// Each goes its own way in; the farthest is farthest across that.
TEST_F(Passage, IsAcrossTheWayOfMovesThatTurnWithTheTool) {
  task.coordinates |= 1U << 5;
  task.motion.carried_axes = true;
  turn_each_rad = 0.1;
  std::vector<double> aside_m(12, 0.0);
  aside_m[5] = 0.8 * kPlay_m;
  const Vector6 by = shifted(aside_m);
  EXPECT_NEAR(by[0], -0.4 * kPlay_m, 0.1 * kPlay_m);
  EXPECT_EQ(by.tail<5>(), Vector6::Zero().tail<5>());
}

TEST_F(Passage, WithoutStartsOfItsOwnIsThatOfTheKnownChains) {
  middle_m = 0.8 * kPlay_m;
  EXPECT_NEAR(shifted({})[0], -0.8 * kPlay_m, 0.1 * kPlay_m);
}

TEST_F(Passage, OfAPlanWithoutAPlaceBeforeItsLastMoveIsNone) {
  displacements = {Vector6::Unit(1) * 0.4};
  middle_m = 0.2;
  EXPECT_EQ(shifted({0.2, 0.2 + 0.8 * kPlay_m}), Vector6::Zero());
  EXPECT_EQ(runs, 0);
}

}  // namespace
}  // namespace tenon::planner

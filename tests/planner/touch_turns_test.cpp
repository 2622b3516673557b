// Faces that are touched one after the other settle rotations, too: a press against a flat one
// several axes at once.

#include "planner/search/touch_turns.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "planner/belief/corners.h"
#include "planner/belief/rollout_pool.h"
#include "planner/planner.h"
#include "planner/search/attractors.h"
#include "planner/search/guide_way.h"
#include "planner/search/placing.h"
#include "planner/search_moves.h"
#include "tests/planner/room_task.h"

namespace tenon::planner {
namespace {

constexpr double kTop_m = 0.0;
constexpr double kHeight_m = 0.04;

/// A kinematic double: a point with a direction, and a block whose top is at z = 0. The point stops
/// at a side, and whatever turns it about axes along that side is gone then.
class BlockRollout final : public Rollout {
 public:
  /// What a wall leaves of a turn about z: of a round part all.
  enum class Yaw : std::uint8_t { kSettled, kLeft };
  /// Along x a part that is pressed slides off the block, as off a round one.
  enum class Along : std::uint8_t { kHolds, kSlidesOff };

  explicit BlockRollout(double half_m, Yaw yaw = Yaw::kSettled, Along x = Along::kHolds)
      : low_m_(-half_m, -half_m, kTop_m - kHeight_m),
        high_m_(half_m, half_m, kTop_m),
        yaw_(yaw),
        x_(x) {}

  [[nodiscard]] RolloutResult simulate(const Particle& particle, const MoveParameters& move,
                                       std::int64_t /*step_us*/,
                                       std::vector<TraceSample>* /*trace*/) override {
    const Pose from = particle.tool();
    const Vector3 way_m = from.orientation * move.displacement.head<3>();
    RolloutResult result;
    result.valid = true;
    result.move.outcome = Outcome::kReached;
    Pose to = from;
    int face = -1;
    double part = 1.0;
    for (int axis = 0; axis < 3; ++axis) {
      if (way_m[axis] == 0.0) continue;
      const double side_m = way_m[axis] > 0.0 ? low_m_[axis] : high_m_[axis];
      const double at = (side_m - from.position_m[axis]) / way_m[axis];
      if (at >= 0.0 && at < part && beside(from.position_m + at * way_m, axis)) {
        part = at;
        face = axis;
      }
    }
    if (face == 0 && x_ == Along::kSlidesOff && move.aligns) face = -1;
    to.position_m += (face >= 0 ? part : 1.0) * way_m;
    if (face >= 0) {
      const Vector3 turn_rad = rotation_vector(from.orientation);
      Vector3 left_rad = turn_rad[face] * Vector3::Unit(face);
      if (yaw_ == Yaw::kLeft) left_rad.z() = turn_rad.z();
      if (!move.aligns) left_rad = turn_rad;
      to.orientation = rotation_of(left_rad);
      result.move.outcome = Outcome::kContact;
      result.move.signature.bits = ContactSignature::bit(face, way_m[face] > 0.0 ? -1 : 1);
    }
    result.move.pose = seen_as(particle.environment, to);
    result.move.travelled = displacement_between(particle.pose, result.move.pose);
    return result;
  }
  [[nodiscard]] bool in_collision(const Pose& tool) override {
    const auto p = tool.position_m.array();
    return (p > low_m_.array()).all() && (p < high_m_.array()).all();
  }
  [[nodiscard]] std::unique_ptr<Rollout> clone() const override {
    return std::make_unique<BlockRollout>(high_m_.x(), yaw_, x_);
  }

 private:
  /// Within the side across an axis.
  [[nodiscard]] bool beside(const Vector3& at_m, int axis) const {
    for (int other = 0; other < 3; ++other) {
      if (other != axis && (at_m[other] < low_m_[other] || at_m[other] > high_m_[other])) {
        return false;
      }
    }
    return true;
  }

  Vector3 low_m_;
  Vector3 high_m_;
  Yaw yaw_;
  Along x_;
};

Task block_task(double half_m) {
  Task task = room_task();
  task.coordinates = 0b111111;
  task.compliance.compliant_axes = 0b111111;
  task.motion.carried_axes = true;
  task.motion.timeout_us = 60'000'000;
  task.errors = Distribution::kUniform;
  task.particle_sigmas = std::sqrt(3.0);
  Start& start = task.starts.front();
  start.pose.position_m = {0.0, 0.0, 0.06};
  start.sigma.head<3>().setConstant(2e-3 / task.particle_sigmas);
  start.sigma.tail<3>().setConstant(0.05 / task.particle_sigmas);
  task.goal.position_m = {0.0, 0.0, 1e-3};
  task.environment = {{"block",
                       Shape::Kind::kBox,
                       {2.0 * half_m, 2.0 * half_m, kHeight_m},
                       {{0.0, 0.0, kTop_m - 0.5 * kHeight_m}, {1, 0, 0, 0}}}};
  task.held = {{"point", Shape::Kind::kBox, {4e-3, 4e-3, 4e-3}, {{0, 0, 2e-3}, {1, 0, 0, 0}}}};
  derive_moves(task);
  return task;
}

struct Turns {
  explicit Turns(double half_m) : Turns(block_task(half_m), BlockRollout(half_m)) {}

  Turns(Task what, const BlockRollout& rollout)
      : task(std::move(what)),
        start(task.starts.front()),
        pool(rollout, 1),
        succ(pool, search_move(task, start, {}), task.rollout_step_us) {}

  [[nodiscard]] std::vector<Guide> find() {
    return TouchTurns(task, corner_belief(task, start), start.pose, succ, pool.front(), {}).find();
  }

  Task task;
  Start start;
  RolloutPool pool;
  SuccessorEngine succ;
};

TEST(TouchTurns, PressFlatAndThenAgainstTheWalls) {
  Turns turns(0.04);
  const std::vector<Guide> guides = turns.find();
  ASSERT_FALSE(guides.empty());
  const std::vector<ContactAttractor>& contacts = guides.front().contacts;
  // The top, and two walls: one of them tells the yaw, too.
  ASSERT_EQ(contacts.size(), 3U);
  CoordinateMask settled = 0;
  for (const ContactAttractor& contact : contacts) {
    settled |= static_cast<CoordinateMask>(1U << contact.axis | contact.flat);
    EXPECT_TRUE(contact.via.has_value());
    EXPECT_LT(contact.spread, 1e-6);
  }
  EXPECT_EQ(settled, 0b111111);
}

TEST(TouchTurns, FollowedToTheLetterLeadToTheGoal) {
  Turns turns(0.04);
  const std::vector<Guide> guides = turns.find();
  ASSERT_FALSE(guides.empty());
  const Belief start = corner_belief(turns.task, turns.start);
  const auto way = follow_guide(guides.front(), turns.task, start, turns.start.pose, turns.succ,
                                turns.pool.front());
  ASSERT_TRUE(way);
  // Every particle by itself, outside of what was tested.
  for (Particle particle : start.particles) {
    for (const Vector6& displacement : way->moves) {
      MoveParameters move;
      move.displacement = displacement;
      const RolloutResult result = turns.pool.front().simulate(particle, move, 2000, nullptr);
      particle.pose = result.move.pose;
      particle.signature = result.move.signature;
    }
    const Vector6 off = displacement_between(turns.task.goal, particle.tool());
    EXPECT_LT(off.head<3>().norm(), 0.1e-3);
    EXPECT_LT(off.tail<3>().norm(), 1e-3);
  }
}

// A wall away from the goal tells where a part is there; what it leaves across grows with the yaw,
// and none of that is left at the goal.
TEST(TouchTurns, OfAPartWhoseYawNothingSettlesAreWorthWhatTheyTellAtTheGoal) {
  constexpr double kHalf_m = 0.15;
  Task task = block_task(kHalf_m);
  task.goal_axes.free = 0b100000;
  for (const int known : {2, 3, 4}) task.starts.front().sigma[known] = 0.0;
  Turns turns(task, BlockRollout(kHalf_m, BlockRollout::Yaw::kLeft));
  const std::vector<Guide> guides = turns.find();
  ASSERT_FALSE(guides.empty());
  ASSERT_EQ(guides.front().contacts.size(), 2U);
  EXPECT_LE(guides.front().contacts.back().uncertainty_m2, turns.task.goal_uncertainty_m2);
  const Belief start = corner_belief(turns.task, turns.start);
  EXPECT_TRUE(follow_guide(guides.front(), turns.task, start, turns.start.pose, turns.succ,
                           turns.pool.front()));
}

// Nothing that is pressed holds along x: there the part is touched and held as it was met, and a
// press against another wall settles the rotations.
TEST(TouchTurns, ArePlainWhereAPressSlidesOff) {
  constexpr double kHalf_m = 0.04;
  Turns turns(block_task(kHalf_m),
              BlockRollout(kHalf_m, BlockRollout::Yaw::kSettled, BlockRollout::Along::kSlidesOff));
  const std::vector<Guide> guides = turns.find();
  ASSERT_FALSE(guides.empty());
  CoordinateMask touched = 0;
  for (const ContactAttractor& contact : guides.front().contacts) {
    touched |= static_cast<CoordinateMask>(1U << contact.axis);
    EXPECT_EQ(contact.plain, contact.axis == 0);
    if (contact.plain) {
      EXPECT_EQ(contact.flat, 0);
    }
  }
  EXPECT_EQ(touched, 0b000111);
  const auto way = follow_guide(guides.front(), turns.task, corner_belief(turns.task, turns.start),
                                turns.start.pose, turns.succ, turns.pool.front());
  ASSERT_TRUE(way);
  EXPECT_FALSE(way->plain.empty());
  for (const std::size_t step : way->plain) EXPECT_NE(way->moves[step].x(), 0.0);
}

TEST(TouchTurns, PlainOnesArePlainInThePlan) {
  constexpr double kHalf_m = 0.04;
  const BlockRollout slippery(kHalf_m, BlockRollout::Yaw::kSettled,
                              BlockRollout::Along::kSlidesOff);
  const Turns turns(block_task(kHalf_m), slippery);
  const PlanReport report = make_plan(turns.task, turns.start, slippery, {});
  ASSERT_EQ(report.status, PlanStatus::kPlanned) << report.reason;
  ASSERT_EQ(report.plan->parameter_sets.size(), 2U);
  EXPECT_FALSE(report.plan->parameter_sets.back().aligns);
}

// A sensor that may be off has them looked for anew, but not for a planner that has no guides.
TEST(TouchTurns, AreNothingForABaseline) {
  Turns turns(0.04);
  turns.task.sensor_error_m = 1e-3;
  PlannerOptions options;
  options.method = PlanMethod::kContactGreedy;
  options.moves_max = 2000;
  const PlanReport report = make_plan(turns.task, turns.start, BlockRollout(0.04), options);
  EXPECT_EQ(report.guide, "");
  EXPECT_GT(report.search_moves.rollouts, 0U);
}

TEST(TouchTurns, AreFollowedByTheTruePhysicsWhereTheOtherHadAKnownStartWrong) {
  const Turns turns(0.04);
  const BlockRollout truth(0.04);
  const BlockRollout larger(0.043);  // by more than the goal's tolerance
  PlannerOptions options;
  options.search_physics = &larger;
  const PlanReport report = make_plan(turns.task, turns.start, truth, options);
  EXPECT_EQ(report.status, PlanStatus::kPlanned) << report.reason;
  EXPECT_TRUE(
      std::any_of(report.refusals.begin(), report.refusals.end(), [](const std::string& refusal) {
        return refusal.find("now followed by the physics that judges") != std::string::npos;
      }));
}

/// As the block, but no tool that is turned about several axes backs off upwards.
class NoCornerBacksOff final : public Rollout {
 public:
  explicit NoCornerBacksOff(double half_m) : half_m_(half_m), block_(half_m) {}

  [[nodiscard]] RolloutResult simulate(const Particle& particle, const MoveParameters& move,
                                       std::int64_t step_us,
                                       std::vector<TraceSample>* trace) override {
    constexpr double kTurned_rad = 1e-6;
    const Vector3 turn_rad = rotation_vector(particle.environment.orientation);
    const auto turns = (turn_rad.array().abs() > kTurned_rad).count();
    if (turns > 1 && move.displacement.z() > 1e-3) return {};
    return block_.simulate(particle, move, step_us, trace);
  }
  [[nodiscard]] bool in_collision(const Pose& tool) override { return block_.in_collision(tool); }
  [[nodiscard]] std::unique_ptr<Rollout> clone() const override {
    return std::make_unique<NoCornerBacksOff>(half_m_);
  }

 private:
  double half_m_;
  BlockRollout block_;
};

// Before another guide is: several errors at their largest at once are the rarest of starts.
TEST(TouchTurns, ThatDoNotLeadAllCornersAtOnceAreTriedWithTheTips) {
  const Turns turns(0.04);
  const NoCornerBacksOff search(0.04);
  std::vector<std::string> lines;
  PlannerOptions options;
  options.search_physics = &search;
  options.progress = [&](const std::string& line) { lines.push_back(line); };
  const PlanReport report = make_plan(turns.task, turns.start, BlockRollout(0.04), options);
  EXPECT_EQ(report.status, PlanStatus::kPlanned) << report.reason;
  int left = 0;
  for (const std::string& line : lines) {
    if (line.find("leads to the goal") != std::string::npos) break;
    left += line.find("is left at") != std::string::npos ? 1 : 0;
  }
  EXPECT_EQ(left, 1);
}

TEST(TouchTurns, LeaveASideThatIsNarrowerThanWhatIsUncertain) {
  Turns turns(1.5e-3);
  for (const Guide& guide : turns.find()) {
    for (const ContactAttractor& contact : guide.contacts) EXPECT_NE(contact.axis, 2);
  }
}

// What comes first of the box around a part is its flange, which passes above the side.
TEST(TouchTurns, BeginNearTheSideWhateverOfThePartIsWider) {
  Task task = block_task(0.04);
  task.held.push_back({"flange",
                       Shape::Kind::kBox,
                       {0.12, 0.12, 4e-3},
                       {{0.0, 0.0, 2.0 * kHeight_m}, {1, 0, 0, 0}}});
  Turns turns(task, BlockRollout(0.04));
  const std::vector<Guide> guides = turns.find();
  ASSERT_FALSE(guides.empty());
  CoordinateMask settled = 0;
  for (const ContactAttractor& contact : guides.front().contacts) {
    settled |= static_cast<CoordinateMask>(1U << contact.axis | contact.flat);
  }
  EXPECT_EQ(settled, 0b111111);
}

/// Two tools at a place, in environments that are turned about the task's origin, one each way.
Belief turned_both_ways(const Turns& turns, const Vector3& place_m, double turn_rad) {
  Belief belief = cross_polytope(turns.task, turns.start);
  belief.particles.resize(2);
  for (Particle& particle : belief.particles) {
    particle.pose = {place_m, turns.task.goal.orientation};
    particle.environment = {Vector3::Zero(), rotation_of({0.0, 0.0, turn_rad})};
    turn_rad = -turn_rad;
  }
  return belief;
}

TEST(MovedTo, WhatIsTurnedIsOffByAsMuchAsThePlaceIsAway) {
  const Turns turns(0.04);
  const double turn_rad = 0.05;
  const Belief belief = turned_both_ways(turns, {0.0, 0.0, 0.1}, turn_rad);
  for (const double away_m : {0.0, 0.1, 0.2}) {
    const Pose place{{away_m, 0.0, 0.1}, turns.task.goal.orientation};
    const Belief there = moved_to(place, belief, turns.task);
    const Vector3 seen_m = there.particles.front().tool().position_m;
    // No move that both make leaves them less off than the sine of what they are turned by.
    EXPECT_NEAR((seen_m - place.position_m).norm(), std::sin(turn_rad) * away_m, 1e-9);
    EXPECT_EQ(there.particles.front().signature.bits, 0);
  }
}

// A wall has been touched whose distance from the goal does not depend on the turn: every one of
// the tools is as far away, but the middle of them is nearer.
TEST(MovedTo, ToolsThatAreTurnedGetWhereAllOfThemCan) {
  const Turns turns(0.04);
  const Belief belief = turned_both_ways(turns, {0.1, 0.0, 0.1}, 0.05);
  const Pose place{{0.0, 0.0, 0.1}, turns.task.goal.orientation};
  for (const Particle& particle : moved_to(place, belief, turns.task).particles) {
    EXPECT_LT((particle.tool().position_m - place.position_m).norm(), 1e-9);
  }
}

TEST(TouchTurns, AreAskedForWhereRotationsAreUncertain) {
  Turns turns(0.04);
  const Belief start = cross_polytope(turns.task, turns.start);
  int asked = 0;
  const auto in_turn = [&] {
    ++asked;
    return turns.find();
  };
  const Attractors found =
      find_attractors(turns.task, start, turns.succ, turns.pool.front(), {}, in_turn);
  EXPECT_EQ(asked, 1);
  EXPECT_FALSE(found.turns.empty());
  EXPECT_EQ(found.unsettled, 0);
  ASSERT_FALSE(found.candidates.empty());
  EXPECT_NE(found.candidates.front().contacts.front().flat, 0);
}

}  // namespace
}  // namespace tenon::planner

// A guide followed to the letter, and the ways through free space on which it goes from one contact
// to the next.

#include "planner/search/guide_way.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "planner/belief/belief_summary.h"
#include "planner/belief/rollout_pool.h"
#include "planner/search/free_legs.h"
#include "planner/search_moves.h"
#include "tests/planner/room_task.h"

namespace tenon::planner {
namespace {

/// Free everywhere but in a block; nothing moves.
class Block final : public Rollout {
 public:
  Block(const Vector3& low_m, const Vector3& high_m) : low_m_(low_m), high_m_(high_m) {}
  [[nodiscard]] RolloutResult simulate(const Particle& /*particle*/, const MoveParameters& /*move*/,
                                       std::int64_t /*step_us*/,
                                       std::vector<TraceSample>* /*trace*/) override {
    return {};
  }
  [[nodiscard]] bool in_collision(const Pose& tool) override {
    const Vector3& p = tool.position_m;
    return (p.array() > low_m_.array()).all() && (p.array() < high_m_.array()).all();
  }
  [[nodiscard]] std::unique_ptr<Rollout> clone() const override {
    return std::make_unique<Block>(low_m_, high_m_);
  }

 private:
  Vector3 low_m_;
  Vector3 high_m_;
};

Pose at(double x_m, double y_m, double z_m) {
  return {{x_m, y_m, z_m}, Eigen::Quaterniond::Identity()};
}

/// No corner of the spread is in the block anywhere on the way, by steps of a tenth of a
/// millimetre.
bool stays_free(Block& block, const BeliefSummary& from, const std::vector<Vector6>& legs) {
  Vector3 tool_m = from.mean.position_m;
  for (const Vector6& leg : legs) {
    const int steps = 1 + static_cast<int>(1e4 * leg.head<3>().norm());
    for (int i = 1; i <= steps; ++i) {
      for (const double x : {-1.0, 1.0}) {
        for (const double y : {-1.0, 1.0}) {
          const Vector3 off_m(x * from.spread[0], y * from.spread[1], 0.0);
          Pose pose = from.mean;
          pose.position_m = tool_m + leg.head<3>() * i / steps + off_m;
          if (block.in_collision(pose)) return false;
        }
      }
    }
    tool_m += leg.head<3>();
  }
  return true;
}

TEST(FreeLegs, GoStraightWhereNothingIsInTheWayAndAroundWhatIs) {
  Task task = own_room_task();
  task.coordinates = 0b111;
  BeliefSummary from;
  from.mean = at(-0.05, 0.0, 0.0);
  from.spread.head<2>() << 2e-3, 2e-3;
  const Pose place = at(0.05, 0.01, 0.0);

  Block nothing({1.0, 1.0, 1.0}, {2.0, 2.0, 2.0});
  const auto straight = FreeLegs(task, at(0.0, 0.0, 0.1), nothing).to(from, place);
  ASSERT_TRUE(straight);
  ASSERT_EQ(straight->size(), 1U);
  EXPECT_TRUE(straight->front().head<3>().isApprox(Vector3(0.1, 0.01, 0.0)));

  Block wall({-0.01, -0.2, -0.2}, {0.01, 0.2, 0.03});
  const auto over = FreeLegs(task, at(0.0, 0.0, 0.1), wall).to(from, place);
  ASSERT_TRUE(over);
  EXPECT_GT(over->size(), 1U);
  EXPECT_TRUE(stays_free(wall, from, *over));
  Vector6 sum = Vector6::Zero();
  for (const Vector6& leg : *over) sum += leg;
  EXPECT_TRUE(sum.head<3>().isApprox(Vector3(0.1, 0.01, 0.0)));

  // As high as what is clear: there is no way around.
  Block high({-0.01, -0.2, -0.2}, {0.01, 0.2, 0.2});
  EXPECT_FALSE(FreeLegs(task, at(0.0, 0.0, 0.1), high).to(from, place));
}

TEST(FreeLegs, TurnOnTheWay) {
  Task task = own_room_task();
  task.coordinates = task.compliance.compliant_axes = 0b111111;
  BeliefSummary from;
  from.mean = at(-0.05, 0.0, 0.0);
  Pose place = at(0.05, 0.01, 0.0);
  place.orientation = Eigen::AngleAxisd(0.02, Vector3::UnitX());
  Block nothing({1.0, 1.0, 1.0}, {2.0, 2.0, 2.0});
  const auto straight = FreeLegs(task, at(0.0, 0.0, 0.1), nothing).to(from, place);
  ASSERT_TRUE(straight);
  ASSERT_EQ(straight->size(), 1U);
  EXPECT_TRUE(straight->front().head<4>().isApprox(Eigen::Vector4d(0.1, 0.01, 0.0, 0.02)));
  // Where nothing else is left to do, too.
  place.position_m = from.mean.position_m;
  EXPECT_EQ(FreeLegs(task, at(0.0, 0.0, 0.1), nothing).to(from, place)->size(), 1U);
}

TEST(FreeLegs, GoAlongTwoAxesAtOnceWhereOnlyTheThirdHasToWait) {
  Task task = own_room_task();
  task.coordinates = task.compliance.compliant_axes = 0b111;
  BeliefSummary from;
  from.mean = at(-0.05, 0.0, 0.0);
  Block step({-0.2, -0.2, -0.2}, {0.03, 0.2, -0.01});
  const auto legs = FreeLegs(task, at(0.0, 0.0, 0.1), step).to(from, at(0.05, 0.02, -0.05));
  ASSERT_TRUE(legs);
  ASSERT_EQ(legs->size(), 2U);
  EXPECT_TRUE(legs->front().head<3>().isApprox(Vector3(0.1, 0.02, 0.0)));
  EXPECT_TRUE(stays_free(step, from, *legs));
}

TEST(FreeLegs, LeaveRoomForTheSpread) {
  Task task = own_room_task();
  task.coordinates = 0b111;
  Block wall({-0.01, 0.012, -0.2}, {0.01, 0.2, 0.03});  // beside the straight way, by 7 mm
  BeliefSummary from;
  from.mean = at(-0.05, 0.005, 0.0);
  const Pose place = at(0.05, 0.005, 0.0);
  FreeLegs legs(task, at(0.0, 0.0, 0.1), wall);
  EXPECT_EQ(legs.to(from, place)->size(), 1U);
  from.spread.head<2>() << 8e-3, 8e-3;
  const auto around = legs.to(from, place);
  ASSERT_TRUE(around);
  EXPECT_GT(around->size(), 1U);
  EXPECT_TRUE(stays_free(wall, from, *around));
}

TEST(FreeLegs, LeaveRoomForWhatIsTurned) {
  Task task = own_room_task();
  task.coordinates = 0b111111;
  task.held = {{"rod", Shape::Kind::kBox, {2e-3, 2e-3, 0.1}, {{0, 0, 0.05}, {1, 0, 0, 0}}}};
  Block wall({-0.01, 0.012, -0.2}, {0.01, 0.2, 0.03});
  BeliefSummary from;
  from.mean = at(-0.05, 0.005, 0.0);
  const Pose place = at(0.05, 0.005, 0.0);
  FreeLegs legs(task, at(0.0, 0.0, 0.1), wall);
  EXPECT_EQ(legs.to(from, place)->size(), 1U);
  // Its upper end, 100 mm away, is off by 10 mm then.
  from.spread[3] = 0.1;
  const auto around = legs.to(from, place);
  ASSERT_TRUE(around);
  EXPECT_GT(around->size(), 1U);
}

struct FollowedRoom {
  explicit FollowedRoom(const Task& of)
      : task(of),
        rollout(room()),
        pool(rollout, 1),
        start(cross_polytope(task, task.starts.front())),
        succ(pool, search_move(task, task.starts.front(), {}), task.rollout_step_us) {}

  [[nodiscard]] std::optional<GuideWay> follow(const Guide& guide) {
    return follow_guide(guide, task, start, task.starts.front().pose, succ, pool.front(), &left);
  }

  Task task;
  WallRollout rollout;
  RolloutPool pool;
  Belief start;
  SuccessorEngine succ;
  std::string left;  ///< where it was followed no farther
};

ContactAttractor wall(int axis, int sign, double at_m) {
  ContactAttractor contact;
  contact.axis = axis;
  contact.sign = sign;
  contact.mean.position_m[axis] = at_m;
  Pose via = at(-0.2, -0.1, 0.0);
  via.position_m[axis] = at_m - 0.1 * sign;
  contact.via = via;
  return contact;
}

TEST(FollowGuide, TouchesWhatItNamesAndEndsAtTheGoal) {
  FollowedRoom room(own_room_task());
  const Guide guide{{wall(0, -1, -0.5), wall(1, -1, -0.4)}, {room.task.goal}, 1.0};
  const auto way = room.follow(guide);
  ASSERT_TRUE(way);
  // Every particle by itself, outside of what was tested.
  for (Particle particle : room.start.particles) {
    int contacts = 0;
    for (const Vector6& displacement : way->moves) {
      MoveParameters move;
      move.displacement = displacement;
      const RolloutResult result = room.rollout.simulate(particle, move, 2000, nullptr);
      contacts += result.move.outcome == Outcome::kContact;
      particle.pose = result.move.pose;
      particle.signature = result.move.signature;
    }
    EXPECT_EQ(contacts, 2);
    EXPECT_LT((particle.tool().position_m - room.task.goal.position_m).norm(), 1e-6);
  }
}

/// The room with a wall across y that leans along x.
class LeaningRoom final : public Rollout {
 public:
  static constexpr double kSlope = 0.2;

  [[nodiscard]] RolloutResult simulate(const Particle& particle, const MoveParameters& move,
                                       std::int64_t step_us,
                                       std::vector<TraceSample>* trace) override {
    Particle upright = particle;
    upright.pose.position_m.y() -= kSlope * particle.pose.position_m.x();
    MoveParameters along = move;
    along.displacement[1] -= kSlope * move.displacement[0];
    RolloutResult result = walls_.simulate(upright, along, step_us, trace);
    Pose& end = result.move.pose;
    end.position_m.y() += kSlope * end.position_m.x();
    result.move.travelled = displacement_between(particle.pose, end);
    return result;
  }
  [[nodiscard]] bool in_collision(const Pose& tool) override {
    Pose upright = tool;
    upright.position_m.y() -= kSlope * tool.position_m.x();
    return walls_.in_collision(upright);
  }
  [[nodiscard]] std::unique_ptr<Rollout> clone() const override {
    return std::make_unique<LeaningRoom>();
  }

 private:
  WallRollout walls_{room()};
};

// The wall that leans was met before x was known, and the floor tells nothing new.
TEST(FollowGuide, MakesNoTouchAgainThatTellsNothingNew) {
  Task task = own_room_task();
  task.coordinates = 0b111;
  task.compliance.compliant_axes = 0b111;
  task.motion.carried_axes = true;
  task.starts.front().sigma[2] = 0.03;
  derive_moves(task);
  LeaningRoom rollout;
  RolloutPool pool(rollout, 1);
  const Start& from = task.starts.front();
  SuccessorEngine succ(pool, search_move(task, from, {}), task.rollout_step_us);
  const Guide guide{{wall(2, -1, -1.0), wall(1, -1, -0.4), wall(0, -1, -0.5)}, {task.goal}, 1.0};
  std::string left;
  const auto way =
      follow_guide(guide, task, cross_polytope(task, from), from.pose, succ, pool.front(), &left);
  ASSERT_TRUE(way) << left;
  for (Particle particle : cross_polytope(task, from).particles) {
    int touches = 0;
    int floor = 0;
    for (const Vector6& displacement : way->moves) {
      MoveParameters move;
      move.displacement = displacement;
      const RolloutResult result = rollout.simulate(particle, move, 2000, nullptr);
      touches += result.move.outcome == Outcome::kContact;
      floor += result.move.signature.sign(2) != 0 && displacement.z() != 0.0;
      particle.pose = result.move.pose;
      particle.signature = result.move.signature;
    }
    EXPECT_EQ(touches, 4);
    EXPECT_EQ(floor, 1);
    EXPECT_LT((particle.tool().position_m - task.goal.position_m).norm(), 1e-6);
  }
}

TEST(FollowGuide, SaysSoWhereItDoesNotLeadToTheGoal) {
  FollowedRoom room(own_room_task());
  // y stays as uncertain as it was.
  EXPECT_FALSE(room.follow({{wall(0, -1, -0.5)}, {room.task.goal}, 1.0}));
  EXPECT_EQ(room.left, "the goal: the part does not go in");
  // The push would begin in the wall.
  ContactAttractor behind = wall(1, -1, -0.4);
  behind.via->position_m.y() = -0.6;
  EXPECT_FALSE(room.follow({{wall(0, -1, -0.5), behind}, {room.task.goal}, 1.0}));
  EXPECT_EQ(room.left, "its touch 2: no straight legs lead there");
}

}  // namespace
}  // namespace tenon::planner

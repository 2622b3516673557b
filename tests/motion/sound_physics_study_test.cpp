// Random guarded moves of pegs in holes with almost no room: the solver never complains, and no
// part ever passes through another. The judge is the geometry in closed form, not ODE's contacts.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <functional>
#include <numbers>
#include <random>
#include <string>
#include <vector>

#include "shared/task/ring.h"
#include "shared/task/task.h"
#include "sim/physics/rollout/ode_rollout.h"

namespace tenon {
namespace {

constexpr double kPeg_m = 0.04;    // width or diameter
constexpr double kDepth_m = 0.06;  // of the hole, whose mouth is at z = 0
constexpr double kBlock_m = 0.5;   // wider than any peg ever goes
constexpr double kReach_m = 0.1;   // further away the moves start anew
constexpr int kSegments = 16;

Shape box(const std::string& name, const Vector3& size_m, const Vector3& centre_m) {
  return {name, Shape::Kind::kBox, size_m, {centre_m, Eigen::Quaterniond::Identity()}};
}

/// A hole, and how deep a peg whose axis stands at (x, y) has sunk into its walls.
struct Hole {
  const char* name;
  Task task;
  std::vector<int> axes;
  std::function<double(double x_m, double y_m)> into_wall_m;
};

Task with_bottom(std::uint8_t compliant_axes) {
  Task task;
  task.held = {box("peg", {kPeg_m, kPeg_m, 0.1}, {0.0, 0.0, 0.05})};
  task.environment = {box("bottom", {kBlock_m, kBlock_m, 0.05}, {0.0, 0.0, -kDepth_m - 0.025})};
  task.compliance.compliant_axes = compliant_axes;
  return task;
}

Shape wall(const std::string& name, int axis, double sign, double gap_m) {
  Vector3 size_m(kBlock_m, kBlock_m, kDepth_m);
  Vector3 centre_m(0.0, 0.0, -0.5 * kDepth_m);
  size_m[axis] = 0.2;
  centre_m[axis] = sign * 0.5 * (gap_m + 0.2);
  return box(name, size_m, centre_m);
}

/// In the plane: a slot between two blocks.
Hole slot(double clearance_m) {
  Task task = with_bottom(0b000101);
  for (const double sign : {-1.0, 1.0}) {
    task.environment.push_back(wall("wall x", 0, sign, kPeg_m + clearance_m));
  }
  return {"peg in a slot, x z", task, {0, 2}, [clearance_m](double x_m, double /*y_m*/) {
            return std::abs(x_m) - 0.5 * clearance_m;
          }};
}

/// A square hole: four walls and four corners.
Hole pocket(double clearance_m) {
  Task task = with_bottom(0b000111);
  for (const int axis : {0, 1}) {
    for (const double sign : {-1.0, 1.0}) {
      task.environment.push_back(wall("wall", axis, sign, kPeg_m + clearance_m));
    }
  }
  return {"box in a square hole, x y z", task, {0, 1, 2}, [clearance_m](double x_m, double y_m) {
            return std::max(std::abs(x_m), std::abs(y_m)) - 0.5 * clearance_m;
          }};
}

/// A round peg in a round hole.
Hole ring(double clearance_m) {
  Task task = with_bottom(0b000111);
  task.held[0].kind = Shape::Kind::kCylinder;
  Ring ring;
  ring.name = "hole";
  ring.inner_diameter_m = kPeg_m + clearance_m;
  ring.outer_diameter_m = kBlock_m;
  ring.length_m = kDepth_m;
  ring.segments = kSegments;
  ring.pose.position_m.z() = -0.5 * kDepth_m;
  const std::vector<Shape> boxes = boxes_of(ring);
  task.environment.insert(task.environment.end(), boxes.begin(), boxes.end());
  return {"round peg in a ring, x y z", task, {0, 1, 2}, [clearance_m](double x_m, double y_m) {
            double deepest_m = -1.0;
            for (int i = 0; i < kSegments; ++i) {
              const double angle_rad = 2.0 * std::numbers::pi * i / kSegments;
              const double out_m = x_m * std::cos(angle_rad) + y_m * std::sin(angle_rad);
              deepest_m = std::max(deepest_m, out_m - 0.5 * clearance_m);
            }
            return deepest_m;
          }};
}

/// How far the peg would have to move to be free, m; 0 where it is.
double overlap_m(const Hole& hole, const Pose& tip) {
  const Vector3& p = tip.position_m;
  const double in_block_m = std::min(-p.z(), hole.into_wall_m(p.x(), p.y()));
  return std::max({0.0, in_block_m, -kDepth_m - p.z()});
}

struct Tally {
  int moves = 0;
  int failed = 0;
  std::string failure;
  int in_hole = 0;
  double rest_overlap_max_m = 0.0;
  double path_overlap_max_m = 0.0;
  double unpressed_overlap_max_m = 0.0;  // what the move's peak force does not account for
  double peak_force_max_N = 0.0;
};

class RandomMoves {
 public:
  RandomMoves(const Hole& hole, double clearance_m, double fastest_mps, std::uint64_t seed)
      : hole_(hole),
        clearance_m_(clearance_m),
        fastest_mps_(fastest_mps),
        random_(seed),
        rollout_(hole.task) {}

  Tally run(int moves) {
    for (int i = 0; i < moves; ++i) {
      if (i % 20 == 0) restart();
      move();
    }
    return tally_;
  }

 private:
  double uniform(double low, double high) {
    return low + (high - low) * static_cast<double>(random_() >> 11) * 0x1.0p-53;
  }

  /// In the hole or above it.
  void restart() {
    particle_ = {};
    const bool inside = random_() % 2 == 0;
    const double room_m = inside ? 0.25 * clearance_m_ : 0.01;
    for (const int axis : {0, 1}) {
      if (std::find(hole_.axes.begin(), hole_.axes.end(), axis) == hole_.axes.end()) continue;
      particle_.pose.position_m[axis] = uniform(-room_m, room_m);
    }
    particle_.pose.position_m.z() = inside ? uniform(-0.055, -0.005) : uniform(0.002, 0.02);
  }

  MoveParameters random_move() {
    const auto axis = [this] { return hole_.axes[random_() % hole_.axes.size()]; };
    const auto sign = [this] { return random_() % 2 == 0 ? 1.0 : -1.0; };
    MoveParameters move;
    move.compliance = hole_.task.compliance;
    move.speeds.contact_mps = uniform(0.02, fastest_mps_);
    move.speeds.approach_mps = move.speeds.contact_mps;
    move.displacement[axis()] = sign() * uniform(0.005, 0.08);
    if (random_() % 3 == 0) move.displacement[axis()] = sign() * uniform(0.0, 0.05);
    return move;
  }

  void move() {
    particle_.physics.friction = uniform(0.0, 0.6);
    std::vector<TraceSample> trace;
    const RolloutResult result =
        rollout_.simulate(particle_, random_move(), hole_.task.rollout_step_us, &trace);
    ++tally_.moves;
    judge_path(trace);
    if (!result.valid) {
      ++tally_.failed;
      tally_.failure = result.failure;
      restart();
      return;
    }
    const Pose& end = result.move.pose;
    tally_.rest_overlap_max_m = std::max(tally_.rest_overlap_max_m, overlap_m(hole_, end));
    tally_.in_hole += end.position_m.z() < -1e-3;
    particle_.pose = end;
    particle_.signature = result.move.signature;
    if (end.position_m.head<2>().norm() > kReach_m) restart();
  }

  void judge_path(const std::vector<TraceSample>& trace) {
    double deepest_m = 0.0;
    double peak_force_N = 0.0;
    for (const TraceSample& sample : trace) {
      deepest_m = std::max(deepest_m, overlap_m(hole_, sample.input.pose));
      peak_force_N = std::max(peak_force_N, sample.input.wrench.head<3>().norm());
    }
    const double pressed_m = peak_force_N / particle_.physics.contact_stiffness_Npm;
    tally_.path_overlap_max_m = std::max(tally_.path_overlap_max_m, deepest_m);
    tally_.unpressed_overlap_max_m =
        std::max(tally_.unpressed_overlap_max_m, deepest_m - pressed_m);
    tally_.peak_force_max_N = std::max(tally_.peak_force_max_N, peak_force_N);
  }

  const Hole& hole_;
  double clearance_m_;
  double fastest_mps_;
  std::mt19937_64 random_;
  sim::OdeRollout rollout_;
  Particle particle_;
  Tally tally_;
};

/// At four clearances, each at the speeds that the integration step allows there.
void expect_sound(Hole (*make)(double), int moves_each) {
  std::uint64_t seed = 1;
  for (const double clearance_m : {0.5e-3, 1e-3, 2e-3, 4e-3}) {
    const Hole hole = make(clearance_m);
    const double step_travel_m = clearance_m < 1e-3 ? 0.2e-3 : 0.5e-3;
    const double step_s = 1e-6 * static_cast<double>(hole.task.rollout_step_us);
    const Tally t = RandomMoves(hole, clearance_m, step_travel_m / step_s, seed++).run(moves_each);
    std::printf(
        "%-27s %.1f mm %5d moves, %d in the hole | solver or tunnelling %d %s | overlap at rest "
        "%.0f, on the way %.0f, beyond the pressed one %.0f um | peak %.0f N\n",
        hole.name, 1e3 * clearance_m, t.moves, t.in_hole, t.failed, t.failure.c_str(),
        1e6 * t.rest_overlap_max_m, 1e6 * t.path_overlap_max_m, 1e6 * t.unpressed_overlap_max_m,
        t.peak_force_max_N);
    EXPECT_EQ(t.failed, 0) << t.failure;
    EXPECT_GT(t.in_hole, moves_each / 6);
    // No more than the spring at its limit presses the surfaces in.
    EXPECT_LE(t.rest_overlap_max_m,
              MoveParameters{}.force_limit_N / PhysicalParameters{}.contact_stiffness_Npm);
    // A wall answers one step after it was reached; what the tool travels in it comes on top.
    EXPECT_LE(t.unpressed_overlap_max_m, step_travel_m);
  }
}

// Where a release needs it (label full).
constexpr int kMovesEach = 850;  // of twelve holes: more than 10,000

TEST(SoundPhysicsStudy, APegInASlotNeverGoesThroughAWall) { expect_sound(&slot, kMovesEach); }

TEST(SoundPhysicsStudy, ABoxNeverGoesThroughTheCornersOfASquareHole) {
  expect_sound(&pocket, kMovesEach);
}

TEST(SoundPhysicsStudy, ARoundPegNeverGoesThroughARing) { expect_sound(&ring, kMovesEach); }

// In every run of the tests.
constexpr int kFewEach = 400;

TEST(ShortSoundPhysicsStudy, APegInASlotNeverGoesThroughAWall) { expect_sound(&slot, kFewEach); }

TEST(ShortSoundPhysicsStudy, ABoxNeverGoesThroughTheCornersOfASquareHole) {
  expect_sound(&pocket, kFewEach);
}

TEST(ShortSoundPhysicsStudy, ARoundPegNeverGoesThroughARing) { expect_sound(&ring, kFewEach); }

}  // namespace
}  // namespace tenon

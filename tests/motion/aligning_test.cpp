// A tool that can turn, pressed against something that is not where its axes say: it aligns, and
// goes on along what it found.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <numbers>
#include <utility>
#include <vector>

#include "shared/motion/admittance.h"
#include "shared/ports/rollout.h"
#include "shared/task/task.h"
#include "sim/physics/rollout/ode_rollout.h"

namespace tenon {
namespace {

constexpr double kDegree = std::numbers::pi / 180.0;
constexpr std::int64_t kStep_us = 2000;

/// A box before a wall at +x that is turned about z; only x, y and the turn yield.
class Wall {
 public:
  /// @param aside_m by which the tool holds the part beside its middle
  explicit Wall(double side_m = 0.1, double aside_m = 0.0) {
    task_.held = {
        {"part", Shape::Kind::kBox, {side_m, side_m, 0.1}, {{0.0, aside_m, 0.0}, {1, 0, 0, 0}}}};
    task_.environment = {
        {"wall", Shape::Kind::kBox, {0.1, 2.0, 0.1}, {{0.2, 0.0, 0.01}, {1, 0, 0, 0}}}};
    move_.compliance.compliant_axes = 0b100011;
    move_.compliance.stiffness_Nmpr = 5.0;
    move_.sensed_axes = 0b011111;
    move_.timeout_us = 20'000'000;
    move_.displacement[0] = 0.2;
  }

  [[nodiscard]] Particle before(double turned_rad, double friction) const {
    Particle particle;
    particle.environment = {Vector3::Zero(), rotation_of({0.0, 0.0, turned_rad})};
    particle.physics.friction = friction;
    return particle;
  }
  [[nodiscard]] RolloutResult run(const Particle& particle, const MoveParameters& move,
                                  std::vector<TraceSample>* trace = nullptr) {
    return sim::OdeRollout(task_).simulate(particle, move, kStep_us, trace);
  }
  [[nodiscard]] const MoveParameters& push() const { return move_; }

 private:
  Task task_;
  MoveParameters move_;
};

double turn_of(const Pose& pose) { return rotation_vector(pose.orientation).z(); }

TEST(Aligning, APartThatMeetsAWallAskewEndsFlatAgainstIt) {
  for (const double turned_deg : {-8.0, -5.0, -1.0, -0.1, 0.0, 0.3, 2.0, 5.0, 8.0}) {
    for (const double friction : {0.1, 0.3, 0.6}) {
      Wall wall;
      const RolloutResult result =
          wall.run(wall.before(turned_deg * kDegree, friction), wall.push());
      ASSERT_TRUE(result.valid) << result.failure;
      EXPECT_EQ(result.move.outcome, Outcome::kContact);
      EXPECT_EQ(to_string(result.move.signature), "-x");
      EXPECT_NEAR(turn_of(result.move.pose), turned_deg * kDegree, 0.05 * kDegree)
          << turned_deg << " degrees, friction " << friction;
      EXPECT_LT(result.move.peak_force_N, 20.0);
    }
  }
}

/// Where a part that was pressed askew rests, and by what lever it feels itself pressed there.
struct Pressed {
  double turned_rad = 0.0;
  double lever_m = 0.0;
};

Pressed pressed_askew(double side_m, double aside_m, double sensor_m) {
  Wall wall(side_m, aside_m);
  Particle particle = wall.before(3.0 * kDegree, 0.0);
  particle.physics.sensor_error_m.y() = sensor_m;
  MoveParameters push = wall.push();
  push.thresholds = with_press_torques(push.thresholds);
  std::vector<TraceSample> trace;
  const RolloutResult result = wall.run(particle, push, &trace);
  EXPECT_TRUE(result.valid) << result.failure;
  const Vector6& wrench = trace.back().input.wrench;
  return {turn_of(result.move.pose), wrench[5] / wrench[0]};
}

// A sensor that is not where the arm takes it to be tells the torque about a point beside the
// tool's tip: as if the part were held as much to the other side.
TEST(Aligning, APartIsPressedFlatAboutWhereTheSensorIsTakenToBe) {
  constexpr double kSide_m = 3e-3;
  constexpr double kAside_m = 0.6e-3;
  constexpr double kAlike_m = 0.05e-3;
  const Pressed level = pressed_askew(kSide_m, 0.0, 0.0);
  for (const double aside_m : {kAside_m, -kAside_m}) {
    const Pressed far = pressed_askew(kSide_m, aside_m, 0.0);
    EXPECT_GT(std::abs(far.lever_m - level.lever_m), 5.0 * kAlike_m);
    EXPECT_NEAR(pressed_askew(kSide_m, aside_m, aside_m).lever_m, level.lever_m, kAlike_m);
    EXPECT_NEAR(pressed_askew(kSide_m, 0.0, -aside_m).lever_m, far.lever_m, kAlike_m);
  }
}

// A side that is hardly wider than what the sensor may be off does not lie flat for sure.
TEST(Aligning, ANarrowSideStaysAskewWhereTheSensorIsOffByHalfOfIt) {
  const auto left_rad = [](double side_m, double sensor_m) {
    return std::abs(pressed_askew(side_m, 0.0, sensor_m).turned_rad - 3.0 * kDegree);
  };
  for (const double off_m : {0.0, 2e-3, -2e-3}) {
    EXPECT_LT(left_rad(0.04, off_m), 0.1 * kDegree) << off_m;
  }
  EXPECT_LT(left_rad(6e-3, 0.0), 0.3 * kDegree);
  EXPECT_GT(std::max(left_rad(6e-3, 2.5e-3), left_rad(6e-3, -2.5e-3)), 1.0 * kDegree);
}

// Without rotary compliance nothing of this happens.
TEST(Aligning, ATouchThatCannotTurnLeavesThePartAskew) {
  Wall wall;
  MoveParameters rigid = wall.push();
  rigid.compliance.compliant_axes = 0b000011;
  const RolloutResult result = wall.run(wall.before(5.0 * kDegree, 0.3), rigid);
  ASSERT_TRUE(result.valid) << result.failure;
  EXPECT_EQ(turn_of(result.move.pose), 0.0);
}

TEST(Aligning, AMoveInCarriedAxesGoesAlongWhatTheToolHasFound) {
  Wall wall;
  const double turned_rad = 5.0 * kDegree;
  Particle particle = wall.before(turned_rad, 0.3);
  MoveParameters push = wall.push();
  push.carried_from = Eigen::Quaterniond::Identity();
  const RolloutResult met = wall.run(particle, push);
  ASSERT_TRUE(met.valid) << met.failure;

  particle.pose = met.move.pose;
  particle.signature = met.move.signature;
  MoveParameters along = push;
  along.displacement << 0.0, 0.2, 0.0, 0.0, 0.0, 0.0;
  const RolloutResult slid = wall.run(particle, along);
  ASSERT_TRUE(slid.valid) << slid.failure;
  EXPECT_EQ(slid.move.outcome, Outcome::kReached);
  EXPECT_EQ(to_string(slid.move.signature), "-x");
  EXPECT_NEAR(slid.move.travelled[1], 0.2, 1e-3);  // in its own axes
  EXPECT_NEAR(slid.move.travelled[0], 0.0, 0.1e-3);
  const Vector3 way_m = slid.move.pose.position_m - met.move.pose.position_m;
  EXPECT_NEAR(std::atan2(-way_m.x(), way_m.y()), turned_rad, 0.05 * kDegree);

  // By the task's axes the wall comes nearer, or leaves: 17 mm over this way.
  along.carried_from.reset();
  const RolloutResult askew = wall.run(particle, along);
  ASSERT_TRUE(askew.valid) << askew.failure;
  const Vector3 other_m = askew.move.pose.position_m - met.move.pose.position_m;
  EXPECT_GT((other_m - way_m).norm(), 1e-3);
}

template <typename Vector>
bool same_bits(const Vector& a, const Vector& b) {
  return std::memcmp(a.data(), b.data(), sizeof(double) * static_cast<std::size_t>(a.size())) == 0;
}

TEST(Aligning, ARecordedMoveInCarriedAxesReplaysBitForBit) {
  Wall wall;
  MoveParameters push = wall.push();
  push.carried_from = rotation_of({0.0, 0.0, -0.2});
  push.displacement << 0.2, 0.01, 0.0, 0.0, 0.0, 0.05;
  std::vector<TraceSample> trace;
  const RolloutResult result = wall.run(wall.before(4.0 * kDegree, 0.3), push, &trace);
  ASSERT_TRUE(result.valid) << result.failure;
  GuardedMove again(push, {});
  for (const TraceSample& sample : trace) {
    const GuardedMove::Output output = again.update(sample.input);
    ASSERT_TRUE(same_bits(output.setpoint.pose.position_m, sample.setpoint.pose.position_m));
    ASSERT_TRUE(same_bits(output.setpoint.pose.orientation.coeffs(),
                          sample.setpoint.pose.orientation.coeffs()));
    ASSERT_TRUE(same_bits(output.setpoint.velocity, sample.setpoint.velocity));
    ASSERT_TRUE(same_bits(output.setpoint.acceleration, sample.setpoint.acceleration));
  }
  ASSERT_TRUE(again.result().has_value());
  EXPECT_EQ(again.result()->outcome, result.move.outcome);
  EXPECT_EQ(again.result()->duration_ns, result.move.duration_ns);
}

/// Presses something at +x that cannot turn it. @param torque_Nm what the sensor is off by about an
/// axis (0..2) at the press of a probe, in proportion at others
GuardedMove::Result pressed_with_torque_off_by(double torque_Nm, int about, bool aligns = true) {
  MoveParameters push;
  push.aligns = aligns;
  push.compliance.compliant_axes = 0b111001;
  push.compliance.stiffness_Nmpr = 5.0;
  push.compliance.damping_Nmspr = 1.0;
  push.sensed_axes = 0b000111;
  push.thresholds = with_press_torques(push.thresholds);
  push.timeout_us = 30'000'000;
  push.displacement[0] = 0.02;
  constexpr double kWall_m = 0.01;
  constexpr double kWall_Npm = 2e4;
  const double probe_N = kProbeOverOn * push.thresholds.force_on_N;
  GuardedMove move(push, {});
  Admittance tool(push.compliance);
  GuardedMove::Input input;
  for (input.time_ns = 0; !move.result(); input.time_ns += 1000 * kStep_us) {
    input.pose = tool.state().pose;
    const double press_N = kWall_Npm * std::max(0.0, input.pose.position_m.x() - kWall_m);
    input.wrench << -press_N, 0.0, 0.0, 0.0, 0.0, 0.0;
    input.wrench[3 + about] = torque_Nm * press_N / probe_N;
    tool.update(move.update(input).setpoint, input.wrench, 1e-6 * kStep_us);
  }
  return *move.result();
}

TEST(Aligning, WhatASensorIsWrongByTurnsAPressedToolByTheSpringsGiveAlone) {
  const ContactThresholds t = with_press_torques({});
  const double give_rad = t.torque_off_Nm / 5.0;
  for (const double share : {-0.95, -0.3, 0.0, 0.3, 0.95}) {
    const GuardedMove::Result result = pressed_with_torque_off_by(share * t.torque_off_Nm, 2);
    EXPECT_EQ(result.outcome, Outcome::kContact);
    EXPECT_LE(std::abs(turn_of(result.pose)), 2.0 * give_rad) << share;
    EXPECT_LT(result.duration_ns, 3'000'000'000) << share;
  }
  const GuardedMove::Result turned = pressed_with_torque_off_by(2.0 * t.torque_off_Nm, 2);
  EXPECT_GT(std::abs(turn_of(turned.pose)), 10.0 * give_rad);
}

// It is held as it was met, at once, with what keeps a contact.
TEST(Aligning, APlainTouchIsTurnedByTheSpringsGiveAloneAndDoesNotWait) {
  const ContactThresholds t = with_press_torques({});
  const GuardedMove::Result result = pressed_with_torque_off_by(2.0 * t.torque_off_Nm, 2, false);
  EXPECT_EQ(result.outcome, Outcome::kContact);
  EXPECT_EQ(to_string(result.signature), "-x");
  EXPECT_LE(std::abs(turn_of(result.pose)), 2.0 * t.torque_off_Nm / 5.0);
  EXPECT_LT(result.duration_ns - result.decided_ns, 600'000'000);
}

TEST(Aligning, APressTurnsNothingAboutItsOwnDirection) {
  const ContactThresholds t = with_press_torques({});
  const double turning_Nm = 3.0 * t.torque_off_Nm;
  const GuardedMove::Result result = pressed_with_torque_off_by(turning_Nm, 0);
  EXPECT_EQ(result.outcome, Outcome::kContact);
  EXPECT_LE(rotation_vector(result.pose.orientation).norm(), 2.0 * turning_Nm / 5.0);
  EXPECT_LT(result.duration_ns, 3'000'000'000);
}

/// Where a tool ends that goes to and fro in free air while its sensor is off by a wrench.
Pose moved_after(int moves, const Vector6& wrench, bool hand_on) {
  MoveParameters move;
  move.compliance.stiffness_Nmpr = 5.0;
  move.compliance.damping_Nmspr = 1.0;
  move.sensed_axes = 0b000111;
  Admittance tool(move.compliance);
  GuardedMove::Input input;
  input.wrench = wrench;
  std::optional<Pose> held;
  for (int i = 0; i < moves; ++i) {
    move.displacement[1] = i % 2 == 0 ? 0.02 : -0.02;
    GuardedMove guarded(move, {}, hand_on ? held : std::nullopt);
    Setpoint setpoint;
    for (; !guarded.result(); input.time_ns += 1000 * kStep_us) {
      input.pose = tool.state().pose;
      setpoint = guarded.update(input).setpoint;
      tool.update(setpoint, input.wrench, 1e-6 * kStep_us);
    }
    held = setpoint.pose;
  }
  return tool.state().pose;
}

TEST(Aligning, AToolInFreeAirIsNotTurnedOnFromMoveToMove) {
  const Vector6 torque = 0.005 * Vector6::Unit(5);
  constexpr double kGive_rad = 0.005 / 5.0;
  EXPECT_NEAR(turn_of(moved_after(1, torque, true)), kGive_rad, 0.2 * kGive_rad);
  EXPECT_NEAR(turn_of(moved_after(20, torque, true)), kGive_rad, 0.2 * kGive_rad);
  // As if each move began from where the one before had left the tool.
  EXPECT_GT(turn_of(moved_after(20, torque, false)), 5.0 * kGive_rad);
}

/// How far a tool is turned that goes to a wall and back, turning a little each time, while its
/// sensor is off by a torque.
double turned_by_touches(int touches, double turn_rad, double torque_Nm) {
  constexpr double kWall_m = 0.01;
  constexpr double kWall_Npm = 2e4;
  MoveParameters move;
  move.compliance.stiffness_Nmpr = 5.0;
  move.compliance.damping_Nmspr = 1.0;
  move.sensed_axes = 0b000111;
  move.aligns = false;
  Admittance tool(move.compliance);
  GuardedMove::Input input;
  std::optional<Pose> held;
  ContactSignature signature;
  for (int i = 0; i < 2 * touches; ++i) {
    const bool back = i % 2 != 0;
    move.displacement << (back ? -0.01 : 0.02), 0.0, 0.0, 0.0, 0.0, (back ? -turn_rad : turn_rad);
    GuardedMove guarded(move, signature, held);
    Setpoint setpoint;
    for (; !guarded.result(); input.time_ns += 1000 * kStep_us) {
      input.pose = tool.state().pose;
      const double press_N = kWall_Npm * std::max(0.0, input.pose.position_m.x() - kWall_m);
      input.wrench << -press_N, 0.0, 0.0, 0.0, 0.0, torque_Nm;
      setpoint = guarded.update(input).setpoint;
      tool.update(setpoint, input.wrench, 1e-6 * kStep_us);
    }
    EXPECT_EQ(guarded.result()->outcome, back ? Outcome::kReached : Outcome::kContact);
    held = setpoint.pose;
    signature = guarded.signature();
  }
  return turn_of(tool.state().pose);
}

// What stops it on its way has not turned it.
TEST(Aligning, NorWhereItMeetsAWallOnItsWayOfAMoveThatTurnsToo) {
  constexpr double kTorque_Nm = 0.005;
  constexpr double kGive_rad = kTorque_Nm / 5.0;
  constexpr double kTurn_rad = 1e-4;
  for (const double turn_rad : {0.0, kTurn_rad, -kTurn_rad}) {
    EXPECT_NEAR(turned_by_touches(10, turn_rad, kTorque_Nm), kGive_rad, kGive_rad) << turn_rad;
  }
}

TEST(Aligning, NorIsItShiftedOnByAForceThatCountsForNone) {
  const double give_m = 0.5 / Compliance{}.stiffness_Npm;
  const auto shifted_m = [](double force_N, int moves, bool hand_on) {
    return moved_after(moves, force_N * Vector6::Unit(2), hand_on).position_m.z();
  };
  EXPECT_LT(shifted_m(0.5, 20, true), 1.1 * give_m);
  EXPECT_GT(shifted_m(0.5, 20, false), 3.0 * give_m);
  // What may be a contact that was not noticed shifts the tool for good.
  const double force_N = 2.0 * MoveParameters{}.thresholds.force_off_N;
  EXPECT_GT(shifted_m(force_N, 20, true), 1.5 * force_N / Compliance{}.stiffness_Npm);
}

TEST(Aligning, AFaceOfTwentyMillimetresIsFoundWithPressTorques) {
  for (const double turned_deg : {-5.0, -1.0, 0.3, 5.0}) {
    Wall wall(0.02);
    MoveParameters push = wall.push();
    push.thresholds = with_press_torques(push.thresholds);
    const RolloutResult result = wall.run(wall.before(turned_deg * kDegree, 0.6), push);
    ASSERT_TRUE(result.valid) << result.failure;
    EXPECT_EQ(to_string(result.move.signature), "-x");
    EXPECT_NEAR(turn_of(result.move.pose), turned_deg * kDegree, 0.1 * kDegree) << turned_deg;
  }
}

}  // namespace
}  // namespace tenon

// What a guarded move does while it finds out whether a push is a contact: a push that was none
// costs nothing, and the contacts that the tool holds already survive the making of another.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <deque>
#include <functional>
#include <vector>

#include "shared/motion/admittance.h"
#include "shared/motion/guarded_move.h"
#include "sim/physics/rollout/compliant_tool.h"
#include "sim/physics/solver/ode_world.h"

namespace tenon {
namespace {

/// A sensor that feels for one sample what is not there.
struct Spike {
  double time_s = -1.0;  ///< none before 0
  int axis = 0;
  double force_N = 0.0;

  [[nodiscard]] Vector6 at(double now_s, double step_s) const {
    Vector6 wrench = Vector6::Zero();
    if (time_s >= 0.0 && std::abs(now_s - time_s) < 0.5 * step_s) wrench[axis] = force_N;
    return wrench;
  }
};

struct Arrival {
  Pose pose;
  int probed = 0;  ///< samples
};

MoveParameters move_of(double x_m, double y_m) {
  MoveParameters move;
  move.displacement[0] = x_m;
  move.displacement[1] = y_m;
  move.slow_from_m = 0.06;
  return move;
}

/// Where drives that obey the compliance law bring a tool in free space, measured `delay` steps
/// late. What the sensor feels moves the tool as well.
Arrival through_the_law(const MoveParameters& parameters, const Spike& spike, double step_s,
                        std::size_t delay) {
  Admittance tool(parameters.compliance);
  GuardedMove move(parameters, {});
  std::deque<Pose> way(delay + 1, Pose{});
  Arrival arrival;
  for (int i = 0;; ++i) {
    const double now_s = step_s * i;
    GuardedMove::Input input;
    input.time_ns = std::llround(1e9 * now_s);
    input.pose = way.front();
    input.wrench = spike.at(now_s, step_s);
    const GuardedMove::Output output = move.update(input);
    arrival.probed += output.phase == GuardedMove::Phase::kProbing;
    way.push_back(tool.update(output.setpoint, input.wrench, step_s).pose);
    way.pop_front();
    if (output.phase == GuardedMove::Phase::kDone) break;
  }
  EXPECT_EQ(move.result()->outcome, Outcome::kReached);
  arrival.pose = move.result()->pose;
  return arrival;
}

/// The same for the body that the planner's rollouts move; only the sensor feels the spike.
Arrival through_ode(const MoveParameters& parameters, const Spike& spike, double step_s) {
  sim::OdeWorld world;
  sim::CompliantTool tool(world, parameters.compliance);
  tool.place({});
  GuardedMove move(parameters, {});
  Arrival arrival;
  for (int i = 0;; ++i) {
    const double now_s = step_s * i;
    const GuardedMove::Output output = move.update(
        {std::llround(1e9 * now_s), tool.pose(), spike.at(now_s, step_s), /*wrench_fresh=*/true});
    arrival.probed += output.phase == GuardedMove::Phase::kProbing;
    if (output.phase == GuardedMove::Phase::kDone) break;
    tool.drive(output.setpoint, step_s);
    world.step(step_s);
    tool.follow();
  }
  EXPECT_EQ(move.result()->outcome, Outcome::kReached);
  arrival.pose = move.result()->pose;
  return arrival;
}

// Speeding up, at approach speed, slowing down, at contact speed, in the last ramp; against the
// move, with it, and across.
std::vector<Spike> spikes() {
  std::vector<Spike> all;
  for (const double time_s : {0.06, 0.4, 0.66, 1.0, 1.4}) {
    all.push_back({time_s, 0, -10.0});
    all.push_back({time_s, 0, +10.0});
    all.push_back({time_s, 1, -10.0});
  }
  return all;
}

constexpr double kNothing_m = 20e-6;

void expect_no_cost(const std::function<Arrival(const MoveParameters&, const Spike&)>& run) {
  double worst_m = 0.0;
  for (const MoveParameters& move : {move_of(0.1, 0.0), move_of(0.08, -0.06)}) {
    const Arrival undisturbed = run(move, {});
    EXPECT_EQ(undisturbed.probed, 0);
    for (const Spike& spike : spikes()) {
      const Arrival arrival = run(move, spike);
      EXPECT_GT(arrival.probed, 0) << "at " << spike.time_s;
      const double off_m = (arrival.pose.position_m - undisturbed.pose.position_m).norm();
      EXPECT_LT(off_m, kNothing_m) << "at " << spike.time_s << " on axis " << spike.axis;
      worst_m = std::max(worst_m, off_m);
    }
  }
  std::printf("a rejected probe costs at most %.1f um\n", 1e6 * worst_m);
}

TEST(Probing, APushThatWasNoneCostsAnArmNothing) {
  for (const std::size_t delay : {0U, 3U, 6U}) {
    expect_no_cost([&](const MoveParameters& move, const Spike& spike) {
      return through_the_law(move, spike, 2e-3, delay);
    });
  }
}

TEST(Probing, APushThatWasNoneCostsARolloutNothing) {
  expect_no_cost([&](const MoveParameters& move, const Spike& spike) {
    return through_ode(move, spike, 2e-3);
  });
}

// --- contacts that are held -------------------------------------------------------------------

/// Walls at +x and +y behind an arm that a push along y bends along x: away from the wall that the
/// tool leans on.
class BentArm {
 public:
  double wall_y_m = 0.03;
  double wall_stiffness_Npm = 1e4;
  double bend = 0.0;                ///< m along x for each m that the wall at +y yields
  double wall_x_ends_at_y_m = 1e9;  ///< beyond, nothing is at +x

  [[nodiscard]] GuardedMove::Input input(std::int64_t time_ns) const {
    GuardedMove::Input input;
    input.time_ns = time_ns;
    input.pose = tool_.state().pose;
    input.wrench = wrench();
    return input;
  }
  void step(const Setpoint& setpoint, double step_s) {
    constexpr int kSubsteps = 20;
    for (int i = 0; i < kSubsteps; ++i) tool_.update(setpoint, wrench(), step_s / kSubsteps);
  }
  void press(double x_m) {
    Pose pose;
    pose.position_m.x() = x_m;
    tool_.reset({pose});
  }

 private:
  [[nodiscard]] Vector6 wrench() const {
    const Vector3& p = tool_.state().pose.position_m;
    const double deep_y_m = std::max(0.0, p.y() - wall_y_m);
    const double deep_x_m = p.y() > wall_x_ends_at_y_m ? 0.0 : p.x() - bend * deep_y_m;
    Vector6 wrench = Vector6::Zero();
    wrench[0] = -wall_stiffness_Npm * std::max(0.0, deep_x_m);
    wrench[1] = -wall_stiffness_Npm * deep_y_m;
    return wrench;
  }
  Admittance tool_{Compliance{}};
};

GuardedMove::Result slide_into_the_corner(BentArm& arm) {
  constexpr double kStep_s = 10e-3;
  MoveParameters parameters = move_of(0.0, 0.06);
  parameters.thresholds.debounce_us = 20'000;
  arm.press(parameters.thresholds.force_keep_N / arm.wall_stiffness_Npm);
  GuardedMove move(parameters, {ContactSignature::bit(0, -1)});
  for (int i = 0;; ++i) {
    const GuardedMove::Output output = move.update(arm.input(std::llround(1e9 * kStep_s * i)));
    if (output.phase == GuardedMove::Phase::kDone) return *move.result();
    arm.step(output.setpoint, kStep_s);
  }
}

TEST(Probing, AContactThatIsPushedOffWhileAnotherIsMadeIsPressedOnAndStaysHeld) {
  for (const double bend : {0.0, 0.3, 0.6}) {
    BentArm arm;
    arm.bend = bend;
    const GuardedMove::Result result = slide_into_the_corner(arm);
    EXPECT_EQ(result.outcome, Outcome::kContact) << bend;
    EXPECT_EQ(to_string(result.signature), "-x -y") << bend;
    EXPECT_LT(arm.input(0).wrench[0], -MoveParameters{}.thresholds.force_off_N) << bend;
  }
}

TEST(Probing, AContactThatEndsWhileAnotherIsMadeIsNotInTheSettledSignature) {
  BentArm arm;
  arm.wall_x_ends_at_y_m = arm.wall_y_m + 1e-4;
  const GuardedMove::Result result = slide_into_the_corner(arm);
  EXPECT_EQ(result.outcome, Outcome::kContact);
  EXPECT_EQ(to_string(result.signature), "-y");
  // It looked for the wall for the time that settling has, with the keep force.
  EXPECT_LT(result.travelled[0], 1.5e-3);
}

}  // namespace
}  // namespace tenon

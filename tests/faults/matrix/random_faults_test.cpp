// A fault drawn at random, in a phase and a world drawn at random, with a magnitude, where it has
// one, between a tenth and ten times what a detector lets pass: the run is done and right, or
// stopped by a name and in its brakes, and pressed no harder than the bound on forces, a detector's
// time and what was forged say. Below a detector's threshold the forged amount counts as allowed.

#include <gtest/gtest.h>
#include <malloc.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <iterator>
#include <string>
#include <string_view>
#include <thread>
#include <utility>

#include "executor/faults/fault_bounds.h"
#include "shared/base/random.h"
#include "shared/base/text.h"
#include "shared/base/wilson.h"
#include "sim/cell/virtual_arm/environment_offset.h"
#include "tests/faults/matrix/driven_run.h"
#include "tests/faults/matrix/fault_kind.h"

namespace tenon::tests {
namespace {

using executor::EndReason;
using sim::FaultPhase;

/// A kind whose magnitude is drawn.
struct Scaled {
  const char* spec;  ///< the magnitude follows
  double threshold;  ///< that a detector, or the plan's tolerance, lets pass
  enum class Forges { kNothing, kPosition, kForce, kDrift } forges = Forges::kNothing;
};

// Thresholds: five cycles without an answer or a wrench; the feedback's deadline; one cycle in a
// hundred without all answers; 20 ms of a following error; the cell's force; (by the robot) a
// joint's full speed for a cycle; (likewise) what a tare shows of a drift; the heartbeat's timeout;
// six samples that are the same.
constexpr Scaled kScaled[] = {
    {"drop:node=JOINT,id=answers,duration_s=", 0.010},
    {"drop:node=SENSOR,id=answers,duration_s=", 0.010},
    {"stale-force:duration_s=", 0.010},
    {"torn-force:duration_s=", 0.010},
    {"delay:node=JOINT,id=answers,duration_s=100,delay_s=", 0.0014},
    {"drop:duration_s=100,probability=", 0.01},
    {"frozen-drive:node=JOINT,duration_s=", 0.020},
    {"forged-force:duration_s=0.02,force_N=", 60.0, Scaled::Forges::kForce},
    {"encoder-jump:node=JOINT,jump_m=", 0.0, Scaled::Forges::kPosition},
    {"drifting-force:duration_s=100,rate_Nps=", 0.0, Scaled::Forges::kDrift},
    {"drop:node=127,id=heartbeat,duration_s=", 0.3},
    {"drop:node=JOINT,id=heartbeat,duration_s=", 0.3},
    {"drop:node=JOINT,id=rpdo,duration_s=", 0.020},
    {"queue-full:node=127,duration_s=", 0.010},
    {"frozen-force:duration_s=", 0.012},
};

/// Kinds of the matrix that have no magnitude: they strike or they do not.
constexpr const char* kPlain[] = {"emergency",      "node reset",   "bus-off",
                                  "another master", "brake failed", "setpoints not finite"};

/// What an axis falls while the virtual drive's brake closes (10 ms) and a cycle more.
constexpr double kFallen_m = 0.5 * 9.81 * 0.012 * 0.012;

struct Tally {
  int done = 0;
  int stopped = 0;
  int wrong = 0;
  double pressed_most = 0.0;  ///< of what a run was pressed with, of its bound
  /// Runs that ended by each reason: an array, since a map's nodes would count as what runs leave
  /// behind.
  std::array<int, static_cast<std::size_t>(executor::kLastEndReason) + 1> by_reason{};
};

/// The rate that the halves of a tare show: six deviations of their difference, at three times the
/// sensor's noise.
double drift_Nps(const Robot& robot) {
  const double half = 0.5 * executor::kTareSamples;
  const double moved_N = 6.0 * 3.0 * robot.sensor.force_noise_N * std::sqrt(2.0 / half);
  return moved_N / (1e-6 * robot.cycle_us * half);
}

/// A fault as it was drawn.
struct Drawn {
  FaultKind kind;
  Scaled::Forges forges = Scaled::Forges::kNothing;
  double threshold = 0.0;
  double magnitude = 0.0;  ///< 0: the kind has none

  /// By which an encoder misreads, m or rad.
  [[nodiscard]] double misread() const {
    return forges == Scaled::Forges::kPosition ? magnitude : 0.0;
  }
  /// At most, over so long, N.
  [[nodiscard]] double forged_N(double acted_s) const {
    if (forges == Scaled::Forges::kForce) return magnitude;
    return forges == Scaled::Forges::kDrift ? magnitude * acted_s : 0.0;
  }
};

Drawn draw_plain(const char* name, const Robot& robot) {
  for (FaultKind& kind : fault_kinds(robot)) {
    if (std::string_view(kind.name) == name) return {.kind = std::move(kind)};
  }
  ADD_FAILURE() << "no kind is named " << name;
  return {};
}

Drawn draw_scaled(const Scaled& scaled, const Robot& robot, Random& random) {
  Drawn drawn{.kind = {}, .forges = scaled.forges, .threshold = scaled.threshold};
  // What a jump at a joint moves a tool by that is no further than a metre from its axis.
  const bool jumps = scaled.forges == Scaled::Forges::kPosition;
  if (jumps) drawn.threshold = 1e-6 * robot.cycle_us * robot.joints.front().speed_max;
  if (scaled.forges == Scaled::Forges::kDrift) drawn.threshold = drift_Nps(robot);
  drawn.magnitude = drawn.threshold * std::pow(10.0, 2.0 * random.uniform() - 1.0);
  std::string& spec = drawn.kind.spec;
  spec = scaled.spec + format("%g", drawn.magnitude);
  const bool turns = robot.joints.front().kind == Joint::Kind::kRevolute;
  if (jumps && turns) spec.replace(spec.find("jump_m"), 6, "jump_rad");
  return drawn;
}

/// What the parts were pressed with is within the bound on forces, what the contact adds while the
/// fault's detector has not named it, and what was forged.
void expect_bounded_force(const Ground& ground, const DrivenRun& run, const Drawn& drawn,
                          Tally& tally, const std::string& what) {
  const Robot& robot = ground.cell.robot;
  const double cycle_s = 1e-6 * robot.cycle_us;
  const executor::Ending ending = run.result().ending;
  const executor::FaultRow* row = executor::fault_row(ending.reason, ending.arm_fault.kind);
  const std::int64_t unnamed = row == nullptr ? 0 : executor::bound_cycles(*row, robot).value_or(0);
  const double acted_s = cycle_s * static_cast<double>(run.watch().since_struck());
  const double most_N = ground.force_most_N(cycle_s * static_cast<double>(unnamed)) +
                        drawn.forged_N(acted_s) +
                        ground.cell.contact_stiffness_Npm * drawn.misread();
  const double force_N = run.watch().truth_held().contact_force_N_max;
  tally.pressed_most = std::max(tally.pressed_most, force_N / most_N);
  EXPECT_LE(force_N, most_N) << what;
}

/// Brakes on and power off, or as is said at the start of drives that nobody reaches any more.
void expect_left_well(const Ground& ground, const DrivenRun& run, const Drawn& drawn,
                      double fallen_m, const std::string& what) {
  const executor::Ending ending = run.result().ending;
  if (ending.reason == EndReason::kBrakeFailed) {
    EXPECT_TRUE(run.rest().off()) << what;
  } else if (drawn.kind.master_is_lost && has_drives_without_reaction(ground.cell.robot)) {
    EXPECT_TRUE(run.rest().stands()) << what;
  } else {
    EXPECT_EQ(run.rest().complaints(drawn.misread() + fallen_m), "") << what;
  }
}

/// @param number of the run: all that is drawn follows from it
void run_drawn(const Ground& ground, std::uint64_t number, Tally& tally) {
  const Robot& robot = ground.cell.robot;
  Random random(stream_seed(number, "random_fault"));
  const auto below = [&](std::size_t count) {
    return static_cast<std::size_t>(random.uniform() * static_cast<double>(count));
  };
  const std::size_t which = below(std::size(kScaled) + std::size(kPlain));
  const auto phase = static_cast<FaultPhase>(below(sim::kFaultPhases));
  const Drawn drawn = which < std::size(kScaled)
                          ? draw_scaled(kScaled[which], robot, random)
                          : draw_plain(kPlain[which - std::size(kScaled)], robot);
  Strike strike;
  strike.phase = phase;
  strike.after_s = 0.3 * random.uniform();
  strike.seed = number;
  const Task& task = ground.planned.task;
  strike.offset = sim::draw_offset(task, task.starts.front(), number);

  DrivenRun run(ground, drawn.kind, strike);
  run.drive();
  const WholeRun::Result result = run.result();
  const std::string what = "run " + std::to_string(number) + ": " + drawn.kind.name +
                           drawn.kind.spec + " at " + std::to_string(static_cast<int>(phase)) +
                           ": " + result.reason;
  // A drive that is stopped while its brake opens has no power any more, and the brake takes a
  // while to hold again.
  expect_left_well(ground, run, drawn, phase == FaultPhase::kEnabling ? kFallen_m : 0.0, what);
  expect_bounded_force(ground, run, drawn, tally, what);
  EXPECT_NE(result.ending.reason, EndReason::kNone) << what;
  if (result.ending.reason != EndReason::kPlanDone) {
    ++tally.stopped;
    ++tally.by_reason[static_cast<std::size_t>(result.ending.reason)];
    return;
  }
  // A force that is forged pushes the compliant tool by it over its stiffness.
  const double acted_s = 1e-6 * robot.cycle_us * static_cast<double>(run.watch().since_struck());
  const double forged_m = drawn.magnitude > drawn.threshold
                              ? 0.0
                              : drawn.misread() + drawn.forged_N(acted_s) /
                                                      ground.planned.plan.compliance.stiffness_Npm;
  const bool right = result.truth.error_norm_m <= task.goal_tolerance_m + forged_m;
  right ? ++tally.done : ++tally.wrong;
  EXPECT_TRUE(right) << what
                     << format("; %.2f mm off, %.2f of them forged",
                               1e3 * result.truth.error_norm_m, 1e3 * forged_m);
}

void run_all_drawn(const char* robot, std::uint64_t count) {
  const Ground ground(robot);
  Tally tally;
  for (std::uint64_t number = 1; number <= count; ++number) run_drawn(ground, number, tally);
  const Interval wrong = wilson_interval(static_cast<std::size_t>(tally.wrong), count);
  std::printf(
      "%d runs: %d done, %d stopped by name, %d done but wrong, at most %.2f %% of all "
      "(Wilson, 95 %%); forces at most %.2f of their bounds\n",
      static_cast<int>(count), tally.done, tally.stopped, tally.wrong, 100.0 * wrong.high,
      tally.pressed_most);
  for (std::size_t i = 0; i < tally.by_reason.size(); ++i) {
    if (tally.by_reason[i] == 0) continue;
    std::printf("  %s: %d\n", executor::to_string(static_cast<EndReason>(i)), tally.by_reason[i]);
  }
  EXPECT_EQ(tally.wrong, 0);
  EXPECT_GT(tally.done, 0);
  EXPECT_GT(tally.stopped, 0);
}

/// What a process holds.
struct Held {
  std::size_t descriptors = 0;
  std::size_t threads = 0;
  std::size_t heap_bytes = 0;
};

Held held() {
  const auto entries = [](const char* folder) {
    const std::filesystem::directory_iterator all(folder);
    return static_cast<std::size_t>(std::distance(begin(all), end(all)));
  };
  return {entries("/proc/self/fd"), entries("/proc/self/task"), ::mallinfo2().uordblks};
}

/// What it holds once the kernel has put away a thread that has just been joined.
Held held_alone() {
  const auto patience = std::chrono::steady_clock::now() + std::chrono::seconds(1);
  Held now = held();
  while (now.threads > 1 && std::chrono::steady_clock::now() < patience) {
    std::this_thread::yield();
    now = held();
  }
  return now;
}

// Runs back to back, a fault at a random moment of each: every one ends and is accounted for, and
// what the process holds after them is no more than what it held after some of the first.
void soak(std::chrono::seconds duration) {
  constexpr std::uint64_t kFirst = 20;
  const auto end = std::chrono::steady_clock::now() + duration;
  const Ground ground("gantry3");
  Tally tally;
  Held first;
  std::uint64_t number = 0;
  while (number < 2 * kFirst || std::chrono::steady_clock::now() < end) {
    ++number;
    // A thread takes its cache of freed blocks, which count as held, with it.
    std::thread([&] { run_drawn(ground, number, tally); }).join();
    const Held now = held_alone();
    if (number <= kFirst) {
      first = {now.descriptors, now.threads, std::max(first.heap_bytes, now.heap_bytes)};
      continue;
    }
    ASSERT_EQ(now.descriptors, first.descriptors) << "run " << number;
    ASSERT_EQ(now.threads, first.threads) << "run " << number;
  }
  // A drawn fault may have a longer text than any before: a page.
  constexpr std::size_t kPage_bytes = 4096;
  EXPECT_LE(held().heap_bytes, first.heap_bytes + kPage_bytes);
  std::printf("%llu runs back to back: %d done, %d stopped by name, %zu bytes held, %zu at first\n",
              static_cast<unsigned long long>(number), tally.done, tally.stopped, held().heap_bytes,
              first.heap_bytes);
  EXPECT_EQ(static_cast<std::uint64_t>(tally.done + tally.stopped), number);
}

TEST(Soak, RunsBackToBackLeaveNothingBehind) { soak(std::chrono::seconds(60)); }

TEST(ManyRandomFaults, TenMinutesOfRunsBackToBackLeaveNothingBehind) {
  soak(std::chrono::minutes(10));
}

TEST(RandomFaults, AHundredAreRiddenOutOrNamed) { run_all_drawn("gantry3", 100); }

TEST(RandomFaults, SixAxesRideThemOutOrNameThem) { run_all_drawn("csp6", 10); }

TEST(ManyRandomFaults, TwoThousandAreRiddenOutOrNamed) { run_all_drawn("gantry3", 2000); }

}  // namespace
}  // namespace tenon::tests

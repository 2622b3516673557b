// The starts that a plan is judged from.

#include "planner/judge/judged_starts.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numeric>
#include <set>
#include <string>
#include <vector>

#include "planner/belief/belief.h"
#include "shared/base/text.h"
#include "tests/planner/room_plan.h"

namespace tenon::planner {
namespace {

TEST(JudgedStarts, ContactsAreSoftestAndStiffestWithEveryExtremeAndOnEverySideOfTheRim) {
  Task task = room_task();
  task.oversize_m = 1e-3;
  task.contact_give_mpN = 1.5e-5;
  Plan plan;
  plan.latency_max_s = 0.008;
  plan.contact_stiffness_Npm = 1e5;
  WallRollout rollout(room());
  const Start& start = task.starts.front();
  std::map<std::string, std::set<double>> stiffness_Npm;
  for (const JudgedStart& one : corner_starts(plan, task, start, rollout)) {
    const PhysicalParameters& its = one.particle.physics;
    const Vector6 off = displacement_between(start.pose, one.particle.tool());
    for (const std::string& with :
         {format("friction %g", its.friction), format("size %g", its.oversize_m),
          format("latency %g", its.latency_s), format("from %.4f %.4f", off.x(), off.y())}) {
      stiffness_Npm[with].insert(its.contact_stiffness_Npm);
    }
  }
  EXPECT_EQ(stiffness_Npm.size(), 14U) << "two of each, and four tips and four corners";
  for (const auto& [with, both] : stiffness_Npm) {
    EXPECT_EQ(both, (std::set<double>{4e4, 1e5})) << with;
  }

  std::vector<double> give_mpN;
  std::size_t at_an_end = 0;
  for (const JudgedStart& one :
       drawn_starts(3, 400, DrawnPhysics::kCorners, plan, task, start, rollout)) {
    const double k_Npm = one.particle.physics.contact_stiffness_Npm;
    give_mpN.push_back(1.0 / k_Npm - 1e-5);
    if (k_Npm == 4e4 || k_Npm == 1e5) ++at_an_end;
  }
  const auto [stiffest, softest] = std::minmax_element(give_mpN.begin(), give_mpN.end());
  EXPECT_NEAR(*stiffest, 0.0, 1e-12);
  EXPECT_NEAR(*softest, 1.5e-5, 1e-12);
  EXPECT_EQ(at_an_end, 200U);
  EXPECT_NEAR(std::accumulate(give_mpN.begin(), give_mpN.end(), 0.0) / 400.0, 0.75e-5, 0.1e-5);
}

TEST(JudgedStarts, ALookAtTheCornersHasEachOfThemOnceAndEveryPhysicsOnEverySide) {
  Task task = room_task();
  task.coordinates = 0b111111;
  task.starts.front().sigma << 0.03, 0.03, 0.03, 0.02, 0.02, 0.02;
  Plan plan;
  plan.latency_max_s = 0.008;
  WallRollout rollout(room());
  const Start& start = task.starts.front();
  const auto all = corner_starts(plan, task, start, rollout);
  const auto looked = screening_starts(plan, task, start, rollout);
  ASSERT_EQ(looked.size(), 76U);
  ASSERT_EQ(all.size(), 4 * looked.size());
  const auto physics_of = [](const JudgedStart& one) {
    return std::array{one.particle.physics.friction, one.particle.physics.latency_s};
  };
  for (std::size_t i = 0; i < looked.size(); ++i) {
    EXPECT_EQ(looked[i].particle.pose, all[4 * i].particle.pose);
    EXPECT_EQ(looked[i].particle.environment, all[4 * i].particle.environment);
  }
  for (int axis = 0; axis < 6; ++axis) {
    for (const double side : {-1.0, 1.0}) {
      std::set<std::array<double, 2>> physics;
      for (const JudgedStart& one : looked) {
        const Vector6 off = displacement_between(start.pose, one.particle.tool());
        if (side * off[axis] > 1e-6) physics.insert(physics_of(one));
      }
      EXPECT_EQ(physics.size(), 4U) << axis << " " << side;
    }
  }
}

/// Of the environment and of the part in the hand, in microradians.
using Urad = std::array<double, 6>;

Urad urad_of(const Tilt& tilt) {
  const Vector3 a = 1e6 * tilt.environment_rad;
  const Vector3 b = 1e6 * tilt.held_rad;
  Urad urad{a.x(), a.y(), a.z(), b.x(), b.y(), b.z()};
  for (double& one : urad) one = std::round(one) + 0.0;  // no -0
  return urad;
}

TEST(JudgedStarts, StartsOfAPassageHaveEveryTiltWithEverySizeFromAllOverTheRim) {
  Task task = room_task();
  task.tilt_rad = 3e-3;
  task.oversize_m = 1e-3;
  Plan plan;
  plan.latency_max_s = 0.008;
  WallRollout rollout(room());
  std::map<double, int> from_x;
  std::map<Urad, std::set<double>> sizes;
  for (const JudgedStart& one : passage_starts(plan, task, task.starts.front(), rollout)) {
    const Particle level = without_tilt(one.particle, task, task.starts.front());
    ++from_x[std::round(1e6 * level.tool().position_m.x())];
    const Tilt tilt = tilt_of(one.particle, task, task.starts.front());
    sizes[urad_of(tilt)].insert(one.particle.physics.oversize_m);
  }
  // Two tips along x, those along y between them, and the corners to either side.
  EXPECT_EQ(from_x.size(), 5U);
  for (const auto& [x_um, count] : from_x) EXPECT_GE(count, 2) << x_um;
  EXPECT_EQ(sizes.size(), 25U);
  for (const auto& [tilt, both] : sizes) EXPECT_EQ(both.size(), 2U) << tilt[0] << " " << tilt[1];
}

TEST(JudgedStarts, CornersAreTiltedInTurnAboutEveryAxisThatIsNoCoordinate) {
  Task task = room_task();
  task.coordinates = 0b010011;  // x, y and ry
  task.tilt_rad = 2e-3;
  task.starts.front().sigma[4] = 0.1;
  const Particle turned =
      particle_off(0.1 * Vector6::Unit(4), task, task.starts.front(), PhysicalParameters{});
  EXPECT_EQ(tilt_of(turned, task, task.starts.front()).norm_rad(), 0.0) << "a coordinate";
  task.starts.front().sigma[4] = 0.0;
  Plan plan;
  plan.latency_max_s = 0.008;
  WallRollout rollout(room());
  std::map<double, std::set<Urad>> tilts;  // by friction
  for (const JudgedStart& start : corner_starts(plan, task, task.starts.front(), rollout)) {
    const Start& nominal = task.starts.front();
    tilts[start.particle.physics.friction].insert(urad_of(tilt_of(start.particle, task, nominal)));
    const Particle level = without_tilt(start.particle, task, nominal);
    EXPECT_EQ(tilt_of(level, task, nominal).norm_rad(), 0.0);
    // The part is turned about the tool.
    EXPECT_EQ(level.pose.position_m, start.particle.pose.position_m);
    // About the goal, which stays where it is.
    EXPECT_LT(
        (compose(start.particle.environment, task.goal).position_m - task.goal.position_m).norm(),
        1e-12);
  }
  // Of the environment, of the part, of both, and of one against the other.
  constexpr std::array<std::array<double, 2>, 4> kKinds = {
      {{2000.0, 0.0}, {0.0, 2000.0}, {1414.0, 1414.0}, {1414.0, -1414.0}}};
  std::set<Urad> each = {Urad{}};
  for (const std::size_t axis : {0U, 2U}) {  // rx and rz
    for (const auto& [environment_urad, held_urad] : kKinds) {
      for (const double way : {1.0, -1.0}) {
        Urad one{};
        one[axis] = way * environment_urad;
        one[axis + 3] = way * held_urad + 0.0;
        each.insert(one);
      }
    }
  }
  ASSERT_EQ(tilts.size(), 2U);
  std::set<Urad> all;
  for (const auto& [friction, some] : tilts) {
    EXPECT_GT(some.size(), each.size() / 2) << "of friction " << friction;
    all.insert(some.begin(), some.end());
  }
  EXPECT_EQ(all, each);

  // What moves that turn with the tool go by has no turn that the arm does not know of.
  task.motion.carried_axes = true;
  const std::vector<JudgedStart> starts = corner_starts(plan, task, task.starts.front(), rollout);
  EXPECT_TRUE(std::all_of(starts.begin(), starts.end(), [&](const JudgedStart& start) {
    return tilt_of(start.particle, task, task.starts.front()).held_rad.isZero();
  }));
}

TEST(JudgedStarts, DrawsAreTiltedByAnythingUpToTheTasksTilt) {
  Task task = room_task();
  task.tilt_rad = 2e-3;
  WallRollout rollout(room());
  const auto drawn = [&] {
    return drawn_starts(5, 300, DrawnPhysics::kEven, Plan{}, task, task.starts.front(), rollout);
  };
  const std::vector<JudgedStart> tilted = drawn();
  Vector6 low = Vector6::Zero();
  Vector6 high = Vector6::Zero();
  for (const JudgedStart& start : tilted) {
    const Tilt tilt = tilt_of(start.particle, task, task.starts.front());
    EXPECT_LE(tilt.norm_rad(), 2e-3 + 1e-12);
    Vector6 both;
    both << tilt.environment_rad, tilt.held_rad;
    low = low.cwiseMin(both);
    high = high.cwiseMax(both);
  }
  EXPECT_LT(low.maxCoeff(), -1.3e-3);
  EXPECT_GT(high.minCoeff(), 1.3e-3);
  // Nothing else of them changes.
  task.tilt_rad = 0.0;
  const std::vector<JudgedStart> level = drawn();
  for (std::size_t i = 0; i < level.size(); ++i) {
    EXPECT_EQ(level[i].particle.pose.position_m, tilted[i].particle.pose.position_m);
    EXPECT_EQ(level[i].particle.physics, tilted[i].particle.physics);
    EXPECT_EQ(level[i].particle.pose.orientation.coeffs(),
              task.starts.front().pose.orientation.coeffs());
    EXPECT_EQ(level[i].particle.environment, Pose{});
  }
}

}  // namespace
}  // namespace tenon::planner

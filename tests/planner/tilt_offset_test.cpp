// What a tilt makes of a contact grows with its way to the goal's mouth, across what the tilt
// turns.

#include "planner/search/tilt_offset.h"

#include <gtest/gtest.h>

namespace tenon::planner {
namespace {

constexpr CoordinateMask kTranslations = 0b111;
const Pose kMouth{{0.1, 0.2, 0.3}, {1, 0, 0, 0}};

Task tilted_task(CoordinateMask coordinates) {
  Task task;
  task.coordinates = coordinates;
  task.tilt_rad = 3e-3;
  task.goal_uncertainty_m2 = 1e-8;  // 0.1 mm
  return task;
}

Pose off_mouth(const Vector3& off_m) { return {kMouth.position_m + off_m, kMouth.orientation}; }

TEST(TiltOffset, IsTheTiltTimesTheWayAcrossThePush) {
  const Task task = tilted_task(kTranslations);
  const Pose contact = off_mouth({0.03, 0.04, -0.12});
  EXPECT_NEAR(tilt_offset_m(task, 2, contact, kMouth), 3e-3 * 0.05, 1e-12);
  EXPECT_NEAR(tilt_offset_m(task, 1, contact, kMouth), 3e-3 * std::hypot(0.03, 0.12), 1e-12);
}

TEST(TiltOffset, IsNoneAboutAnAxisThatIsACoordinate) {
  const Task task = tilted_task(0b010111);  // x, y, z, ry
  EXPECT_DOUBLE_EQ(tilt_offset_m(task, 0, off_mouth({0.0, 0.0, 0.2}), kMouth), 0.0);
  EXPECT_NEAR(tilt_offset_m(task, 0, off_mouth({0.0, 0.2, 0.0}), kMouth), 6e-4, 1e-12);
}

TEST(TiltOffset, IsNoneOfARotationOrWhereItIsSmallBesideWhatMayBeLeft) {
  const Task task = tilted_task(kTranslations);
  EXPECT_DOUBLE_EQ(tilt_offset_m(task, 4, off_mouth({0.0, 0.0, 0.2}), kMouth), 0.0);
  EXPECT_DOUBLE_EQ(tilt_offset_m(task, 0, off_mouth({0.0, 0.0, 0.008}), kMouth), 0.0);
  EXPECT_GT(tilt_offset_m(task, 0, off_mouth({0.0, 0.0, 0.009}), kMouth), 0.0);
}

}  // namespace
}  // namespace tenon::planner

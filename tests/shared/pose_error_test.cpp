// The one convention of an environment that does not stand where it was said to.

#include "shared/task/pose_error.h"

#include <gtest/gtest.h>

#include "shared/base/random.h"

namespace tenon {
namespace {

// 30 degrees about z at (1, 0, 0), then 2 along x: written out by hand.
TEST(PoseError, TurnsAboutItsPointAndThenMoves) {
  Vector6 error = Vector6::Zero();
  error[0] = 2.0;
  error[5] = 0.5235987755982988;
  const Pose X_TE = environment_pose(error, {1.0, 0.0, 0.0});
  EXPECT_NEAR(X_TE.position_m.x(), 1.0 - 0.8660254037844387 + 2.0, 1e-12);
  EXPECT_NEAR(X_TE.position_m.y(), -0.5, 1e-12);
  EXPECT_NEAR(X_TE.orientation.z(), 0.25881904510252074, 1e-12);
}

TEST(PoseError, LeavesItsPointWhereItIsButForTheTranslation) {
  Random random(5);
  for (int i = 0; i < 100; ++i) {
    Vector6 error;
    for (int axis = 0; axis < 6; ++axis) error[axis] = random.uniform() - 0.5;
    const Vector3 about_m(random.uniform(), random.uniform(), random.uniform());
    const Pose X_TE = environment_pose(error, about_m);
    const Vector3 there_m = compose(X_TE, {about_m, {1, 0, 0, 0}}).position_m;
    EXPECT_LT((there_m - about_m - error.head<3>()).norm(), 1e-12);
  }
}

TEST(PoseError, WithoutErrorNothingChangesByABit) {
  const Vector3 about_m(0.3, -0.7, 0.1);
  EXPECT_EQ(environment_pose(Vector6::Zero(), about_m), Pose{});
  const Pose tool{{0.1, 0.2, 0.3}, rotation_of({0.1, 0.7, -0.3})};
  EXPECT_EQ(seen_from({}, tool), tool);
  EXPECT_EQ(seen_as({}, tool), tool);
}

TEST(PoseError, SeeingFromTheEnvironmentAndBackIsTheSamePose) {
  Vector6 error;
  error << 0.02, -0.01, 0.03, 0.1, -0.2, 0.15;
  const Pose environment = environment_pose(error, {0.1, 0.2, -0.3});
  const Pose tool{{0.1, 0.2, 0.3}, rotation_of({0.1, 0.7, -0.3})};
  const Pose back = seen_as(environment, seen_from(environment, tool));
  EXPECT_LT((back.position_m - tool.position_m).norm(), 1e-12);
  EXPECT_LT(back.orientation.angularDistance(tool.orientation), 1e-12);
}

}  // namespace
}  // namespace tenon

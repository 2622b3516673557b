// Where a part is held so that pushes against walls do not turn it.

#include "planner/new_task/push_middle.h"

#include <gtest/gtest.h>

#include "tests/support/example_parts.h"
#include "tests/support/meshes.h"

namespace tenon::planner {
namespace {

TEST(PushMiddle, OfABoxIsItsMiddle) {
  TriangleMesh box = tests::box_mesh({20e-3, 30e-3, 40e-3});
  for (Vector3& point_m : box.points_m) point_m += Vector3(5e-3, -2e-3, 0.0);
  const auto middle = push_middle_m(box, 1e-3);
  ASSERT_TRUE(middle);
  EXPECT_LT((*middle - Eigen::Vector2d(5e-3, -2e-3)).norm(), 1e-9);
  EXPECT_FALSE(push_middle_m(box, 0.1));
}

TEST(PushMiddle, OfAKeyedPegIsOnTheAxisOfItsRound) {
  // The box around it has its middle 1.5 mm beside the axis, on the key's side: a push along y
  // would turn it there.
  const auto middle = push_middle_m(tests::example_parts().at("keyed_peg.stl"), 5e-3);
  ASSERT_TRUE(middle);
  EXPECT_LT(middle->norm(), 0.3e-3);
}

}  // namespace
}  // namespace tenon::planner

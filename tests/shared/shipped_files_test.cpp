// The files in the tree load to what they say.

#include <gtest/gtest.h>

#include <cmath>
#include <cstddef>
#include <string>

#include "shared/config/load.h"
#include "tests/support/places.h"

namespace tenon {
namespace {

TEST(ShippedFiles, BoxOnTableHasTwelveStartsInsideItsWalls) {
  const Task task = load_task(tests::in_tree("planner/tasks/box_on_table_2d.yaml"));
  EXPECT_EQ(task.coordinates, 0b000011);
  ASSERT_EQ(task.starts.size(), 12U);
  for (std::size_t i = 0; i < task.starts.size(); ++i) {
    const Start& start = task.starts[i];
    EXPECT_EQ(start.name, std::to_string(i + 1));
    EXPECT_EQ(start.sigma, (Vector6() << 0.03, 0.03, 0, 0, 0, 0).finished());
    // The inner area is 1.00 x 0.80 m, half the box 0.05 m, the outermost draw 3 sigma away.
    EXPECT_LE(std::abs(start.pose.position_m.x()) + 0.05 + 0.09, 0.5);
    EXPECT_LE(std::abs(start.pose.position_m.y()) + 0.05 + 0.09, 0.4);
  }
  EXPECT_EQ(task.compliance.compliant_axes, 0b000011);
  EXPECT_EQ(task.motion, ParameterSet{});
  EXPECT_EQ(task.environment.size(), 5U);
}

TEST(ShippedFiles, GantryReachesEveryPlaceOfTheTable) {
  const Cell cell = load_cell(tests::in_tree("hw/cells/gantry3.yaml"));
  ASSERT_EQ(cell.robot.joints.size(), 3U);
  // Tool to flange: the gantry's flange is where its joints are.
  for (const double sign : {-1.0, 1.0}) {
    const Vector3 tool = cell.X_BT.position_m + sign * Vector3(0.5, 0.4, 0.0);
    const Vector3 flange = tool - cell.X_FP.position_m;
    for (int axis = 0; axis < 3; ++axis) {
      const Joint& joint = cell.robot.joints[static_cast<std::size_t>(axis)];
      EXPECT_EQ(joint.axis, Vector3::Unit(axis));
      EXPECT_GT(flange[axis], joint.lower);
      EXPECT_LT(flange[axis], joint.upper);
    }
  }
  EXPECT_EQ(cell.robot.cycle_us, 2000U);
  EXPECT_EQ(cell.robot.sensor.node, 4);
}

}  // namespace
}  // namespace tenon

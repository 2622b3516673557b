// What the part touches, by names that people know.

#include "shared/task/touched.h"

#include <gtest/gtest.h>

#include <set>
#include <string>

namespace tenon {
namespace {

using Names = std::set<std::string>;

Shape box_at(const std::string& name, double z_m) {
  Shape shape{name, Shape::Kind::kBox, {0.1, 0.1, 0.1}, {}};
  shape.pose.position_m.z() = z_m;
  return shape;
}

/// A table under the goal, and two walls of which one's name ends as the other's.
Task task_in(CoordinateMask coordinates) {
  Task task;
  task.coordinates = coordinates;
  task.environment = {box_at("table", -0.05), box_at("wall", 0.05), box_at("far_wall", 0.05)};
  return task;
}

TEST(Touched, PairsBecomeTheNamesOfTheEnvironment) {
  const Task task = task_in(0b000111);
  EXPECT_EQ(touched_pieces(task, {}), Names{});
  EXPECT_EQ(touched_pieces(task, {"cube-wall", "lid-wall"}), Names{"wall"});
  EXPECT_EQ(touched_pieces(task, {"cube-far_wall"}), Names{"far_wall"});
}

TEST(Touched, TheFloorCountsWhereTheTaskMovesAlongZAlone) {
  EXPECT_EQ(touched_pieces(task_in(0b000011), {"cube-table", "cube-wall"}), Names{"wall"});
  EXPECT_EQ(touched_pieces(task_in(0b000101), {"cube-table"}), Names{"table"});
}

}  // namespace
}  // namespace tenon

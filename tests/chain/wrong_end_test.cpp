// What is told of a run that was done and ended elsewhere.

#include <gtest/gtest.h>

#include "sim/evaluation_chain/trial_chain.h"

namespace tenon::sim {
namespace {

TEST(WrongEnd, SaysWhetherThePartIsInsertedWhereTheTaskAsksForIt) {
  Task task;
  task.goal_tolerance_m = 0.003;
  Truth truth;
  truth.error_norm_m = 0.02997;
  truth.tool.position_m.x() = 0.02997;
  EXPECT_EQ(wrong_end_text(task, truth),
            "the part is 29.97 mm, turned by 0.00 degrees, from its goal (allowed: 3 mm)");
  task.inserted.emplace();
  task.inserted->size_m = Vector3(0.01, 0.01, 0.01);
  EXPECT_NE(wrong_end_text(task, truth).find(" and not inserted"), std::string::npos);
  truth.tool.position_m.x() = 0.0;
  EXPECT_NE(wrong_end_text(task, truth).find(" and inserted"), std::string::npos);
}

}  // namespace
}  // namespace tenon::sim

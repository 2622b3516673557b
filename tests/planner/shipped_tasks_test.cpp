// Every start of every task that ships, in every variant, stands free with all its particles, and
// so does every goal.

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "planner/collision.h"
#include "planner/planner.h"
#include "shared/config/load.h"
#include "sim/physics/rollout/ode_rollout.h"
#include "tests/support/places.h"

namespace tenon::planner {
namespace {

TEST(ShippedTasks, EveryStartAndGoalOfEveryVariantIsFree) {
  std::size_t starts = 0;
  for (const std::string& file : tests::task_files()) {
    std::vector<std::string> names = {file};
    for (const std::string& variant : task_variants(file)) names.push_back(file + "#" + variant);
    for (const std::string& name : names) {
      const Task task = load_task(name);
      sim::OdeRollout rollout(task);
      for (const Start& start : task.starts) {
        EXPECT_EQ(collision(task, start, rollout), "") << name;
        ++starts;
      }
    }
  }
  EXPECT_GE(starts, 12U);
}

}  // namespace
}  // namespace tenon::planner

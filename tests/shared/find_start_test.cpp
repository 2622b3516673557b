// The start that a name means.

#include "shared/task/find_start.h"

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "tests/support/refusal.h"

namespace tenon {
namespace {

Task task_from(const std::vector<std::string>& names) {
  Task task;
  task.name = "box";
  for (const std::string& name : names) task.starts.emplace_back().name = name;
  return task;
}

TEST(FindStart, ANameMeansItsStartAndNothingElse) {
  const Task task = task_from({"1", "7", "77"});
  EXPECT_EQ(find_start(task, "7"), &task.starts[1]);
  EXPECT_EQ(find_start(task, "77"), &task.starts[2]);
  EXPECT_EQ(find_start(task, "17"), nullptr);
  EXPECT_EQ(find_start(task, ""), nullptr);
}

TEST(FindStart, WithoutANameItIsTheFirst) {
  const Task task = task_from({"1", "7"});
  EXPECT_EQ(&start_or_first(task, ""), &task.starts[0]);
  EXPECT_EQ(&start_or_first(task, "7"), &task.starts[1]);
}

TEST(FindStart, AnUnknownNameIsRefusedWithThoseThereAre) {
  const Task task = task_from({"1", "7"});
  EXPECT_EQ(tests::refusal([&] { (void)start_or_first(task, "8"); }),
            "task box: start \"8\" does not exist, must be one of 1, 7");
}

}  // namespace
}  // namespace tenon

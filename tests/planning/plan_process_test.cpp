// What tenon-plan's exit status says of a plan that it writes, as a user runs it.

#include <gtest/gtest.h>

#include <filesystem>
#include <string>
#include <vector>

#include "tests/support/commands.h"
#include "tests/support/places.h"

namespace tenon::tests {
namespace {

/// Planned for one pose alone, which the box task's uncertainty makes worthless, and the toy's not.
Ended plan_naively(const ScratchFolder& folder, const std::string& task,
                   const std::vector<std::string>& more) {
  std::vector<std::string> command = {executable("tenon-plan"), task, "--method",
                                      "single-particle",        "-o", folder.path() / "plan.tnp"};
  command.insert(command.end(), more.begin(), more.end());
  return run(folder, command);
}

constexpr const char* kWarning = "tenon-plan: warning: only ";

TEST(StrictPlanning, MakesAWarnedOfPlanAFailure) {
  const ScratchFolder folder;
  const Ended lax = plan_naively(folder, box_task_file(), {});
  EXPECT_EQ(lax.status, 0) << lax.err;
  EXPECT_EQ(lax.err.rfind(kWarning, 0), 0U) << lax.err;
  std::filesystem::remove(folder.path() / "plan.tnp");
  const Ended strict = plan_naively(folder, box_task_file(), {"--strict"});
  EXPECT_EQ(strict.status, 1);
  EXPECT_EQ(strict.err, lax.err);
  // To be looked at.
  EXPECT_TRUE(std::filesystem::exists(folder.path() / "plan.tnp"));
}

TEST(StrictPlanning, LetsAPlanPassThatNothingIsSaidOf) {
  const ScratchFolder folder;
  const Ended ended = plan_naively(folder, in_tree("planner/tasks/toy_1d.yaml"), {"--strict"});
  EXPECT_EQ(ended.status, 0) << ended.err;
  EXPECT_EQ(ended.err, "");
}

TEST(StrictPlanning, IsOfPlansAlone) {
  const ScratchFolder folder;
  const Ended ended =
      run(folder, {executable("tenon-plan"), "--check", box_task_file(), "--strict"});
  EXPECT_EQ(ended.status, 2);
  EXPECT_NE(ended.err.find("excludes --strict"), std::string::npos) << ended.err;
}

}  // namespace
}  // namespace tenon::tests

// Where an evaluation lets the arm stand at first: of all ways in which the tool can be at the
// start the one that the plan has room from.

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <string>

#include "tests/support/commands.h"
#include "tests/support/places.h"
#include "tests/support/planned.h"
#include "tests/support/scratch_folder.h"

namespace tenon::tests {
namespace {

class EvaluatedStart : public testing::TestWithParam<const char*> {};

TEST_P(EvaluatedStart, IsOneFromWhichTheArmCanExecuteThePlan) {
  constexpr int kRuns = 6;
  const ScratchFolder folder;
  const Ended evaluated =
      run(folder,
          {executable("tenon-evaluate"), "--cell", in_tree("hw/cells/csp6_bench.yaml"), "--task",
           in_tree("planner/tasks/box_on_table_se2.yaml"), "--plan", shared_plan(GetParam()), "-n",
           std::to_string(kRuns), "--seed", "61503", "--json", folder.path() / "evaluated.json"});
  ASSERT_EQ(evaluated.status, 0) << evaluated.err;
  const auto result = nlohmann::json::parse(folder.get("evaluated.json"));
  const auto& summary = result.at("plans")[0].at("summary");
  EXPECT_EQ(summary.at("success").at("succeeded").get<int>(), kRuns) << evaluated.out;
}

INSTANTIATE_TEST_SUITE_P(Full, EvaluatedStart, testing::Values("box_se2_csp6_bench"),
                         [](const auto& each) { return std::string(each.param); });

}  // namespace
}  // namespace tenon::tests

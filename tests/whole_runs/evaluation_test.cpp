// A small evaluation, as a user makes it.

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <string>

#include "tests/support/harsh_evaluation.h"

namespace tenon::tests {
namespace {

TEST(WholeEvaluation, SomeOfTheRunsFailAndAllOfThemAreKept) {
  const HarshEvaluation harsh;
  const Ended ended =
      harsh.evaluate({"--json", harsh.path("whole.json"), "--report", harsh.path("whole.html"),
                      "--figures", harsh.path("figures")});
  ASSERT_EQ(ended.status, 0) << ended.err;
  const auto json = nlohmann::json::parse(harsh.folder.get("whole.json"));
  const auto& plan = json["plans"][0];
  EXPECT_EQ(plan["runs"].size(), HarshEvaluation::kRuns);
  const int succeeded = plan["summary"]["success"]["succeeded"];
  EXPECT_GT(succeeded, 0);
  EXPECT_LT(succeeded, HarshEvaluation::kRuns);
  for (const auto& made : plan["runs"]) EXPECT_FALSE(made["reason"].get<std::string>().empty());
}

}  // namespace
}  // namespace tenon::tests

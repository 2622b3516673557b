// An evaluation's runs, fanned out over threads.

#include <gtest/gtest.h>

#include "tests/support/harsh_evaluation.h"

namespace tenon::tests {
namespace {

TEST(EvaluationThreads, TwoGiveTheBytesOfOne) {
  const HarshEvaluation harsh;
  for (const char* threads : {"1", "2"}) {
    const std::string name = std::string("on_") + threads + ".json";
    const Ended ended = harsh.evaluate({"--threads", threads, "--json", harsh.path(name)});
    ASSERT_EQ(ended.status, 0) << ended.err;
  }
  EXPECT_GT(harsh.folder.get("on_1.json").size(), 1000U);
  EXPECT_EQ(harsh.folder.get("on_2.json"), harsh.folder.get("on_1.json"));
}

}  // namespace
}  // namespace tenon::tests

// tenon-evaluate as a user runs it: the same bytes however the runs were made.

#include <gtest/gtest.h>

#include <algorithm>
#include <csignal>
#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>
#include <string>
#include <vector>

#include "tests/support/child_process.h"
#include "tests/support/harsh_evaluation.h"

namespace tenon::tests {
namespace {

class Evaluate : public testing::Test, protected HarshEvaluation {
 protected:
  /// What one call on one thread writes, whole.json and whole.jsonl: what all the rest is held to.
  void make_whole() const {
    const Ended whole = evaluate({"--json", path("whole.json")});
    ASSERT_EQ(whole.status, 0) << whole.err;
  }

  [[nodiscard]] std::size_t lines_in(const std::string& name) const {
    const std::string text = folder.get(name);
    return static_cast<std::size_t>(std::count(text.begin(), text.end(), '\n'));
  }
};

TEST_F(Evaluate, KilledAndResumedItGivesTheSameBytes) {
  make_whole();
  {
    ChildProcess child(folder.path(), command({"--json", path("killed.json")}));
    EXPECT_TRUE(child.wait_until([&] { return lines_in("killed.jsonl") >= 3; }));
    child.send(SIGKILL);
    child.wait();
  }
  EXPECT_LT(lines_in("killed.jsonl"), kRuns + 1U);
  std::ofstream(path("killed.jsonl"), std::ios::app) << R"({"plan":"0123)";  // torn
  const Ended ended = evaluate({"--json", path("killed.json")});
  ASSERT_EQ(ended.status, 0) << ended.err;
  EXPECT_NE(ended.out.find("are there already"), std::string::npos) << ended.out;
  EXPECT_EQ(folder.get("killed.json"), folder.get("whole.json"));
  EXPECT_EQ(lines_in("killed.jsonl"), kRuns + 1U);
}

TEST_F(Evaluate, TwoShardsMergedGiveTheSameBytes) {
  make_whole();
  for (const std::string shard : {"1", "2"}) {
    const Ended ended = evaluate({"--shard", shard + "/2", "--runs", path(shard + ".jsonl")});
    ASSERT_EQ(ended.status, 0) << ended.err;
    EXPECT_EQ(lines_in(shard + ".jsonl"), kRuns / 2 + 1U);
  }
  const Ended ended =
      run(folder,
          command({"--merge", path("1.jsonl"), path("2.jsonl"), "--json", path("merged.json")}));
  ASSERT_EQ(ended.status, 0) << ended.err;
  EXPECT_NE(ended.out.find("8 of 8 runs are there already"), std::string::npos) << ended.out;
  EXPECT_EQ(folder.get("merged.json"), folder.get("whole.json"));
}

TEST_F(Evaluate, AFailedRunMadeAgainGivesTheSameLine) {
  make_whole();
  const auto json = nlohmann::json::parse(folder.get("whole.json"));
  for (const auto& made : json["plans"][0]["runs"]) {
    if (made["class"] == "succeeded") continue;
    const std::string number = std::to_string(made["run"].get<int>());
    const Ended ended = evaluate({"--only", number});
    ASSERT_EQ(ended.status, 0) << ended.err;
    const std::string log = folder.get("whole.jsonl");
    const std::size_t at = log.find("\"run\":" + number + ",");
    ASSERT_NE(at, std::string::npos);
    const std::size_t begin = log.rfind('\n', at) + 1;
    EXPECT_NE(ended.out.find(log.substr(begin, log.find('\n', at) - begin)), std::string::npos)
        << ended.out;
    return;
  }
  FAIL() << "no run failed";
}

TEST_F(Evaluate, TheSummaryIsTheResultWithoutItsRuns) {
  make_whole();
  const Ended ended = evaluate({"--runs", path("whole.jsonl"), "--summary", path("summary.json"),
                                "--figures", path("figures")});
  ASSERT_EQ(ended.status, 0) << ended.err;
  auto whole = nlohmann::ordered_json::parse(folder.get("whole.json"));
  whole["plans"][0].erase("runs");
  EXPECT_EQ(folder.get("summary.json"), whole.dump(1) + "\n");
  for (const std::string figure : {"runs", "draws", "ends", "errors"}) {
    EXPECT_EQ(folder.get("figures/start_1_" + figure + ".svg").rfind("<svg xmlns=", 0), 0U);
  }
}

TEST_F(Evaluate, TheBlackBoxHoldsEveryCycleOfTheRunThatIsTold) {
  const Ended ended = evaluate({"--only", "0", "--black-box", path("run.csv")});
  ASSERT_EQ(ended.status, 0) << ended.err;
  std::istringstream csv(folder.get("run.csv"));
  std::string line;
  std::getline(csv, line);
  EXPECT_EQ(line.rfind("sequence,time_ns,", 0), 0U) << line;
  long long cycles = 0;
  while (std::getline(csv, line)) ASSERT_EQ(std::stoll(line), cycles++) << line;
  // The run takes seconds, at 500 Hz.
  EXPECT_GT(cycles, 1000);
}

TEST_F(Evaluate, WhatAFullDiskTookIsNamedAndNoSuccess) {
  make_whole();
  const auto on_a_full_disk = [&](const std::vector<std::string>& more) {
    std::vector<std::string> all = command(more);
    all.insert(all.begin(), {"prlimit", "--fsize=6000:6000"});
    return run(folder, all);
  };
  const Ended made = on_a_full_disk(
      {"--runs", path("whole.jsonl"), "--report", path("out.html"), "--summary", path("out.json")});
  EXPECT_EQ(made.status, 1);
  EXPECT_EQ(made.err, "tenon-evaluate: lost: --report " + path("out.html") +
                          ": cannot be written: File too large\n");
  EXPECT_FALSE(folder.get("out.json").empty());
  const Ended told = on_a_full_disk({"--only", "0", "--black-box", path("run.csv")});
  EXPECT_EQ(told.status, 1);
  EXPECT_NE(told.err.find("lost: --black-box " + path("run.csv")), std::string::npos) << told.err;
}

TEST_F(Evaluate, BadUsageOfTheBlackBoxIsOneLineAndExitsTwo) {
  const std::string csv = path("bad.csv");
  const std::vector<std::pair<std::vector<std::string>, std::string>> bad = {
      {{"--black-box", csv}, "--only"},
      {{"--only", "0", "--black-box", csv, "--plan", plan_file}, "give one --plan"},
      {{"--only", "0", "--black-box", path("none/run.csv")}, "none/run.csv"},
  };
  for (const auto& [more, named] : bad) {
    const Ended ended = evaluate(more);
    EXPECT_EQ(ended.status, 2) << named;
    EXPECT_EQ(std::count(ended.err.begin(), ended.err.end(), '\n'), 1) << ended.err;
    EXPECT_NE(ended.err.find(named), std::string::npos) << ended.err;
  }
}

TEST_F(Evaluate, BadUsageIsOneLineAndExitsTwo) {
  const std::vector<std::pair<std::vector<std::string>, std::string>> bad = {
      {{"--shard", "3/2"}, "--shard \"3/2\""},
      {{"--shard", "0/2"}, "--shard \"0/2\""},
      {{"--by", "colour=0:1:2"}, "colour"},
      {{"--by", "friction=0.7:0.9:2"}, "no draw"},
      {{"--plan", plan_file}, "give it once"},
      {{"--merge", path("none.jsonl")}, "none.jsonl"},
      {{"--merge", plan_file}, "start_1.tnp"},
      {{"--json", path("none/out.json")}, "none/out.json"},
      {{"--figures", plan_file}, "start_1.tnp"},
      {{"--summary", path("none/out.json")}, "none/out.json"},
      {{"--json", path("out.jsonl")}, "out.jsonl"},
      {{"--json", path("one.json"), "--summary", path("./one.json")}, "one.json"},
      {{"--only", "-1"}, "--only"},
      {{"--only", "0", "--json", path("out.json")}, "--only"},
  };
  for (const auto& [more, named] : bad) {
    const Ended ended = evaluate(more);
    EXPECT_EQ(ended.status, 2) << named;
    EXPECT_EQ(std::count(ended.err.begin(), ended.err.end(), '\n'), 1) << ended.err;
    EXPECT_NE(ended.err.find(named), std::string::npos) << ended.err;
  }
}

}  // namespace
}  // namespace tenon::tests

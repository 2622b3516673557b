// tenon-evaluate as a user runs it: the same bytes however the runs were made.

#include <gtest/gtest.h>

#include <algorithm>
#include <csignal>
#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>
#include <string>
#include <vector>

#include "tests/chain/commands.h"
#include "tests/support/child_process.h"
#include "tests/support/sim_process.h"

namespace tenon::tests {
namespace {

// A sensor that drifts so much that some runs fail.
constexpr const char* kHarshWorld =
    "name: harsh\nfriction: [0.1, 0.6]\nforce_drift_N_sqrts: [0.0, 1.2]\n";
constexpr int kRuns = 8;

class Evaluate : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    folder = new ScratchFolder;
    plan_file = plan_by_command(*folder, "1");
    experiment_file = folder->put("harsh.yaml", kHarshWorld);
    const Ended whole = run(*folder, command({"--json", path("whole.json")}));
    if (whole.status != 0) throw std::runtime_error(whole.err);
  }
  static void TearDownTestSuite() {
    delete folder;
    folder = nullptr;
  }

  static std::string path(const std::string& name) { return folder->path() / name; }

  static std::vector<std::string> command(const std::vector<std::string>& more) {
    std::vector<std::string> all = {TENON_EVALUATE_EXE,
                                    "--cell",
                                    gantry_cell_file(),
                                    "--task",
                                    box_task_file(),
                                    "--plan",
                                    plan_file,
                                    "--experiment",
                                    experiment_file,
                                    "--seed",
                                    "5"};
    if (std::find(more.begin(), more.end(), "--only") == more.end()) {
      all.insert(all.end(), {"-n", std::to_string(kRuns)});
    }
    all.insert(all.end(), more.begin(), more.end());
    return all;
  }

  static std::size_t lines_in(const std::string& name) {
    const std::string text = folder->get(name);
    return static_cast<std::size_t>(std::count(text.begin(), text.end(), '\n'));
  }

  inline static ScratchFolder* folder = nullptr;
  inline static std::string plan_file;
  inline static std::string experiment_file;
};

TEST_F(Evaluate, SomeOfTheRunsFailAndAllOfThemAreKept) {
  const auto json = nlohmann::json::parse(folder->get("whole.json"));
  const auto& plan = json["plans"][0];
  EXPECT_EQ(plan["runs"].size(), kRuns);
  const int succeeded = plan["summary"]["success"]["succeeded"];
  EXPECT_GT(succeeded, 0);
  EXPECT_LT(succeeded, kRuns);
  for (const auto& made : plan["runs"]) EXPECT_FALSE(made["reason"].get<std::string>().empty());
}

TEST_F(Evaluate, TwoThreadsGiveTheBytesOfOne) {
  const Ended ended = run(*folder, command({"--threads", "2", "--json", path("two.json")}));
  ASSERT_EQ(ended.status, 0) << ended.err;
  EXPECT_EQ(folder->get("two.json"), folder->get("whole.json"));
}

TEST_F(Evaluate, KilledAndResumedItGivesTheSameBytes) {
  {
    ChildProcess child(folder->path(), command({"--json", path("killed.json")}));
    EXPECT_TRUE(child.wait_until([] { return lines_in("killed.jsonl") >= 3; }));
    child.send(SIGKILL);
    child.wait();
  }
  EXPECT_LT(lines_in("killed.jsonl"), kRuns + 1U);
  std::ofstream(path("killed.jsonl"), std::ios::app) << R"({"plan":"0123)";  // torn
  const Ended ended = run(*folder, command({"--json", path("killed.json")}));
  ASSERT_EQ(ended.status, 0) << ended.err;
  EXPECT_NE(ended.out.find("are there already"), std::string::npos) << ended.out;
  EXPECT_EQ(folder->get("killed.json"), folder->get("whole.json"));
  EXPECT_EQ(lines_in("killed.jsonl"), kRuns + 1U);
}

TEST_F(Evaluate, TwoShardsMergedGiveTheSameBytes) {
  for (const std::string shard : {"1", "2"}) {
    const Ended ended =
        run(*folder, command({"--shard", shard + "/2", "--runs", path(shard + ".jsonl")}));
    ASSERT_EQ(ended.status, 0) << ended.err;
    EXPECT_EQ(lines_in(shard + ".jsonl"), kRuns / 2 + 1U);
  }
  const Ended ended =
      run(*folder,
          command({"--merge", path("1.jsonl"), path("2.jsonl"), "--json", path("merged.json")}));
  ASSERT_EQ(ended.status, 0) << ended.err;
  EXPECT_NE(ended.out.find("8 of 8 runs are there already"), std::string::npos) << ended.out;
  EXPECT_EQ(folder->get("merged.json"), folder->get("whole.json"));
}

TEST_F(Evaluate, AFailedRunMadeAgainGivesTheSameLine) {
  const auto json = nlohmann::json::parse(folder->get("whole.json"));
  for (const auto& made : json["plans"][0]["runs"]) {
    if (made["class"] == "succeeded") continue;
    const std::string number = std::to_string(made["run"].get<int>());
    const Ended ended = run(*folder, command({"--only", number}));
    ASSERT_EQ(ended.status, 0) << ended.err;
    const std::string log = folder->get("whole.jsonl");
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
  const Ended ended = run(*folder, command({"--runs", path("whole.jsonl"), "--summary",
                                            path("summary.json"), "--figures", path("figures")}));
  ASSERT_EQ(ended.status, 0) << ended.err;
  auto whole = nlohmann::ordered_json::parse(folder->get("whole.json"));
  whole["plans"][0].erase("runs");
  EXPECT_EQ(folder->get("summary.json"), whole.dump(1) + "\n");
  for (const std::string figure : {"runs", "draws", "ends", "errors"}) {
    EXPECT_EQ(folder->get("figures/start_1_" + figure + ".svg").rfind("<svg xmlns=", 0), 0U);
  }
}

TEST_F(Evaluate, TheBlackBoxHoldsEveryCycleOfTheRunThatIsTold) {
  const Ended ended = run(*folder, command({"--only", "0", "--black-box", path("run.csv")}));
  ASSERT_EQ(ended.status, 0) << ended.err;
  std::istringstream csv(folder->get("run.csv"));
  std::string line;
  std::getline(csv, line);
  EXPECT_EQ(line.rfind("sequence,time_ns,", 0), 0U) << line;
  long long cycles = 0;
  while (std::getline(csv, line)) ASSERT_EQ(std::stoll(line), cycles++) << line;
  // The run takes seconds, at 500 Hz.
  EXPECT_GT(cycles, 1000);
}

TEST_F(Evaluate, BadUsageOfTheBlackBoxIsOneLineAndExitsTwo) {
  const std::string csv = path("bad.csv");
  const std::vector<std::pair<std::vector<std::string>, std::string>> bad = {
      {{"--black-box", csv}, "--only"},
      {{"--only", "0", "--black-box", csv, "--plan", plan_file}, "give one --plan"},
      {{"--only", "0", "--black-box", path("none/run.csv")}, "none/run.csv"},
  };
  for (const auto& [more, named] : bad) {
    const Ended ended = run(*folder, command(more));
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
    const Ended ended = run(*folder, command(more));
    EXPECT_EQ(ended.status, 2) << named;
    EXPECT_EQ(std::count(ended.err.begin(), ended.err.end(), '\n'), 1) << ended.err;
    EXPECT_NE(ended.err.find(named), std::string::npos) << ended.err;
  }
}

}  // namespace
}  // namespace tenon::tests

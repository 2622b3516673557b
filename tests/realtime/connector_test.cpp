// The demo in real time: six axes plug a connector in, of triangles and with half a millimetre to
// each side; and every task that is shipped, on the cell that demo.sh takes for it. Nothing here
// depends on how fast the machine is: a run that ended because it came too late too often is
// repeated.

#include <gtest/gtest.h>

#include <chrono>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "tests/support/busy_machine.h"
#include "tests/support/child_process.h"
#include "tests/support/commands.h"
#include "tests/support/places.h"
#include "tests/support/scratch_folder.h"
#include "tests/support/sim_process.h"

namespace tenon::tests {
namespace {

TEST(Connector, IsPluggedInBySixAxesInRealTime) {
  const ScratchFolder folder;
  const std::string cell = in_tree("hw/cells/csp6_bench.yaml");
  const std::string truth = folder.path() / "truth.json";
  const std::string result = folder.path() / "result.json";
  int status = 0;
  Attempts attempts;
  do {
    std::filesystem::remove(folder.path() / "ready");
    SimProcess sim(folder.path(), "1",
                   {"--once", "--offset", "x_m=0.002,y_m=-0.0025,z_m=0.001", "--json", truth}, cell,
                   in_tree("planner/tasks/connector.yaml"));
    ChildProcess exec(folder.path(),
                      {executable("tenon-exec"), "--cell", cell, "--plan",
                       shared_plan("connector_csp6_bench"), "--can", sim.uri(), "--lcm-url", "none",
                       "--json", result, "--black-box", folder.path() / "box.csv"});
    status = exec.wait();
    EXPECT_EQ(sim.process().wait(), 0) << sim.process().err();
  } while (status == 1 && attempts.again(nlohmann::json::parse(folder.get("result.json"))));
  ASSERT_EQ(status, 0) << folder.get("result.json");
  EXPECT_EQ(nlohmann::json::parse(folder.get("result.json")).at("reason"), "plan_done");
  EXPECT_EQ(nlohmann::json::parse(folder.get("truth.json")).at("within_tolerance"), true);
  EXPECT_EQ(nlohmann::json::parse(folder.get("truth.json")).at("solver_messages"), 0);
}

/// demo.sh as it is typed, but for the build; what of it is wrong is said of the task.
void expect_demo(const std::string& task, const std::vector<std::string>& options) {
  SCOPED_TRACE(task);
  const ScratchFolder folder;
  const auto bin = std::filesystem::path(executable("tenon-plan")).parent_path();
  std::vector<std::string> words = {in_tree("demo.sh"), "--bin", bin, "--output",
                                    folder.path() / "demo"};
  words.insert(words.end(), options.begin(), options.end());
  Ended ended;
  Attempts attempts;
  do {
    ended = run(folder, words, std::chrono::minutes(20));
  } while (ended.status == 1 && std::filesystem::exists(folder.path() / "demo/result.json") &&
           attempts.again(nlohmann::json::parse(folder.get("demo/result.json"))));
  ASSERT_EQ(ended.status, 0) << ended.out << ended.err;
  EXPECT_NE(ended.out.find("== Plan: " + task + ","), std::string::npos) << ended.out;
  EXPECT_NE(ended.out.find("done: plan '" + task + "' done"), std::string::npos) << ended.out;
  EXPECT_NE(ended.out.find("from its goal, within the tolerance"), std::string::npos) << ended.out;
  for (const char* page : {"demo/plan.html", "demo/run.html"}) {
    EXPECT_NE(folder.get(page).find(task), std::string::npos) << page;
  }
}

TEST(Demo, PlansAndPlugsTheConnectorInWithoutAnyOption) { expect_demo("connector", {}); }

TEST(Demo, PlansAndExecutesEveryTaskThatIsShipped) {
  for (const std::filesystem::path file : task_files()) {
    const std::string task = file.stem();
    if (task != "connector") expect_demo(task, {"--task", task});
  }
}

}  // namespace
}  // namespace tenon::tests

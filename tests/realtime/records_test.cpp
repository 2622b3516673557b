// What a run leaves behind where the disk takes no more: the arm's work is done all the same, and
// whoever asked for a record is told what is missing in it. Repeated once where the machine was too
// busy for real time.

#include <gtest/gtest.h>

#include <csignal>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "tests/support/bad_input.h"
#include "tests/support/busy_machine.h"
#include "tests/support/child_process.h"
#include "tests/support/commands.h"
#include "tests/support/places.h"
#include "tests/support/sim_process.h"

namespace tenon::tests {
namespace {

// Holds the result, and no log of a run.
constexpr const char* kFullDisk = "--fsize=40000:40000";

// The plan for start 4, on a disk that is soon full.
class RunOnAFullDisk {
 public:
  RunOnAFullDisk()
      : sim_(folder_.path(), "4", {"--once"}),
        exec_(folder_.path(), {"prlimit",
                               kFullDisk,
                               executable("tenon-exec"),
                               "--cell",
                               gantry_cell_file(),
                               "--plan",
                               put_box_plan(folder_, "4"),
                               "--can",
                               sim_.uri(),
                               "--lcm-url",
                               "none",
                               "--log",
                               folder_.path() / "log",
                               "--can-log",
                               folder_.path() / "candump",
                               "--trace",
                               folder_.path() / "trace",
                               "--black-box",
                               folder_.path() / "box.csv",
                               "--json",
                               folder_.path() / "result.json"}) {}

  [[nodiscard]] ChildProcess& sim() { return sim_.process(); }
  [[nodiscard]] ChildProcess& exec() { return exec_; }
  [[nodiscard]] nlohmann::json result() const {
    return nlohmann::json::parse(folder_.get("result.json"), nullptr, false);
  }
  /// Ends it. Whether it has to be made again.
  [[nodiscard]] bool again(Attempts& attempts) {
    return exec_.wait() == 1 && result().is_object() && attempts.again(result());
  }
  [[nodiscard]] std::string last_line() const {
    std::string text = exec_.err();
    if (text.ends_with('\n')) text.pop_back();
    return text.substr(text.rfind('\n') + 1);
  }

 private:
  ScratchFolder folder_;
  SimProcess sim_;
  ChildProcess exec_;
};

TEST(Records, ADiskThatIsFullIsCountedAndNamedAndTheArmsWorkIsDoneAllTheSame) {
  Attempts attempts;
  std::unique_ptr<RunOnAFullDisk> run;
  do {
    run = std::make_unique<RunOnAFullDisk>();
  } while (run->again(attempts));
  EXPECT_EQ(run->exec().wait(), 1) << run->exec().err();
  const nlohmann::json result = run->result();
  ASSERT_TRUE(result.is_object()) << run->exec().err();
  EXPECT_EQ(result.at("status"), "done");
  EXPECT_EQ(result.at("exit_code"), 1);
  ASSERT_EQ(result.at("records").size(), 3U);
  for (const nlohmann::json& record : result["records"]) {
    EXPECT_GT(record.at("lost"), 0) << record;
    EXPECT_GT(record.at("written"), 0) << record;
    EXPECT_EQ(record.at("reason"), "File too large");
  }
  for (const char* option : {"--log", "--can-log", "--trace"}) {
    EXPECT_NE(run->last_line().find(std::string(option) + " "), std::string::npos)
        << run->last_line();
  }
}

TEST(Records, ABlackBoxThatCannotBeWrittenTakesNothingWithIt) {
  Attempts attempts;
  std::unique_ptr<RunOnAFullDisk> run;
  do {
    run = std::make_unique<RunOnAFullDisk>();
    if (run->exec().wait_until(
            [&] { return run->exec().out().find("step  0:") != std::string::npos; })) {
      run->sim().send(SIGKILL);
    }
  } while (run->again(attempts));
  EXPECT_EQ(run->exec().wait(), 1) << run->exec().err();
  const nlohmann::json result = run->result();
  ASSERT_TRUE(result.is_object()) << run->exec().err();
  EXPECT_EQ(result.at("status"), "failed");
  EXPECT_EQ(result.at("records").back().at("name"), "black_box");
  EXPECT_GT(result["records"].back().at("lost"), 0);
  EXPECT_NE(run->last_line().find("--black-box "), std::string::npos) << run->last_line();
}

// What the bus said is then what somebody looks for.
TEST(Records, ABringUpThatFailsTellsWhatItsLogLost) {
  const ScratchFolder folder;
  // The third of three drives: most of the bring-up has passed by then.
  const std::string elsewhere =
      cell_around(folder, "elsewhere.yaml",
                  edited(folder, "robot.yaml", robot_file(), "    node: 3\n    mode: 8",
                         "    node: 3\n    mode: 7"));
  const SimProcess sim(folder.path(), "4", {}, elsewhere);
  const Ended ended =
      run(folder, {"prlimit", "--fsize=2000:2000", executable("tenon-exec"), "--cell",
                   gantry_cell_file(), "--plan", put_box_plan(folder, "4"), "--can", sim.uri(),
                   "--rt", "off", "--lcm-url", "none", "--can-log", folder.path() / "candump"});
  EXPECT_EQ(ended.status, 2) << ended.err;
  EXPECT_NE(ended.err.find("tenon-exec: lost: --can-log "), std::string::npos) << ended.err;
  EXPECT_NE(ended.err.find("records lost (File too large)"), std::string::npos) << ended.err;
  EXPECT_NE(ended.err.find("node 3 (z)"), std::string::npos) << ended.err;
}

}  // namespace
}  // namespace tenon::tests

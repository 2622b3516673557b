// An arm that tenon-exec holds under power because a brake does not: only who means it lets it go.
// Nothing here depends on how fast the machine is: a run that ended because it came too late too
// often is repeated.

#include <gtest/gtest.h>

#include <csignal>
#include <cstring>
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
#include "tests/support/typed_input.h"

namespace tenon::tests {
namespace {

constexpr const char* kGoesOn = "goes on being held";

/// The plan for start 4 under --step, whose standard input is ours, on an arm whose z has no brake.
class HeldRun {
 public:
  HeldRun() {
    const std::string cell =
        edited(folder_, "holding.yaml", cell_around(folder_, "cell.yaml", robot_file()),
               "\nfaults:", "\non_brake_failure: hold\nfaults:");
    sim_ = std::make_unique<SimProcess>(
        folder_.path(), "4",
        std::vector<std::string>{"--once", "--fault", "brake-failure:node=3,at=enabling"}, cell);
    exec_ = std::make_unique<ChildProcess>(
        folder_.path(),
        keys_.read_by(executable("tenon-exec"),
                      {"--cell", cell, "--plan", put_box_plan(folder_, "4"), "--can", sim_->uri(),
                       "--lcm-url", "none", "--step", "--json", file("result.json"), "--black-box",
                       file("box.csv")}));
  }

  void hang_up() { keys_.hang_up(); }
  /// Stopped by the user while the first step waits, and then held.
  [[nodiscard]] bool reach_holding() {
    if (!exec_->wait_until([&] { return exec_->out().find(" waits:") != std::string::npos; })) {
      return false;
    }
    exec_->send(SIGINT);
    return exec_->wait_until([&] { return said("it is held under power: support it") > 0; });
  }
  /// How often it has, on standard error.
  [[nodiscard]] int said(const std::string& words) const {
    const std::string all = exec_->err();
    int count = 0;
    for (std::size_t at = all.find(words); at != std::string::npos; at = all.find(words, at + 1)) {
      ++count;
    }
    return count;
  }
  [[nodiscard]] bool goes_on(int times) {
    return exec_->wait_until([&] { return said(kGoesOn) == times; });
  }
  [[nodiscard]] ChildProcess& exec() { return *exec_; }
  [[nodiscard]] nlohmann::json result() const {
    return nlohmann::json::parse(folder_.get("result.json"));
  }

 private:
  [[nodiscard]] std::string file(const std::string& name) const { return folder_.path() / name; }

  ScratchFolder folder_;
  TypedInput keys_{file("keys")};
  std::unique_ptr<SimProcess> sim_;
  std::unique_ptr<ChildProcess> exec_;
};

/// Held, until the user means it. @return which of what is nobody's word it bore
std::vector<std::string> borne(HeldRun& run) {
  std::vector<std::string> all;
  run.hang_up();
  if (run.goes_on(1)) all.emplace_back("end of input");
  int times = 1;
  for (const int signal : {SIGHUP, SIGQUIT, SIGTSTP, SIGUSR1, SIGALRM}) {
    run.exec().send(signal);
    if (run.goes_on(++times)) all.emplace_back(::sigabbrev_np(signal));
  }
  run.exec().send(SIGTERM);
  EXPECT_EQ(run.exec().wait(), 1) << run.exec().err();
  return all;
}

TEST(HeldProcess, NeitherAnEndOfInputNorAStraySignalLetsTheArmGo) {
  constexpr int kTries = 3;  // a machine that is too busy loses the bus
  std::unique_ptr<HeldRun> run;
  std::vector<std::string> all;
  int tries = 0;
  do {
    Attempts attempts;
    do {
      run = std::make_unique<HeldRun>();
      if (run->reach_holding()) break;
      ASSERT_TRUE(run->exec().wait() == 1 && attempts.again(run->result())) << run->exec().err();
    } while (true);
    all = borne(*run);
  } while (run->said("is not any more") > 0 && ++tries < kTries);
  const std::vector<std::string> expected{"end of input", "HUP", "QUIT", "TSTP", "USR1", "ALRM"};
  EXPECT_EQ(all, expected) << run->exec().err();
  EXPECT_EQ(run->said("standard input has ended, and --step has nobody to ask"), 1);
  EXPECT_EQ(run->result().at("hold"), "held");
  EXPECT_EQ(run->result().at("reason"), "brake_failed");
  EXPECT_EQ(run->result().at("disable_confirmed"), true);
}

}  // namespace
}  // namespace tenon::tests

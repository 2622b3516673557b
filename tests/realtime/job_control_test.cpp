// tenon-exec as a shell's job in the background of a terminal: nothing that is typed there suspends
// it. Nothing here depends on how fast the machine is: a run that ended because it came too late
// too often is repeated.

#include <fcntl.h>
#include <gtest/gtest.h>
#include <stdlib.h>
#include <unistd.h>

#include <csignal>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "tests/support/busy_machine.h"
#include "tests/support/child_process.h"
#include "tests/support/commands.h"
#include "tests/support/places.h"
#include "tests/support/sim_process.h"

namespace tenon::tests {
namespace {

/// The plan for start 4 under --step. A shell with a terminal of its own has it in the background.
class BackgroundRun {
 public:
  BackgroundRun() : sim_(folder_.path(), "4", {"--once"}) {
    terminal_ = ::posix_openpt(O_RDWR | O_NOCTTY | O_CLOEXEC);
    EXPECT_GE(terminal_, 0);
    EXPECT_EQ(::grantpt(terminal_), 0);
    EXPECT_EQ(::unlockpt(terminal_), 0);
    // Job control needs the terminal as standard error, too.
    const std::string job =
        "\"$0\" \"$@\" 2>" + file("err") + " & echo $! >" + file("pid") + "; wait $!";
    const std::string terminal = ::ptsname(terminal_);
    shell_ = std::make_unique<ChildProcess>(
        folder_.path(),
        std::vector<std::string>{"sh", "-c",
                                 "exec setsid --ctty bash -mc '" + job + "' \"$0\" \"$@\" <" +
                                     terminal + " 2>" + terminal,
                                 executable("tenon-exec"), "--cell", gantry_cell_file(), "--plan",
                                 put_box_plan(folder_, "4"), "--can", sim_.uri(), "--lcm-url",
                                 "none", "--step", "--json", file("result.json"), "--black-box",
                                 file("box.csv")});
  }
  BackgroundRun(const BackgroundRun&) = delete;
  BackgroundRun& operator=(const BackgroundRun&) = delete;
  ~BackgroundRun() { ::close(terminal_); }

  [[nodiscard]] bool reach_first_step() {
    return shell_->wait_until([&] { return shell_->out().find(" waits:") != std::string::npos; });
  }
  void send(int signal) const { EXPECT_EQ(::kill(std::stoi(folder_.get("pid")), signal), 0); }
  void type(const std::string& words) const {
    EXPECT_EQ(::write(terminal_, words.data(), words.size()), static_cast<ssize_t>(words.size()));
  }
  /// Of tenon-exec; 128 more than the signal where the shell saw it suspended.
  [[nodiscard]] int wait() { return shell_->wait(); }
  [[nodiscard]] std::string err() const { return folder_.get("err"); }
  [[nodiscard]] nlohmann::json result() const {
    return nlohmann::json::parse(folder_.get("result.json"), nullptr, false);
  }

 private:
  [[nodiscard]] std::string file(const std::string& name) const { return folder_.path() / name; }

  ScratchFolder folder_;
  SimProcess sim_;
  int terminal_ = -1;
  std::unique_ptr<ChildProcess> shell_;
};

TEST(JobControl, WhatIsTypedWhileItIsInTheBackgroundEndsItsInputAndSuspendsNothing) {
  Attempts attempts;
  auto run = std::make_unique<BackgroundRun>();
  while (!run->reach_first_step()) {
    ASSERT_TRUE(run->wait() == 1 && attempts.again(run->result())) << run->err();
    run = std::make_unique<BackgroundRun>();
  }
  run->send(SIGTTOU);
  run->type("p\n");
  EXPECT_EQ(run->wait(), 1) << run->err();
  EXPECT_NE(run->err().find("standard input has ended"), std::string::npos) << run->err();
  const nlohmann::json result = run->result();
  ASSERT_TRUE(result.is_object());
  EXPECT_EQ(result.at("reason"), "stop_requested");
  EXPECT_EQ(result.at("disable_confirmed"), true);
}

}  // namespace
}  // namespace tenon::tests

// tenon-exec whose standard streams are closed, or lead to where nothing more fits: the bus gets
// its own frames alone, the arm's work is done, and the result tells what the exit status is.
// Repeated where the machine was too busy for real time.

#include <gtest/gtest.h>

#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "tests/support/busy_machine.h"
#include "tests/support/child_process.h"
#include "tests/support/places.h"
#include "tests/support/scratch_folder.h"
#include "tests/support/sim_process.h"

namespace tenon::tests {
namespace {

// An identification on the gantry, 2 mm above the table.
class Streams {
 public:
  /// @param redirection as a shell has it
  explicit Streams(const std::string& redirection)
      : sim_(folder_.path(), "4", {"--once"}),
        exec_(folder_.path(),
              {"sh", "-c", "exec \"$@\" " + redirection, "sh", executable("tenon-exec"), "--cell",
               gantry_cell_file(), "--can", sim_.uri(), "--lcm-url", "none", "--log",
               folder_.path() / "log", "--json", folder_.path() / "result.json", "--black-box",
               folder_.path() / "box.csv", "--identify-contact", "-z"}) {}

  [[nodiscard]] ChildProcess& exec() { return exec_; }
  [[nodiscard]] nlohmann::json result() const {
    return nlohmann::json::parse(folder_.get("result.json"), nullptr, false);
  }
  [[nodiscard]] bool reach_cycles() {
    constexpr std::uintmax_t kSome_bytes = 50'000;
    return exec_.wait_until([&] {
      std::error_code none;
      const std::uintmax_t size = std::filesystem::file_size(folder_.path() / "log", none);
      return !none && size > kSome_bytes;
    });
  }
  /// Ends it. Whether it has to be made again.
  [[nodiscard]] bool again(Attempts& attempts) {
    return exec_.wait() == 1 && result().is_object() && attempts.again(result());
  }
  /// Where a descriptor of the running program leads.
  [[nodiscard]] std::string leads_to(int descriptor) const {
    std::error_code none;
    return std::filesystem::read_symlink(
        "/proc/" + std::to_string(exec_.pid()) + "/fd/" + std::to_string(descriptor), none);
  }

 private:
  ScratchFolder folder_;
  SimProcess sim_;
  ChildProcess exec_;
};

TEST(StandardStreams, WhatWasClosedIsNoPlaceForABus) {
  Attempts attempts;
  std::unique_ptr<Streams> run;
  do {
    run = std::make_unique<Streams>("<&- >&- 2>&-");
    ASSERT_TRUE(run->reach_cycles());
    for (const int descriptor : {0, 1, 2}) EXPECT_EQ(run->leads_to(descriptor), "/dev/null");
  } while (run->again(attempts));
  EXPECT_EQ(run->exec().wait(), 1) << "its output is lost";
  EXPECT_EQ(run->result().value("status", ""), "done");
  EXPECT_EQ(run->result().value("exit_code", -1), 1);
}

TEST(StandardStreams, TheResultTellsThatTheOutputIsLost) {
  Attempts attempts;
  std::unique_ptr<Streams> run;
  do {
    run = std::make_unique<Streams>(">/dev/full");
  } while (run->again(attempts));
  EXPECT_EQ(run->exec().wait(), 1);
  const nlohmann::json result = run->result();
  ASSERT_TRUE(result.is_object());
  EXPECT_EQ(result.at("status"), "done");
  EXPECT_EQ(result.at("exit_code"), 1);
  EXPECT_NE(
      result.at("message").get<std::string>().find("; standard output could not be written whole"),
      std::string::npos)
      << result.at("message");
  EXPECT_EQ(run->exec().err(), "tenon-exec: standard output could not be written whole\n");
}

}  // namespace
}  // namespace tenon::tests

// tenon-exec as a user runs it where no plan is executed: identifications, and what keeps it from
// starting. Nothing here depends on how fast the machine is: a run that ended because it came too
// late too often is repeated.

#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <csignal>
#include <filesystem>
#include <lcm/lcm-cpp.hpp>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "executor/states/ending.h"
#include "executor/telemetry/telemetry.h"
#include "lcmtypes/tenon/run_summary_t.hpp"
#include "tests/support/busy_machine.h"
#include "tests/support/child_process.h"
#include "tests/support/commands.h"
#include "tests/support/places.h"
#include "tests/support/sim_process.h"

namespace tenon::tests {
namespace {

using executor::EndReason;

// An identification on the gantry, 2 mm above the table; both processes just started.
class Identifying {
 public:
  explicit Identifying(const std::vector<std::string>& what)
      : sim_(folder_.path(), "4", {"--once"}), exec_(folder_.path(), command(what)) {}

  [[nodiscard]] ChildProcess& sim() { return sim_.process(); }
  [[nodiscard]] ChildProcess& exec() { return exec_; }
  [[nodiscard]] std::string uri() const { return sim_.uri(); }
  [[nodiscard]] const ScratchFolder& folder() const { return folder_; }
  [[nodiscard]] std::string file(const std::string& name) const { return folder_.path() / name; }
  [[nodiscard]] nlohmann::json result() const {
    return nlohmann::json::parse(folder_.get("result.json"));
  }
  /// The control cycle runs: telemetry is being written.
  [[nodiscard]] bool reach_cycles() {
    constexpr std::uintmax_t kSome_bytes = 50'000;
    return exec_.wait_until([&] {
      std::error_code none;
      const std::uintmax_t size = std::filesystem::file_size(file("log"), none);
      return !none && size > kSome_bytes;
    });
  }
  /// Ends it. Whether it has to be made again.
  [[nodiscard]] bool again(Attempts& attempts) {
    return exec_.wait() == 1 && attempts.again(result());
  }

 private:
  std::vector<std::string> command(const std::vector<std::string>& what) {
    std::vector<std::string> all = {executable("tenon-exec"),
                                    "--cell",
                                    gantry_cell_file(),
                                    "--can",
                                    sim_.uri(),
                                    "--lcm-url",
                                    "none",
                                    "--log",
                                    file("log"),
                                    "--can-log",
                                    file("candump"),
                                    "--json",
                                    file("result.json"),
                                    "--black-box",
                                    file("box.csv")};
    all.insert(all.end(), what.begin(), what.end());
    return all;
  }

  ScratchFolder folder_;
  SimProcess sim_;
  ChildProcess exec_;
};

// To its end.
std::unique_ptr<Identifying> identified(const std::vector<std::string>& what) {
  Attempts attempts;
  std::unique_ptr<Identifying> run;
  do {
    run = std::make_unique<Identifying>(what);
  } while (run->again(attempts));
  return run;
}

struct Logged {
  std::size_t cycles = 0;
  std::vector<tenon::run_summary_t> summaries;
};

Logged summaries_of(const std::string& file) {
  lcm::LogFile source(file, "r");
  EXPECT_TRUE(source.good());
  Logged logged;
  while (const lcm::LogEvent* event = source.readNextEvent()) {
    if (event->channel == executor::kCycleChannel) ++logged.cycles;
    if (event->channel != executor::kRunChannel) continue;
    tenon::run_summary_t& summary = logged.summaries.emplace_back();
    EXPECT_EQ(summary.decode(event->data, 0, event->datalen), event->datalen);
  }
  return logged;
}

TEST(ExecProcess, IdentifyPayloadLeavesResultLogAndFramesAsAPlansRunDoes) {
  const auto run = identified({"--identify-payload"});
  EXPECT_EQ(run->exec().wait(), 1) << run->exec().err();  // a gantry does not turn its sensor
  const nlohmann::json result = run->result();
  EXPECT_EQ(result.at("status"), "failed");
  EXPECT_EQ(result.at("reason"), "measured");
  EXPECT_EQ(result.at("finding").at("status"), "not_turned");
  EXPECT_EQ(result.at("disable_confirmed"), true);
  EXPECT_EQ(result.at("arm").at("malformed_frames"), 0);
  EXPECT_NE(result.at("message").get<std::string>().find("does not turn its sensor"),
            std::string::npos);
  const Logged log = summaries_of(run->file("log"));
  EXPECT_EQ(log.cycles + result.at("cycle").at("records_dropped").get<std::size_t>(),
            result.at("cycle").at("cycles").get<std::size_t>());
  ASSERT_EQ(log.summaries.size(), 1U);
  EXPECT_EQ(log.summaries[0].end_reason, static_cast<int>(EndReason::kMeasured));
  EXPECT_EQ(log.summaries[0].exit_code, 1);
  EXPECT_NE(run->folder().get("candump").find(" 080#"), std::string::npos);
  EXPECT_FALSE(std::filesystem::exists(run->file("box.csv")));
}

TEST(ExecProcess, IdentifyContactPutsStiffnessAndLagIntoTheResult) {
  const auto run = identified({"--identify-contact", "-z"});
  EXPECT_EQ(run->exec().wait(), 0) << run->exec().err();
  const nlohmann::json result = run->result();
  EXPECT_EQ(result.at("status"), "done");
  EXPECT_EQ(result.at("finding").at("status"), "identified");
  EXPECT_NEAR(result["finding"].at("stiffness_Npm").get<double>(), 5e4, 2.5e3);
  EXPECT_NE(run->exec().out().find("for the cell file:"), std::string::npos);
}

TEST(ExecProcess, APulledCableEndsAnIdentificationByNameAndLeavesABlackBox) {
  Attempts attempts;
  std::unique_ptr<Identifying> run;
  do {
    run = std::make_unique<Identifying>(std::vector<std::string>{"--identify-payload"});
    ASSERT_TRUE(run->reach_cycles()) << run->exec().err();
    run->sim().send(SIGKILL);
  } while (run->again(attempts));
  EXPECT_EQ(run->exec().wait(), 1);
  const nlohmann::json result = run->result();
  EXPECT_EQ(result.at("reason"), "arm_fault");
  EXPECT_EQ(result.at("disable_confirmed"), false);
  EXPECT_FALSE(result.contains("finding"));
  EXPECT_NE(run->exec().err().find("the CAN bus is gone"), std::string::npos) << run->exec().err();
  EXPECT_NE(run->exec().err().find("the last second is in"), std::string::npos);
  const std::string box = run->folder().get("box.csv");
  EXPECT_GT(std::count(box.begin(), box.end(), '\n'), 50);
  EXPECT_NE(box.find(",arm_fault,"), std::string::npos);
}

TEST(ExecProcess, ASecondOneOnTheBusLeavesTheFirstAlone) {
  for (Attempts attempts;;) {
    Identifying first({"--identify-contact", "-z"});
    ASSERT_TRUE(first.reach_cycles()) << first.exec().err();
    const ScratchFolder elsewhere;
    const Ended second =
        run(elsewhere, {executable("tenon-exec"), "--cell", gantry_cell_file(), "--can",
                        first.uri(), "--rt", "off", "--lcm-url", "none", "--identify-payload"});
    if (first.again(attempts)) continue;
    EXPECT_EQ(second.status, 2);
    EXPECT_EQ(second.err.rfind("tenon-exec: another master runs on this bus: 0x", 0), 0U)
        << second.err;
    EXPECT_NE(second.err.find("stop it first"), std::string::npos) << second.err;
    EXPECT_EQ(first.exec().wait(), 0) << first.exec().err();
    return;
  }
}

TEST(ExecProcess, RequiredRealTimeNamesAllThatIsMissingAtOnce) {
  const ScratchFolder folder;
  SimProcess sim(folder.path(), "4", {});
  std::vector<std::string> command = {"prlimit", "--memlock=65536:65536", "--rtprio=0:0"};
  if (geteuid() == 0) command.insert(command.begin(), {"setpriv", "--bounding-set=-all"});
  const std::vector<std::string> exec = {executable("tenon-exec"),
                                         "--cell",
                                         gantry_cell_file(),
                                         "--can",
                                         sim.uri(),
                                         "--rt",
                                         "require",
                                         "--lcm-url",
                                         "none",
                                         "--identify-payload"};
  command.insert(command.end(), exec.begin(), exec.end());
  const Ended ended = run(folder, command);
  EXPECT_EQ(ended.status, 2);
  EXPECT_EQ(std::count(ended.err.begin(), ended.err.end(), '\n'), 1) << ended.err;
  EXPECT_EQ(ended.err.rfind("tenon-exec: --rt require: ", 0), 0U) << ended.err;
  EXPECT_NE(ended.err.find("memory is not locked"), std::string::npos) << ended.err;
  EXPECT_NE(ended.err.find("no SCHED_FIFO priority 80"), std::string::npos) << ended.err;
}

TEST(ExecProcess, WhatBelongsToAPlanIsRefusedBesideAnIdentification) {
  const ScratchFolder folder;
  for (const std::string option : {"--dry-run", "--go-to-start"}) {
    const Ended ended = run(folder, {executable("tenon-exec"), "--cell", gantry_cell_file(),
                                     "--can", "slcan://127.0.0.1:1", "--identify-payload", option});
    EXPECT_EQ(ended.status, 2);
    EXPECT_NE(ended.err.find(option), std::string::npos) << ended.err;
    EXPECT_NE(ended.err.find("--identify-payload"), std::string::npos) << ended.err;
  }
}

}  // namespace
}  // namespace tenon::tests

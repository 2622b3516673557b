// Executor and virtual arm as two processes in real time. Nothing here depends on how fast the
// machine is: a run that ended because it came too late too often is repeated.

#include <gtest/gtest.h>

#include <algorithm>
#include <csignal>
#include <cstdio>
#include <filesystem>
#include <lcm/lcm-cpp.hpp>
#include <memory>
#include <nlohmann/json.hpp>
#include <set>
#include <sstream>
#include <string>
#include <vector>

#include "executor/states/ending.h"
#include "executor/telemetry/telemetry.h"
#include "lcmtypes/tenon/cycle_state_t.hpp"
#include "lcmtypes/tenon/run_setup_t.hpp"
#include "lcmtypes/tenon/run_status_t.hpp"
#include "lcmtypes/tenon/run_summary_t.hpp"
#include "lcmtypes/tenon/step_event_t.hpp"
#include "tests/support/busy_machine.h"
#include "tests/support/child_process.h"
#include "tests/support/commands.h"
#include "tests/support/places.h"
#include "tests/support/sim_process.h"

namespace tenon::tests {
namespace {

// One run of the plan for start 4 on an arm whose table stands elsewhere, both just started.
class Processes {
 public:
  explicit Processes(const ScratchFolder& folder, const std::string& plan)
      : folder_(folder),
        sim_(folder.path(), "4",
             {"--once", "--offset", "x_m=0.02,y_m=-0.015", "--json", file("truth.json")}),
        exec_(folder.path(),
              {executable("tenon-exec"), "--cell", gantry_cell_file(), "--plan", plan, "--can",
               sim_.uri(), "--lcm-url", "none", "--log", file("log"), "--can-log", file("candump"),
               "--json", file("result.json"), "--black-box", file("box.csv")}) {}

  [[nodiscard]] ChildProcess& sim() { return sim_.process(); }
  [[nodiscard]] ChildProcess& exec() { return exec_; }
  [[nodiscard]] std::string file(const std::string& name) const { return folder_.path() / name; }
  [[nodiscard]] nlohmann::json result() const { return json("result.json"); }
  [[nodiscard]] nlohmann::json truth() const { return json("truth.json"); }

  /// In the plan's second step, which moves for more than a second.
  [[nodiscard]] bool reach_mid_motion() {
    return exec_.wait_until([&] { return exec_.out().find("\nstep  0:") != std::string::npos; });
  }

 private:
  [[nodiscard]] nlohmann::json json(const std::string& name) const {
    return nlohmann::json::parse(folder_.get(name));
  }

  const ScratchFolder& folder_;
  SimProcess sim_;
  ChildProcess exec_;
};

class ProcessesTest : public ::testing::Test {
 protected:
  // From a fresh start.
  Processes& begin() {
    processes.reset();
    for (const std::string& name : folder.names()) {
      if (!name.ends_with(".tnp")) std::filesystem::remove(folder.path() / name);
    }
    return *(processes = std::make_unique<Processes>(folder, plan));
  }

  // Begins, and until mid-motion. Empty where the run ended before.
  Processes* begin_moving() {
    Attempts attempts;
    do {
      if (begin().reach_mid_motion()) return processes.get();
    } while (processes->exec().wait() == 1 && attempts.again(processes->result()));
    return nullptr;
  }

  // The executor's status at its end.
  int run_to_the_end() {
    Attempts attempts;
    int status = 0;
    do {
      status = begin().exec().wait();
    } while (status == 1 && attempts.again(processes->result()));
    return status;
  }

  ScratchFolder folder;
  std::string plan = put_box_plan(folder, "4");
  std::unique_ptr<Processes> processes;
};

struct Log {
  std::vector<tenon::cycle_state_t> cycles;
  std::vector<tenon::step_event_t> steps;
  std::vector<tenon::run_summary_t> summaries;
  std::vector<tenon::run_setup_t> setups;
  std::vector<tenon::run_status_t> statuses;
  std::string last_channel;
};

template <typename Message>
void decode_into(std::vector<Message>& messages, const lcm::LogEvent& event) {
  EXPECT_EQ(messages.emplace_back().decode(event.data, 0, event.datalen), event.datalen);
}

Log read_log(const std::string& file) {
  lcm::LogFile source(file, "r");
  EXPECT_TRUE(source.good());
  Log log;
  while (const lcm::LogEvent* event = source.readNextEvent()) {
    log.last_channel = event->channel;
    if (event->channel == executor::kCycleChannel) {
      decode_into(log.cycles, *event);
    } else if (event->channel == executor::kStepChannel) {
      decode_into(log.steps, *event);
    } else if (event->channel == executor::kRunChannel) {
      decode_into(log.summaries, *event);
    } else if (event->channel == executor::kSetupChannel) {
      decode_into(log.setups, *event);
    } else if (event->channel == executor::kStatusChannel) {
      decode_into(log.statuses, *event);
    } else {
      ADD_FAILURE() << "channel " << event->channel;
    }
  }
  return log;
}

void expect_whole_log(const std::string& file, const nlohmann::json& result) {
  const Log log = read_log(file);
  const auto& cycle = result.at("cycle");
  EXPECT_EQ(log.cycles.size() + cycle.at("records_dropped").get<std::size_t>(),
            cycle.at("cycles").get<std::size_t>());
  for (std::size_t i = 1; i < log.cycles.size(); ++i) {
    ASSERT_GT(log.cycles[i].sequence, log.cycles[i - 1].sequence);
  }
  EXPECT_EQ(log.steps.size(), result.at("steps").size());
  ASSERT_EQ(log.summaries.size(), 1U);
  EXPECT_FALSE(log.setups.empty());
  for (const auto& setup : log.setups) EXPECT_EQ(setup.plan, log.summaries[0].plan);
  EXPECT_FALSE(log.statuses.empty());
  EXPECT_EQ(log.last_channel, executor::kRunChannel);
  EXPECT_EQ(log.summaries[0].exit_code, 0);
  EXPECT_EQ(log.summaries[0].end_reason, static_cast<int>(executor::EndReason::kPlanDone));
  EXPECT_EQ(log.summaries[0].message, result.at("message").get<std::string>());
}

// Lines "(SECONDS.MICROSECONDS) INTERFACE ID#DATA".
void expect_candump(const std::string& text) {
  std::istringstream lines(text);
  std::set<unsigned> ids;
  int count = 0;
  for (std::string line; std::getline(lines, line); ++count) {
    unsigned long seconds = 0;
    unsigned long microseconds = 0;
    unsigned id = 0;
    char digits[17] = "";
    int used = 0;
    const int fields = std::sscanf(line.c_str(), "(%lu.%6lu) %*[a-z0-9] %3X#%n%16[0-9A-FR]",
                                   &seconds, &microseconds, &id, &used, digits);
    ASSERT_GE(fields, 3) << line;
    const std::string data = digits;
    ASSERT_EQ(line.size(), static_cast<std::size_t>(used) + data.size()) << line;
    ASSERT_EQ(data.size() % 2, 0U) << line;
    ids.insert(id);
  }
  EXPECT_GT(count, 1000);
  // NMT, SYNC, the heartbeats of the four nodes.
  for (const unsigned id : {0x000U, 0x080U, 0x701U, 0x702U, 0x703U, 0x704U}) {
    EXPECT_TRUE(ids.contains(id)) << std::hex << id;
  }
}

void expect_brakes_engaged(const nlohmann::json& truth) {
  ASSERT_EQ(truth.at("drives").size(), 3U);
  for (const auto& drive : truth["drives"]) EXPECT_TRUE(drive.at("brake_engaged")) << drive;
}

TEST_F(ProcessesTest, ARunReachesTheGoalAndItsLogsCanBeReadAndPlayed) {
  ASSERT_EQ(run_to_the_end(), 0) << processes->exec().err();
  ASSERT_EQ(processes->sim().wait(), 0);
  const nlohmann::json result = processes->result();
  EXPECT_EQ(result.at("status"), "done");
  EXPECT_EQ(result.at("reason"), "plan_done");
  EXPECT_EQ(result.at("disable_confirmed"), true);
  EXPECT_EQ(result.at("steps").back().at("next"), "done");

  const nlohmann::json truth = processes->truth();
  EXPECT_EQ(truth.at("within_tolerance"), true);
  EXPECT_EQ(truth.at("offset").at("x_m"), 0.02);
  EXPECT_LE(truth.at("error_norm_m").get<double>(), 0.002);
  EXPECT_EQ(truth.at("faults"), 0);
  EXPECT_EQ(truth.at("solver_messages"), 0);
  expect_brakes_engaged(truth);

  expect_whole_log(processes->file("log"), result);
  expect_candump(folder.get("candump"));

  const Ended played = run(folder, {"lcm-logplayer", "--verbose", "--speed=1000",
                                    "--lcm-url=memq://", processes->file("log")});
  EXPECT_EQ(played.status, 0);
  EXPECT_EQ(played.err, "");
  EXPECT_NE(played.out.find(executor::kRunChannel), std::string::npos);
}

class StopSignal : public ProcessesTest, public ::testing::WithParamInterface<int> {};

INSTANTIATE_TEST_SUITE_P(Each, StopSignal,
                         ::testing::Values(SIGINT, SIGTERM, SIGHUP, SIGQUIT, SIGUSR1, SIGTSTP));

TEST_P(StopSignal, InMidMotionStopsTheArmAndSaysSo) {
  ASSERT_NE(begin_moving(), nullptr) << processes->exec().err();
  processes->exec().send(GetParam());
  EXPECT_EQ(processes->exec().wait(), 1);
  EXPECT_EQ(processes->sim().wait(), 0);
  const nlohmann::json result = processes->result();
  EXPECT_EQ(result.at("status"), "failed");
  EXPECT_EQ(result.at("reason"), "stop_requested");
  EXPECT_EQ(result.at("disable_confirmed"), true);
  EXPECT_NE(processes->exec().err().find("stopped on request"), std::string::npos)
      << processes->exec().err();
  EXPECT_EQ(processes->truth().at("faults"), 0);
  expect_brakes_engaged(processes->truth());
}

TEST_F(ProcessesTest, CtrlCDuringTheBringUpLeavesAResult) {
  // On a bus where nobody answers the bring-up goes on for seconds.
  const ScratchFolder elsewhere;
  SimProcess sim(elsewhere.path(), "4", {});
  sim.process().send(SIGSTOP);
  const std::string result = elsewhere.path() / "result.json";
  ChildProcess exec(elsewhere.path(),
                    {executable("tenon-exec"), "--cell", gantry_cell_file(), "--plan", plan,
                     "--can", sim.uri(), "--lcm-url", "none", "--json", result});
  ASSERT_TRUE(exec.wait_until([&] { return exec.out().find("cycle 2 ms") != std::string::npos; }));
  exec.send(SIGINT);
  EXPECT_EQ(exec.wait(), 1) << exec.err();
  sim.process().send(SIGCONT);
  const nlohmann::json json = nlohmann::json::parse(elsewhere.get("result.json"));
  EXPECT_EQ(json.at("reason"), "stop_requested");
  EXPECT_EQ(json.at("message"), "stopped on request");
  EXPECT_EQ(json.at("exit_code"), 1);
  EXPECT_EQ(json.at("steps").size(), 0U);
}

TEST_F(ProcessesTest, DrivesStopByThemselvesWhenTheExecutorIsKilledInMidMotion) {
  ASSERT_NE(begin_moving(), nullptr) << processes->exec().err();
  processes->exec().send(SIGKILL);
  EXPECT_EQ(processes->exec().wait(), -SIGKILL);
  EXPECT_EQ(processes->sim().wait(), 0);
  EXPECT_FALSE(std::filesystem::exists(processes->file("result.json")));
  const nlohmann::json truth = processes->truth();
  std::set<std::string> events;
  for (const auto& event : truth.at("events")) events.insert(event.at("what"));
  for (const char* node : {"1", "2", "3"}) {
    const std::string lost =
        std::string("node ") + node + ": emergency 8130h (heartbeat of the master lost)";
    EXPECT_TRUE(events.contains(lost)) << truth.at("events");
  }
  expect_brakes_engaged(truth);
}

TEST_F(ProcessesTest, TheExecutorEndsByItselfWithAReasonWhenTheArmIsGone) {
  ASSERT_NE(begin_moving(), nullptr) << processes->exec().err();
  processes->sim().send(SIGKILL);
  EXPECT_EQ(processes->exec().wait(), 1);
  const nlohmann::json result = processes->result();
  EXPECT_EQ(result.at("reason"), "arm_fault");
  EXPECT_EQ(result.at("arm_fault"), "bus_down");
  EXPECT_EQ(result.at("disable_confirmed"), false);
  const std::string message = result.at("message");
  EXPECT_NE(message.find("the CAN bus is gone"), std::string::npos) << message;
  EXPECT_NE(processes->exec().err().find(message), std::string::npos);

  // Two seconds, counted in cycles without an answer.
  constexpr std::size_t kCycles = 1000;
  const Log log = read_log(processes->file("log"));
  std::size_t unanswered = 0;
  while (unanswered < log.cycles.size() &&
         log.cycles[log.cycles.size() - 1 - unanswered].joints_fresh == 0) {
    ++unanswered;
  }
  EXPECT_GT(unanswered, 0U);
  EXPECT_LT(unanswered, kCycles);

  const std::string black_box = folder.get("box.csv");
  EXPECT_GT(std::count(black_box.begin(), black_box.end(), '\n'), 100);
}

}  // namespace
}  // namespace tenon::tests

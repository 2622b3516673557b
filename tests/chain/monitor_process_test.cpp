// tenon-monitor as a user runs it, on logs that hold what nobody sane would send.

#include <gtest/gtest.h>
#include <sys/stat.h>

#include <algorithm>
#include <csignal>
#include <cstdint>
#include <string>
#include <vector>

#include "executor/telemetry/event_log.h"
#include "executor/telemetry/telemetry.h"
#include "lcmtypes/tenon/cycle_state_t.hpp"
#include "lcmtypes/tenon/run_summary_t.hpp"
#include "tests/support/bad_input.h"
#include "tests/support/child_process.h"
#include "tests/support/commands.h"
#include "tests/support/places.h"

namespace tenon::tests {
namespace {

template <typename Message>
std::vector<std::uint8_t> bytes_of(const Message& message) {
  std::vector<std::uint8_t> bytes(static_cast<std::size_t>(message.getEncodedSize()));
  message.encode(bytes.data(), 0, static_cast<int>(bytes.size()));
  return bytes;
}

// The joints' count stands behind these of a cycle's fields, and the hash.
std::vector<std::uint8_t> cycle_with_joints(std::uint8_t count) {
  tenon::cycle_state_t cycle{};
  std::vector<std::uint8_t> bytes = bytes_of(cycle);
  constexpr std::size_t kBehindTheCount_bytes = 4 + 8 + 8 + 4 + 8;
  bytes[bytes.size() - kBehindTheCount_bytes - 1] = count;
  return bytes;
}

std::vector<std::uint8_t> summary_that_says(const std::string& message) {
  tenon::run_summary_t summary{};
  summary.message = message;
  return bytes_of(summary);
}

TEST(MonitorProcess, OutlivesADatagramWithANegativeCountAndShowsTheRest) {
  const ScratchFolder folder;
  {
    executor::EventLog log(folder.path() / "log");
    log.add(1, executor::kCycleChannel, cycle_with_joints(0xFB));
    log.add(2, executor::kRunChannel, std::vector<std::uint8_t>{1, 2, 3});
    log.add(3, executor::kRunChannel, summary_that_says("a\x1B[2Jb"));
  }
  const Ended ended = run(folder, {executable("tenon-monitor"), "--lcm-url",
                                   "file://" + (folder.path() / "log").string()});
  EXPECT_EQ(ended.status, 1);
  EXPECT_NE(ended.out.find("done: a\\x1B[2Jb"), std::string::npos) << ended.out;
  EXPECT_EQ(ended.err, "tenon-monitor: 2 messages could not be decoded\n");
}

TEST(MonitorProcess, ALogThatIsAPipeOrADeviceIsRefusedWithoutWaiting) {
  const ScratchFolder folder;
  const std::string pipe = folder.path() / "pipe";
  ASSERT_EQ(::mkfifo(pipe.c_str(), 0600), 0);
  for (const std::string& file : {pipe, std::string("/dev/zero"), folder.path().string()}) {
    expect_refused(folder, {{executable("tenon-monitor"), "--lcm-url", "file://" + file},
                            {file, "not a regular file"}});
  }
}

// LCM itself takes mode=w for a log to write, and empties it.
TEST(MonitorProcess, ALogIsNeitherEmptiedNorPlayedAtASpeedThatIsNone) {
  const ScratchFolder folder;
  const std::string log = folder.path() / "log";
  {
    executor::EventLog written(log);
    written.add(1, executor::kRunChannel, summary_that_says("done"));
  }
  const std::string before = folder.get("log");
  for (const std::string option : {"mode=w", "mode=a", "mode=r", "sped=4", "speed=nan", "speed=inf",
                                   "speed=-1", "speed=0", "speed=abc", "speed="}) {
    expect_refused(folder,
                   {{executable("tenon-monitor"), "--lcm-url", "file://" + log + "?" + option},
                    {"'" + option + "'", "speed=", "start_timestamp="}});
    EXPECT_EQ(folder.get("log"), before) << option;
  }
}

std::vector<std::uint8_t> cycle_of(std::int64_t sequence) {
  tenon::cycle_state_t cycle{};
  cycle.sequence = sequence;
  return bytes_of(cycle);
}

// LCM itself ends a message before the damage, which begins in the second run.
TEST(MonitorProcess, ALogThatIsNotWholeIsShownAndSaidToBeSo) {
  const ScratchFolder folder;
  {
    executor::EventLog log(folder.path() / "log");
    for (int i = 5; i < 10; ++i) log.add(i, executor::kCycleChannel, cycle_of(i));
    log.add(10, executor::kRunChannel, summary_that_says("first"));
    for (int i = 0; i < 5; ++i) log.add(20 + i, executor::kCycleChannel, cycle_of(i));
    log.add(25, executor::kRunChannel, summary_that_says("second"));
  }
  const std::string whole = folder.get("log");
  const std::string sync = "\xED\xA1\xDA\x01";
  const std::size_t last = whole.rfind(sync);
  std::string damaged = whole;
  const std::size_t second = whole.find(sync, whole.find("TENON_RUN"));
  damaged.replace(whole.find(sync, second + sync.size()), 500, std::string(500, '\0'));
  struct Log {
    const char* name;
    std::string bytes;
    int status;
    const char* said;
  };
  for (const Log& log :
       {Log{"whole", whole, 0, ""}, Log{"damaged", damaged, 1, "the file is damaged"},
        Log{"cut", whole.substr(0, whole.size() - 10), 1, "breaks off within a message"},
        Log{"early", whole.substr(0, last), 1, "ends before the run does"}}) {
    SCOPED_TRACE(log.name);
    const std::string file = folder.put(log.name, log.bytes);
    const Ended ended =
        run(folder, {executable("tenon-monitor"), "--lines", "--lcm-url", "file://" + file});
    EXPECT_EQ(ended.status, log.status);
    EXPECT_NE(ended.out.find("done: first"), std::string::npos) << ended.out;
    EXPECT_NE(ended.err.find(log.said), std::string::npos) << ended.err;
    const std::string mine = "tenon-monitor: ";
    EXPECT_EQ(ended.err.find(mine) != std::string::npos, log.status == 1) << ended.err;
    EXPECT_EQ(ended.err.find(mine), ended.err.rfind(mine)) << ended.err;
  }
}

/// The program itself, no more the fork of its parent, which may catch signals of its own.
bool catches(pid_t pid, int signal) {
  std::ifstream status("/proc/" + std::to_string(pid) + "/status");
  const std::string text{std::istreambuf_iterator<char>(status), {}};
  const auto at = text.find("SigCgt:");
  if (text.rfind("Name:\ttenon-monitor\n", 0) != 0 || at == std::string::npos) return false;
  return (std::stoull(text.substr(at + 7), nullptr, 16) >> (signal - 1) & 1U) != 0;
}

TEST(MonitorProcess, ASignalEndsItWhileNothingComes) {
  for (const int signal : {SIGINT, SIGTERM, SIGHUP}) {
    const ScratchFolder folder;
    ChildProcess child(folder.path(), {executable("tenon-monitor"), "--lcm-url", "memq://"});
    ASSERT_TRUE(child.wait_until([&] { return catches(child.pid(), signal); }));
    child.send(signal);
    EXPECT_EQ(child.wait(std::chrono::seconds(5)), 0);
  }
}

}  // namespace
}  // namespace tenon::tests

// tenon-exec --keys as a user has it: words on standard input while the plan runs. Nothing here
// depends on how fast the machine is: a run that ended because it came too late too often is
// repeated.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <csignal>
#include <cstdint>
#include <filesystem>
#include <lcm/lcm-cpp.hpp>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "executor/telemetry/telemetry.h"
#include "lcmtypes/tenon/cycle_state_t.hpp"
#include "tests/support/busy_machine.h"
#include "tests/support/child_process.h"
#include "tests/support/commands.h"
#include "tests/support/places.h"
#include "tests/support/sim_process.h"
#include "tests/support/typed_input.h"

namespace tenon::tests {
namespace {

/// A run of the plan for start 4 whose standard input is ours; both processes just started.
class KeyedRun {
 public:
  KeyedRun(const ScratchFolder& folder, const std::string& plan)
      : folder_(folder),
        sim_(folder.path(), "4",
             {"--once", "--offset", "x_m=0.02,y_m=-0.015", "--json", file("truth.json")}),
        keys_(file("keys")),
        exec_(folder.path(),
              keys_.read_by(executable("tenon-exec"),
                            {"--cell", gantry_cell_file(), "--plan", plan, "--can", sim_.uri(),
                             "--lcm-url", "none", "--keys", "--log", file("log"), "--json",
                             file("result.json"), "--black-box", file("box.csv")})) {}

  [[nodiscard]] TypedInput& keys() { return keys_; }
  [[nodiscard]] ChildProcess& exec() { return exec_; }
  [[nodiscard]] ChildProcess& sim() { return sim_.process(); }
  [[nodiscard]] std::string file(const std::string& name) const { return folder_.path() / name; }
  [[nodiscard]] nlohmann::json json(const std::string& name) const {
    return nlohmann::json::parse(folder_.get(name));
  }

  /// In the plan's second step, which moves for more than a second.
  [[nodiscard]] bool reach_mid_motion() {
    return exec_.wait_until([&] { return exec_.out().find("\nstep  0:") != std::string::npos; });
  }
  [[nodiscard]] bool says(const std::string& words) {
    return exec_.wait_until([&] { return exec_.err().find(words) != std::string::npos; });
  }
  /// So many more cycles have been logged.
  [[nodiscard]] bool let_pass(std::uintmax_t cycles) {
    constexpr std::uintmax_t kCycle_bytes = 600;
    const std::uintmax_t until = logged_bytes() + cycles * kCycle_bytes;
    return exec_.wait_until([&] { return logged_bytes() > until; });
  }

 private:
  [[nodiscard]] std::uintmax_t logged_bytes() const {
    std::error_code none;
    const std::uintmax_t size = std::filesystem::file_size(file("log"), none);
    return none ? 0 : size;
  }

  const ScratchFolder& folder_;
  SimProcess sim_;
  TypedInput keys_;
  ChildProcess exec_;
};

/// The most cycles in a row of one step in which its setpoint stood still.
int longest_standstill(const std::string& log) {
  lcm::LogFile source(log, "r");
  EXPECT_TRUE(source.good());
  constexpr double kStands_m = 1e-9;  // in a cycle of 2 ms
  std::optional<cycle_state_t> before;
  int most = 0;
  int now = 0;
  while (const lcm::LogEvent* event = source.readNextEvent()) {
    if (event->channel != executor::kCycleChannel) continue;
    cycle_state_t cycle{};
    EXPECT_EQ(cycle.decode(event->data, 0, event->datalen), event->datalen);
    const auto stays = [](double is, double was) { return std::abs(is - was) < kStands_m; };
    const bool stands =
        before && cycle.step >= 0 && cycle.step == before->step &&
        std::equal(std::begin(cycle.setpoint_position_m), std::end(cycle.setpoint_position_m),
                   std::begin(before->setpoint_position_m), stays);
    now = stands ? now + 1 : 0;
    most = std::max(most, now);
    before = cycle;
  }
  return most;
}

class KeysProcess : public ::testing::Test {
 protected:
  /// From a fresh start, until mid-motion. Null where the run never came there.
  KeyedRun* begin_moving() {
    do {
      begin();
      if (keyed->reach_mid_motion()) return keyed.get();
    } while (keyed->exec().wait() == 1 && attempts.again(keyed->json("result.json")));
    return nullptr;
  }
  void begin() {
    keyed.reset();
    for (const std::string& name : folder.names()) {
      if (!name.ends_with(".tnp")) std::filesystem::remove(folder.path() / name);
    }
    keyed = std::make_unique<KeyedRun>(folder, plan);
  }

  ScratchFolder folder;
  std::string plan = put_box_plan(folder, "4");
  std::unique_ptr<KeyedRun> keyed;
  Attempts attempts;
};

TEST_F(KeysProcess, AMoveIsPausedInsideByAWordAndGoesOnByAnother) {
  constexpr int kPaused_cycles = 500;
  int status = 0;
  do {
    KeyedRun* run = begin_moving();
    ASSERT_NE(run, nullptr);
    run->keys().type("p\n");
    if (run->says("pausing") && run->let_pass(2 * kPaused_cycles)) run->keys().type("r\n");
    status = run->exec().wait();
  } while (status == 1 && attempts.again(keyed->json("result.json")));
  ASSERT_EQ(status, 0) << keyed->exec().err();
  EXPECT_NE(keyed->exec().err().find("going on"), std::string::npos) << keyed->exec().err();
  EXPECT_EQ(keyed->json("result.json").at("reason"), "plan_done");
  // A step's own rest, at its end, is a few dozen.
  EXPECT_GT(longest_standstill(keyed->file("log")), kPaused_cycles);
  ASSERT_EQ(keyed->sim().wait(), 0);
  EXPECT_EQ(keyed->json("truth.json").at("within_tolerance"), true);
}

TEST_F(KeysProcess, APausedMoveThatNobodyCanLetGoOnIsStopped) {
  int status = 0;
  do {
    KeyedRun* run = begin_moving();
    ASSERT_NE(run, nullptr);
    run->keys().type("p\n");
    const bool said = run->says("pausing") && run->let_pass(100);
    if (said) run->keys().hang_up();
    status = run->exec().wait();
  } while (status == 1 && attempts.again(keyed->json("result.json")));
  EXPECT_EQ(status, 1);
  EXPECT_EQ(keyed->json("result.json").at("reason"), "stop_requested") << keyed->exec().err();
  EXPECT_EQ(keyed->json("result.json").at("disable_confirmed"), true);
  EXPECT_NE(keyed->exec().err().find("standard input has ended"), std::string::npos);
}

TEST_F(KeysProcess, ATerminalThatClosesInAPauseStopsTheMove) {
  int status = 0;
  do {
    KeyedRun* run = begin_moving();
    ASSERT_NE(run, nullptr);
    run->keys().type("p\n");
    if (run->says("pausing") && run->let_pass(100)) run->exec().send(SIGHUP);
    status = run->exec().wait();
  } while (status == 1 && attempts.again(keyed->json("result.json")));
  EXPECT_EQ(status, 1);
  EXPECT_EQ(keyed->json("result.json").at("reason"), "stop_requested") << keyed->exec().err();
  EXPECT_EQ(keyed->json("result.json").at("disable_confirmed"), true);
  EXPECT_EQ(keyed->exec().err().find("going on"), std::string::npos) << keyed->exec().err();
}

}  // namespace
}  // namespace tenon::tests

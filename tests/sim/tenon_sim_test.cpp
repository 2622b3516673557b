// The executable: what it prints, what it answers over TCP, what it leaves behind, how it refuses.

#include <arpa/inet.h>
#include <gtest/gtest.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <csignal>
#include <cstdint>
#include <fstream>
#include <lcm/lcm-cpp.hpp>
#include <nlohmann/json.hpp>
#include <string>
#include <utility>
#include <vector>

#include "lcmtypes/tenon/cycle_state_t.hpp"
#include "tests/support/child_process.h"
#include "tests/support/places.h"
#include "tests/support/scratch_folder.h"
#include "tests/support/sim_process.h"

namespace tenon::sim {
namespace {

using tests::SimProcess;

class TenonSimTest : public ::testing::Test {
 protected:
  static int connect_to(const SimProcess& sim) {
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_port = htons(static_cast<std::uint16_t>(sim.port()));
    inet_pton(AF_INET, "127.0.0.1", &address.sin_addr);
    const int connection = socket(AF_INET, SOCK_STREAM, 0);
    EXPECT_EQ(connect(connection, reinterpret_cast<const sockaddr*>(&address), sizeof address), 0);
    return connection;
  }

  tests::ScratchFolder folder;
};

std::string ask(int connection, const std::string& line, const std::string& wanted) {
  EXPECT_EQ(write(connection, line.data(), line.size()), static_cast<ssize_t>(line.size()));
  std::string heard;
  char buffer[256];
  while (heard.find(wanted) == std::string::npos) {
    const ssize_t count = read(connection, buffer, sizeof buffer);
    if (count <= 0) break;
    heard.append(buffer, static_cast<std::size_t>(count));
  }
  return heard;
}

TEST_F(TenonSimTest, AnswersOverTcpAndLeavesTheWholeTruthOnInterrupt) {
  const std::string truth_file = folder.path() / "truth.json";
  SimProcess sim(folder.path(), "2", {"--seed", "11", "--json", truth_file});
  const int connection = connect_to(sim);
  const std::string answer = ask(connection, "S8\rO\rt60284000100000000000\r", "t5828");
  EXPECT_NE(answer.find("t58284300100092010200\r"), std::string::npos) << answer;
  sim.process().send(SIGINT);
  EXPECT_EQ(sim.process().wait(), 0);
  close(connection);
  EXPECT_EQ(sim.process().out().rfind("seed 11\nlistening on 127.0.0.1:", 0), 0U);
  EXPECT_EQ(sim.process().err(), "");

  const auto truth = nlohmann::json::parse(std::ifstream(truth_file));
  EXPECT_EQ(truth["task"], "box_on_table_2d");
  EXPECT_EQ(truth["start"], "2");
  EXPECT_EQ(truth["seed"], 11);
  EXPECT_NE(truth["offset"]["x_m"], 0.0);
  EXPECT_EQ(truth["offset"]["z_m"], 0.0);
  EXPECT_EQ(truth["drives"].size(), 3U);
  EXPECT_TRUE(truth["drives"][0]["brake_engaged"]);
  // The offset is nobody's to know: neither output names it.
  EXPECT_EQ(sim.process().out().find(truth["offset"]["x_m"].dump().substr(0, 6)),
            std::string::npos);
}

TEST_F(TenonSimTest, EndsByItselfWhenItsOnlyClientHasGone) {
  SimProcess sim(folder.path(), "2", {"--offset", "x_m=0.01", "--once"});
  const int connection = connect_to(sim);
  ask(connection, "O\rt60284000100000000000\r", "t5828");
  close(connection);
  EXPECT_EQ(sim.process().wait(), 0);
}

TEST_F(TenonSimTest, DrawsAWorldFromAnExperimentThatOnlyTheTruthTells) {
  const std::string truth_file = folder.path() / "truth.json";
  SimProcess sim(folder.path(), "2",
                 {"--seed", "11", "--json", truth_file, "--experiment",
                  tests::in_tree("sim/experiments/box_on_table.yaml")});
  sim.process().send(SIGINT);
  EXPECT_EQ(sim.process().wait(), 0);
  const auto world = nlohmann::json::parse(std::ifstream(truth_file))["world"];
  EXPECT_GE(world["friction"], 0.1);
  EXPECT_LE(world["friction"], 0.6);
  EXPECT_NE(world["task_in_base_error"]["rz_rad"], 0.0);
  EXPECT_NE(world["backlash_m"], 0.0);
  EXPECT_EQ(sim.process().out().find("friction"), std::string::npos);
}

TEST_F(TenonSimTest, CarriesOutFaultsOfDevicesAndBus) {
  const std::string truth_file = folder.path() / "truth.json";
  SimProcess sim(folder.path(), "2",
                 {"--offset", "x_m=0.01", "--json", truth_file, "--fault",
                  "node-reset:node=2,time_s=0.3", "--fault", "drop:node=1,duration_s=100"});
  const int connection = connect_to(sim);
  // Node 2 boots anew; node 1 is not heard.
  const std::string heard = ask(connection, "O\rt60184000100000000000\r", "t702100");
  EXPECT_NE(heard.find("t702100"), std::string::npos) << heard;
  EXPECT_EQ(heard.find("t5818"), std::string::npos) << heard;
  sim.process().send(SIGINT);
  EXPECT_EQ(sim.process().wait(), 0);
  close(connection);
  const auto truth = nlohmann::json::parse(std::ifstream(truth_file));
  EXPECT_NE(truth["events"].dump().find("fault node-reset, node 2"), std::string::npos);
}

// A log in place of the network. The step comes 0.3 s after the first message.
TEST_F(TenonSimTest, AFaultWaitsForTheStepThatTheExecutorsTelemetryTells) {
  const std::string log_file = folder.path() / "run.lcmlog";
  {
    lcm::LogFile log(log_file, "w");
    for (int i = 0; i < 4; ++i) {
      cycle_state_t cycle{};
      cycle.step = static_cast<std::int16_t>(i - 1);
      std::vector<char> bytes(static_cast<std::size_t>(cycle.getEncodedSize()));
      cycle.encode(bytes.data(), 0, static_cast<int>(bytes.size()));
      lcm::LogEvent event{};
      event.eventnum = i;
      event.timestamp = 1'000'000 + 100'000 * i;
      event.channel = "TENON_CYCLE";
      event.datalen = static_cast<int>(bytes.size());
      event.data = bytes.data();
      log.writeEvent(&event);
    }
  }
  const std::string truth_file = folder.path() / "truth.json";
  SimProcess sim(folder.path(), "2",
                 {"--json", truth_file, "--lcm-url", "file://" + log_file, "--fault",
                  "node-reset:node=2,at=step:2", "--fault", "node-reset:node=1,at=step:3"});
  const int connection = connect_to(sim);
  const std::string heard = ask(connection, "O\r", "t702100");
  EXPECT_EQ(heard.find("t701100"), std::string::npos) << heard << ": no step 3 was told";
  close(connection);
  sim.process().send(SIGINT);
  EXPECT_EQ(sim.process().wait(), 0);
  const std::string said = sim.process().err();
  EXPECT_NE(said.find("--fault node-reset:node=1,at=step:3: never struck: that step never ran"),
            std::string::npos)
      << said;
  EXPECT_EQ(said.find("node=2"), std::string::npos) << said;
  const auto truth = nlohmann::json::parse(std::ifstream(truth_file));
  EXPECT_NE(truth["events"].dump().find("fault node-reset, node 2"), std::string::npos);
  EXPECT_EQ(truth["events"].dump().find("fault node-reset, node 1"), std::string::npos);
}

TEST_F(TenonSimTest, AFaultWhoseTimeNeverComesIsNamed) {
  SimProcess sim(folder.path(), "2",
                 {"--fault", "brake-failure:node=3,time_s=5000", "--fault",
                  "torque-loss:node=3,share=0.5,time_s=0"});
  const int connection = connect_to(sim);
  ask(connection, "O\rt60284000100000000000\r", "t5828");
  close(connection);
  sim.process().send(SIGINT);
  EXPECT_EQ(sim.process().wait(), 0);
  const std::string said = sim.process().err();
  EXPECT_EQ(
      said.rfind("tenon-sim: --fault brake-failure:node=3,time_s=5000: never struck: its time "
                 "never came: the cell ran for ",
                 0),
      0U)
      << said;
  EXPECT_EQ(std::count(said.begin(), said.end(), '\n'), 1) << said;
}

TEST_F(TenonSimTest, AStepThatNobodyWouldTellIsRefused) {
  const std::vector<std::string> cell = {
      tests::executable("tenon-sim"), "--cell", tests::gantry_cell_file(),   "--task",
      tests::box_task_file(),         "--can",  "slcan-listen://127.0.0.1:0"};
  const std::pair<std::vector<std::string>, const char*> wrong[] = {
      {{"--fault", "node-reset:node=2,at=step:2"}, "give --lcm-url"},
      {{"--fault", "node-reset:node=2,at=free", "--lcm-url", "udpm://"}, "there is none"},
  };
  for (const auto& [more, said] : wrong) {
    std::vector<std::string> command = cell;
    command.insert(command.end(), more.begin(), more.end());
    tests::ChildProcess child(folder.path(), command);
    EXPECT_EQ(child.wait(), 2);
    EXPECT_NE(child.err().find(said), std::string::npos) << child.err();
  }
}

TEST_F(TenonSimTest, ATruthThatADiskDoesNotTakeIsNamedBehindWhatHappened) {
  const std::string truth_file = folder.path() / "truth.json";
  tests::ChildProcess child(
      folder.path(), {"prlimit", "--fsize=1000:1000", tests::executable("tenon-sim"), "--cell",
                      tests::gantry_cell_file(), "--task", tests::box_task_file(), "--can",
                      "slcan-listen://127.0.0.1:0", "--json", truth_file});
  ASSERT_TRUE(child.wait_until([&] { return child.out().find("listening") != std::string::npos; }));
  child.send(SIGINT);
  EXPECT_EQ(child.wait(), 1);
  EXPECT_NE(child.out().find("the part ended"), std::string::npos) << child.out();
  EXPECT_EQ(child.err(),
            "tenon-sim: lost: --json " + truth_file + ": cannot be written: File too large\n");
}

TEST_F(TenonSimTest, ListsTheFaultsWithoutAnyOtherOption) {
  tests::ChildProcess child(folder.path(), {tests::executable("tenon-sim"), "--fault", "help"});
  EXPECT_EQ(child.wait(), 0);
  for (const char* kind : {"drop", "brake-failure", "torque-loss", "encoder-jump", "bus-off"}) {
    EXPECT_NE(child.out().find(kind), std::string::npos) << kind;
  }
  EXPECT_EQ(child.err(), "");
}

TEST_F(TenonSimTest, BadInputIsOneLineAndStatusTwo) {
  const std::string can = "slcan-listen://127.0.0.1:0";
  const std::vector<std::vector<std::string>> bad = {
      {"--can", can, "--cell", "missing.yaml"},
      {"--can", can, "--start", "99"},
      {"--can", can, "--offset", "z_m=0.1"},
      {"--can", can, "--offset", "x_m=0.1", "--seed", "1"},
      {"--can", can, "--fault", "nonsense"},
      {"--can", can, "--fault", "brake-failure:node=99"},
      {"--can", can, "--experiment", tests::in_tree("sim/experiments/box_on_table.yaml")},
      {"--can", can, "--seed", "1", "--experiment", "missing.yaml"},
      {"--can", "nonsense"},
      {},
  };
  for (const std::vector<std::string>& more : bad) {
    std::vector<std::string> all = {tests::executable("tenon-sim"),
                                    "--cell",
                                    tests::gantry_cell_file(),
                                    "--task",
                                    tests::box_task_file(),
                                    "--start",
                                    "2"};
    // The last of an option given twice would be refused as such: replace instead.
    for (std::size_t i = 0; i + 1 < more.size(); i += 2) {
      const auto at = std::find(all.begin(), all.end(), more[i]);
      if (at != all.end()) all.erase(at, at + 2);
      all.insert(all.end(), {more[i], more[i + 1]});
    }
    tests::ChildProcess child(folder.path(), all);
    EXPECT_EQ(child.wait(), 2) << ::testing::PrintToString(more);
    const std::string error = child.err();
    EXPECT_EQ(std::count(error.begin(), error.end(), '\n'), 1) << error;
    EXPECT_EQ(child.out().find("listening"), std::string::npos);
  }
}

}  // namespace
}  // namespace tenon::sim

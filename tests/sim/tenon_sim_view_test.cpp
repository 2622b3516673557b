// tenon-sim --view as a user has it.

#include <gtest/gtest.h>

#include <csignal>
#include <cstdint>
#include <nlohmann/json.hpp>
#include <string>

#include "sim/view/loopback.h"
#include "tests/support/child_process.h"
#include "tests/support/http_client.h"
#include "tests/support/places.h"
#include "tests/support/scratch_folder.h"
#include "tests/support/sim_process.h"

namespace tenon::sim {
namespace {

using tests::get_request;
using tests::HttpClient;

/// Of "view: http://127.0.0.1:PORT/".
std::uint16_t view_port(const std::string& said) {
  const std::string before = "view: http://127.0.0.1:";
  const std::size_t at = said.find(before);
  return at == std::string::npos
             ? 0
             : static_cast<std::uint16_t>(std::stoi(said.substr(at + before.size())));
}

class TenonSimViewTest : public ::testing::Test {
 protected:
  tests::ScratchFolder folder;
};

TEST_F(TenonSimViewTest, ServesThePageAndTheTruthOfTheRunUntilItEnds) {
  const std::string truth_file = folder.path() / "truth.json";
  tests::SimProcess sim(folder.path(), "2",
                        {"--offset", "x_m=0.02,y_m=-0.01", "--json", truth_file, "--view"});
  const std::uint16_t port = view_port(sim.process().out());
  ASSERT_NE(port, 0) << sim.process().out();
  const std::string host = "127.0.0.1:" + std::to_string(port);
  const std::string page = tests::http_answer(port, get_request("/", host));
  EXPECT_NE(page.find("connect-src 'self'"), std::string::npos);
  EXPECT_NE(page.find("\"kind\":\"live\""), std::string::npos);
  EXPECT_NE(page.find("stands 22.4 mm from where the robot believes it to be"), std::string::npos);

  HttpClient viewer(port);
  HttpClient sleeper(port);
  viewer.send(get_request("/events", host));
  sleeper.send(get_request("/events", host));
  EXPECT_NE(viewer.read_until("\"time_s\":1.0").find("\"enabled\":0,\"braked\":3"),
            std::string::npos);
  sim.process().send(SIGINT);
  EXPECT_EQ(sim.process().wait(), 0);
  const std::string heard = viewer.read_all();
  const std::size_t at = heard.find("event: end\ndata: ");
  ASSERT_NE(at, std::string::npos);
  const std::string line = heard.substr(at + 17, heard.find('\n', at + 17) - at - 17);
  const auto truth = nlohmann::json::parse(folder.get("truth.json"));
  EXPECT_EQ(nlohmann::json::parse(line)["error_m"], truth["error_norm_m"]);
  EXPECT_NE(sim.process().out().find("view: 2 looked on; "), std::string::npos);
  EXPECT_EQ(sim.process().err(), "");
}

TEST_F(TenonSimViewTest, APortThatIsTakenOrNotOursIsOneLineAndStatusTwo) {
  const Descriptor taken = listen_on_loopback(0);
  for (const std::string& view :
       {std::to_string(port_of(taken)), std::string("0.0.0.0:0"), std::string("eighty")}) {
    tests::ChildProcess sim(
        folder.path(),
        {tests::executable("tenon-sim"), "--cell", tests::gantry_cell_file(), "--task",
         tests::box_task_file(), "--can", "slcan-listen://127.0.0.1:0", "--view", view});
    EXPECT_EQ(sim.wait(), 2);
    EXPECT_EQ(sim.err().rfind("tenon-sim: --view " + view + ": ", 0), 0U) << sim.err();
    EXPECT_EQ(sim.err().find('\n'), sim.err().size() - 1) << sim.err();
    EXPECT_EQ(sim.out().find("listening"), std::string::npos);
  }
}

}  // namespace
}  // namespace tenon::sim

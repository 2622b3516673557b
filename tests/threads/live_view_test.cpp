// A live view: a simulation on one thread, viewers that keep up, sleep, come and go on others.

#include "sim/view/live_view.h"

#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <cstdint>
#include <memory>
#include <stdexcept>
#include <string>
#include <thread>

#include "tests/sim/literal_cell.h"
#include "tests/support/http_client.h"

namespace tenon::sim {
namespace {

using tests::get_request;
using tests::HttpClient;

ViewedWorld wall_world(const VirtualCell& cell) {
  ViewedWorld world;
  world.task = wall_task();
  world.cell = "test";
  world.X_BE = cell.environment();
  world.drives = 3;
  world.run_id = "run";
  return world;
}

TEST(LiveViewThreads, ViewersComeSleepAndGoWhileTheCellGoesOn) {
  VirtualCell::Options options;
  options.watched = true;
  LiteralCell bench(gantry_cell(), wall_task(), options);
  LiveView view(0, wall_world(bench.cell));
  const auto port =
      static_cast<std::uint16_t>(std::stoi(view.url().substr(view.url().rfind(':') + 1)));
  const std::string host = "127.0.0.1:" + std::to_string(port);
  HttpClient sleeper(port);
  sleeper.send(get_request("/events", host));
  std::atomic<bool> seen{false};
  std::string heard;
  std::thread viewer([&] {
    for (int i = 0; i < 5; ++i) {  // leaves in the middle of the stream
      HttpClient passing(port);
      passing.send(get_request("/events", host));
      passing.read_until("\"braked\":3");
    }
    HttpClient client(port);
    client.send(get_request("/events", host));
    client.read_until("\"braked\":3");
    seen = true;
    heard = client.read_all();
  });
  while (!seen) {
    bench.step();
    view.look(bench.cell, bench.now_ns);
    std::this_thread::sleep_for(std::chrono::microseconds(200));
  }
  view.end(bench.cell.truth());
  viewer.join();
  EXPECT_NE(heard.find("event: end\ndata: {\"time_s\":"), std::string::npos);
  EXPECT_EQ(view.describe().rfind("view: 7 looked on; ", 0), 0U) << view.describe();
}

TEST(LiveViewThreads, AViewThatNobodyEndsGoesWithItsOwnerAndWaitsForNoViewer) {
  VirtualCell::Options options;
  options.watched = true;
  LiteralCell bench(gantry_cell(), wall_task(), options);
  auto view = std::make_unique<LiveView>(0, wall_world(bench.cell));
  const std::string port = view->url().substr(view->url().rfind(':') + 1);
  HttpClient client(static_cast<std::uint16_t>(std::stoi(port)));
  client.send(get_request("/events", "127.0.0.1:" + port.substr(0, port.size() - 1)));
  EXPECT_NE(client.read_until("event: path").find(" 200 "), std::string::npos);
  view.reset();
  EXPECT_THROW(HttpClient(static_cast<std::uint16_t>(std::stoi(port))), std::runtime_error);
}

}  // namespace
}  // namespace tenon::sim

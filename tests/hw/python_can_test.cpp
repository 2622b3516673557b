// Debian's python-can attaches to the hub over TCP: 5,000 frames there and 5,000 back, and its log
// of them is ours.

#include <gtest/gtest.h>

#include <chrono>
#include <memory>
#include <sstream>
#include <string>
#include <vector>

#include "hw/can/candump_log.h"
#include "hw/can/endpoints.h"
#include "hw/can/recording_bus.h"
#include "hw/can/slcan_server.h"
#include "tests/support/child_process.h"
#include "tests/support/places.h"
#include "tests/support/scratch_folder.h"

namespace tenon::hw {
namespace {

constexpr int kExchanges = 5000;

/// What a log in candump's format says was on the bus, times and channel aside: IDENTIFIER#DATA, of
/// even identifiers (python's) or odd ones (ours), in order. Of remote frames python-can's log does
/// not say the length.
std::vector<std::string> frames_of(const std::string& log, bool odd) {
  std::vector<std::string> frames;
  std::istringstream lines(log);
  std::string time;
  std::string channel;
  std::string frame;
  for (std::string line; std::getline(lines, line);) {
    std::istringstream fields(line);
    fields >> time >> channel >> frame;
    const unsigned long id = std::stoul(frame.substr(0, frame.find('#')), nullptr, 16);
    if ((id % 2 == 1) == odd) frames.push_back(frame.substr(0, frame.find('R')));
  }
  return frames;
}

TEST(PythonCan, ExchangesTenThousandFramesWithoutLossAndItsLogIsOurs) {
  const tests::ScratchFolder folder;
  SlcanServer server(listen_tcp("127.0.0.1", 0));
  const auto ring = std::make_unique<CanRecordRing>();
  RecordingBus bus(server, *ring);
  tests::ChildProcess python(
      folder.path(),
      {"/usr/bin/python3", "-B", tests::in_tree("tests/python/exchange.py"),
       std::to_string(server.port()), std::to_string(kExchanges), folder.path() / "python.log"});

  int received_count = 0;
  bool seen = false;
  const auto serve = [&] {
    for (int round = 0; round < 100; ++round) {
      bus.wait(1'000'000);
      for (ReceivedFrame received; bus.receive(received);) {
        ++received_count;
        ++received.frame.id;
        EXPECT_EQ(bus.send(received.frame), SendResult::kSent);
      }
      seen = seen || server.clients() > 0;
    }
    return seen && server.clients() == 0 && received_count >= kExchanges;
  };
  (void)python.wait_until(serve, std::chrono::seconds(60));
  EXPECT_EQ(python.wait(), 0) << python.err();
  EXPECT_NE(python.out().find("version (10, 13) serial TENO\n5000 answers"), std::string::npos)
      << python.out();

  EXPECT_EQ(received_count, kExchanges);
  EXPECT_EQ(server.status().malformed, 0U);
  EXPECT_EQ(server.status().send_failures, 0U);
  {
    CandumpLog log(folder.path() / "ours.log");
    log.drain(*ring);
  }
  for (const bool odd : {false, true}) {
    const auto theirs = frames_of(folder.get("python.log"), odd);
    const auto ours = frames_of(folder.get("ours.log"), odd);
    EXPECT_EQ(ours.size(), static_cast<std::size_t>(kExchanges));
    EXPECT_EQ(theirs, ours);
  }
}

}  // namespace
}  // namespace tenon::hw

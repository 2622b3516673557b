// The transports as buses: frames go in at one end and come out at the others. Loopback sockets and
// a pty; bounded waits, no assertion on time.

#include <fcntl.h>
#include <gtest/gtest.h>
#include <linux/can/error.h>
#include <stdlib.h>
#include <sys/socket.h>
#include <unistd.h>

#include <array>
#include <cstring>
#include <fstream>
#include <memory>
#include <random>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include "hw/can/candump_log.h"
#include "hw/can/endpoints.h"
#include "hw/can/open_bus.h"
#include "hw/can/recording_bus.h"
#include "hw/can/slcan_client.h"
#include "hw/can/slcan_server.h"
#include "hw/can/slcan_stream.h"
#include "hw/can/socketcan_errors.h"
#include "shared/base/error.h"
#include "sim/bus/virtual_bus.h"
#include "tests/support/refusal.h"

namespace tenon::hw {
namespace {

CanFrame frame_of(std::uint32_t id, std::uint8_t value) { return {id, false, false, 1, {value}}; }

/// Waits for a frame, a bounded number of times.
bool receive_soon(CanBus& bus, ReceivedFrame& received) {
  for (int i = 0; i < 200; ++i) {
    if (bus.receive(received)) return true;
    bus.wait(10'000'000);
  }
  return false;
}

/// A server and clients with open channels on a free port.
struct Loopback {
  Loopback() : server(open_bus("slcan-listen://127.0.0.1:0", 1'000'000)) {}

  std::unique_ptr<CanBus> connect() {
    const std::size_t before = listening().clients();
    auto client =
        open_bus("slcan://127.0.0.1:" + std::to_string(listening_port(*server)), 1'000'000);
    ReceivedFrame received;
    for (int i = 0; i < 200 && listening().clients() == before; ++i) {
      server->wait(10'000'000);
      EXPECT_FALSE(server->receive(received));
    }
    EXPECT_EQ(listening().clients(), before + 1);
    return client;
  }
  [[nodiscard]] const SlcanServer& listening() const {
    return dynamic_cast<const SlcanServer&>(*server);
  }

  std::unique_ptr<CanBus> server;
};

TEST(SlcanOverTcp, FramesGoBothWays) {
  Loopback loopback;
  const auto client = loopback.connect();
  ReceivedFrame received;
  EXPECT_EQ(client->send(frame_of(0x201, 7)), SendResult::kSent);
  client->wait(0);
  ASSERT_TRUE(receive_soon(*loopback.server, received));
  EXPECT_EQ(received.frame, frame_of(0x201, 7));
  EXPECT_GT(received.time_ns, 0);
  EXPECT_EQ(loopback.server->send(frame_of(0x190, 8)), SendResult::kSent);
  loopback.server->wait(0);
  ASSERT_TRUE(receive_soon(*client, received));
  EXPECT_EQ(received.frame, frame_of(0x190, 8));
  EXPECT_EQ(client->status().malformed, 0u);
}

TEST(SlcanOverTcp, FramesOfAClientReachTheOtherClients) {
  Loopback loopback;
  const auto first = loopback.connect();
  const auto second = loopback.connect();
  EXPECT_EQ(first->send(frame_of(0x123, 1)), SendResult::kSent);
  first->wait(0);
  ReceivedFrame received;
  ASSERT_TRUE(receive_soon(*loopback.server, received));
  loopback.server->wait(0);
  ASSERT_TRUE(receive_soon(*second, received));
  EXPECT_EQ(received.frame, frame_of(0x123, 1));
  EXPECT_FALSE(first->receive(received));
}

TEST(SlcanOverTcp, ThousandsOfFramesArriveWholeAndInOrder) {
  Loopback loopback;
  const auto client = loopback.connect();
  std::uint32_t expected = 0;
  ReceivedFrame received;
  for (std::uint32_t i = 0; i < 5000; ++i) {
    ASSERT_EQ(client->send({i & 0x7FF, false, false, 8, {1, 2, 3, 4, 5, 6, 7, 8}}),
              SendResult::kSent);
    if (i % 10 != 9) continue;
    client->wait(0);
    while (expected <= i) {
      ASSERT_TRUE(receive_soon(*loopback.server, received));
      ASSERT_EQ(received.frame.id, expected++ & 0x7FF);
    }
  }
  EXPECT_EQ(loopback.server->status().malformed, 0u);
  EXPECT_EQ(loopback.server->status().received, 5000u);
}

TEST(SlcanOverTcp, ClosedServerIsDownNotAnException) {
  Loopback loopback;
  const auto client = loopback.connect();
  loopback.server.reset();
  ReceivedFrame received;
  for (int i = 0; i < 200 && client->status().up; ++i) {
    EXPECT_FALSE(client->receive(received));
    client->wait(10'000'000);
  }
  EXPECT_FALSE(client->status().up);
  EXPECT_EQ(client->send(frame_of(1, 1)), SendResult::kDown);
}

TEST(SlcanOverTcp, ClientThatGoesAwayIsForgottenAndAnotherMayCome) {
  Loopback loopback;
  loopback.connect().reset();
  ReceivedFrame received;
  for (int i = 0; i < 200 && loopback.listening().clients() > 0; ++i) {
    loopback.server->wait(10'000'000);
    EXPECT_FALSE(loopback.server->receive(received));
  }
  EXPECT_EQ(loopback.listening().clients(), 0u);
  EXPECT_EQ(loopback.server->send(frame_of(1, 1)), SendResult::kSent) << "nobody listens";
  EXPECT_TRUE(loopback.server->status().up);
  const auto client = loopback.connect();
  EXPECT_TRUE(client->status().up);
}

TEST(SlcanOverTcp, ReaderThatSleepsCostsFramesNotTime) {
  Loopback loopback;
  const auto client = loopback.connect();  // never reads
  SendResult result = SendResult::kSent;
  std::uint64_t sent = 0;
  for (; sent < 10'000'000 && result == SendResult::kSent; ++sent) {
    result = loopback.server->send(frame_of(0x190, static_cast<std::uint8_t>(sent)));
    if (sent % 16 == 0) loopback.server->wait(0);
  }
  EXPECT_EQ(result, SendResult::kQueueFull);
  EXPECT_GT(loopback.server->status().send_failures, 0u);
  // What does arrive is still whole, and once the reader has caught up the bus goes on.
  ReceivedFrame received;
  std::uint64_t arrived = 0;
  for (int i = 0; i < 500 && result != SendResult::kSent; ++i) {
    while (client->receive(received)) {
      ASSERT_EQ(received.frame.id, 0x190u);
      ++arrived;
    }
    client->wait(1'000'000);
    result = loopback.server->send(frame_of(0x191, 1));
  }
  EXPECT_EQ(result, SendResult::kSent);
  EXPECT_GT(arrived, 100u);
  EXPECT_EQ(client->status().malformed, 0u);
}

/// A bare TCP connection, as a terminal makes it.
class Terminal {
 public:
  explicit Terminal(std::uint16_t port) : descriptor_(connect_tcp("127.0.0.1", port)) {}
  ~Terminal() { ::close(descriptor_); }
  Terminal(const Terminal&) = delete;
  Terminal& operator=(const Terminal&) = delete;

  /// Sends a text and reads until `expected` characters are there, for a bounded time.
  std::string exchange(CanBus& server, const std::string& text, std::size_t expected) {
    EXPECT_EQ(::send(descriptor_, text.data(), text.size(), 0), static_cast<ssize_t>(text.size()));
    std::string answer;
    for (int i = 0; i < 20 && (i == 0 || answer.size() < expected); ++i) {
      server.wait(1'000'000);
      ReceivedFrame received;
      while (server.receive(received)) frames.push_back(received.frame);
      std::array<char, 256> buffer{};
      const ssize_t count = ::recv(descriptor_, buffer.data(), buffer.size(), MSG_DONTWAIT);
      if (count > 0) answer.append(buffer.data(), static_cast<std::size_t>(count));
    }
    return answer;
  }

  /// Reads whatever is on the way.
  void discard(CanBus& server) {
    std::vector<char> buffer(1 << 16);
    while (::recv(descriptor_, buffer.data(), buffer.size(), MSG_DONTWAIT) > 0) server.wait(0);
  }

  std::vector<CanFrame> frames;

 private:
  int descriptor_;
};

TEST(SlcanServer, AnswersEachLineAsAnAdapterDoes) {
  Loopback loopback;
  Terminal terminal(listening_port(*loopback.server));
  const std::pair<const char*, const char*> exchanges[] = {
      {"V\r", "V1013\r"},      {"N\r", "NTENO\r"},      {"C\r", "\a"},  // closed already
      {"t1230\r", "\a"},                                                // on a closed channel
      {"F\r", "\a"},                                                    // of a closed channel
      {"S9\r", "\a"},                                                   // there are S0 to S8
      {"S8\r", "\r"},          {"s031C\r", "\r"},       {"Z0\r", "\r"},
      {"O\r", "\r"},           {"O\r", "\a"},  // open already
      {"S6\r", "\a"},                          // too late
      {"t1230\r", "z\r"},      {"T000001230\r", "Z\r"}, {"r1234\r", "z\r"},
      {"R000001234\r", "Z\r"}, {"t1239\r", "\a"},  // no frame has nine bytes
      {"nonsense\r", "\a"},    {"P\r", "\a"},      // polling is not needed
      {"F\r", "F00\r"},        {"C\r", "\r"},           {"L\r", "\r"},
      {"t1230\r", "\a"},  // only listens
      {"C\r", "\r"},
  };
  for (const auto& [line, answer] : exchanges) {
    EXPECT_EQ(terminal.exchange(*loopback.server, line, std::strlen(answer)), answer) << line;
  }
  ASSERT_EQ(terminal.frames.size(), 4u);
  EXPECT_EQ(terminal.frames[0], (CanFrame{0x123, false, false, 0, {}}));
  EXPECT_EQ(terminal.frames[3], (CanFrame{0x123, true, true, 4, {}}));
  EXPECT_EQ(terminal.exchange(*loopback.server, "V\rrubbish\rS8\rO\r", 9), "V1013\r\a\r\r")
      << "in order, also where they come together";
  EXPECT_EQ(loopback.server->status().malformed, 3u);
}

TEST(SlcanServer, StampsFramesForWhoAsksForIt) {
  Loopback loopback;
  Terminal terminal(listening_port(*loopback.server));
  EXPECT_EQ(terminal.exchange(*loopback.server, "Z1\rO\r", 2), "\r\r");
  EXPECT_EQ(loopback.server->send(frame_of(0x190, 7)), SendResult::kSent);
  const std::string line = terminal.exchange(*loopback.server, "", 12);
  ASSERT_EQ(line.size(), 12u) << line;
  EXPECT_EQ(line.substr(0, 7), "t190107");
  EXPECT_LT(std::stoul(line.substr(7, 4), nullptr, 16), 60'000u);
}

TEST(SlcanServer, RubbishFromOneClientNeverDisturbsTheOthers) {
  Loopback loopback;
  Terminal vandal(listening_port(*loopback.server));
  const auto client = loopback.connect();
  std::mt19937 random(3);
  ReceivedFrame received;
  for (std::uint8_t i = 0; i < 100; ++i) {
    std::string rubbish;
    for (int k = 0; k < 200; ++k) rubbish += static_cast<char>(random());
    (void)vandal.exchange(*loopback.server, rubbish, 0);
    ASSERT_EQ(client->send(frame_of(0x123, i)), SendResult::kSent);
    client->wait(0);
    ASSERT_TRUE(receive_soon(*loopback.server, received));
    ASSERT_EQ(received.frame, frame_of(0x123, i));
    ASSERT_EQ(loopback.server->send(frame_of(0x190, i)), SendResult::kSent);
    loopback.server->wait(0);
    ASSERT_TRUE(receive_soon(*client, received));
    ASSERT_EQ(received.frame, frame_of(0x190, i));
  }
  EXPECT_TRUE(vandal.frames.empty());
  EXPECT_GT(loopback.server->status().malformed, 10u);
  EXPECT_EQ(client->status().malformed, 0u);
  EXPECT_EQ(client->status().error_frames, 0u) << "nothing of ours was refused";
}

TEST(SlcanServer, ASlowReaderLosesCountedFramesAndTheOthersNone) {
  Loopback loopback;
  Terminal sleeper(listening_port(*loopback.server));
  EXPECT_EQ(sleeper.exchange(*loopback.server, "O\r", 1), "\r");
  const auto client = loopback.connect();
  ReceivedFrame received;
  const CanFrame frame{0x1ABCDEF0, true, false, 8, {1, 2, 3, 4, 5, 6, 7, 8}};
  for (int burst = 0; loopback.server->status().send_failures < 100 && burst < 10'000; ++burst) {
    for (int i = 0; i < 100; ++i) {
      ASSERT_EQ(loopback.server->send(frame), SendResult::kSent) << "the client takes it";
    }
    loopback.server->wait(0);
    for (int i = 0; i < 100; ++i) ASSERT_TRUE(receive_soon(*client, received));
    ASSERT_EQ(received.frame, frame);
  }
  EXPECT_GE(loopback.server->status().send_failures, 100u);
  // Once it reads again it is told, once.
  sleeper.discard(*loopback.server);
  EXPECT_EQ(sleeper.exchange(*loopback.server, "F\rF\r", 8), "F08\rF00\r");
}

TEST(SlcanOverSerial, OpensTheChannelAndExchangesFramesOverAPty) {
  const int adapter = ::posix_openpt(O_RDWR | O_NOCTTY | O_NONBLOCK);
  ASSERT_GE(adapter, 0);
  ASSERT_EQ(::grantpt(adapter), 0);
  ASSERT_EQ(::unlockpt(adapter), 0);
  {
    const auto bus = open_bus(std::string("slcan:") + ::ptsname(adapter), 500'000);
    EXPECT_EQ(bus->send({0x201, false, false, 2, {0x0F, 0x00}}), SendResult::kSent);
    bus->wait(0);
    // A pty hands over what was written in pieces of its own choosing.
    const std::string expected = "C\rS6\rO\rt20120F00\r";
    std::array<char, 256> buffer{};
    ssize_t count = 0;
    std::string opening;
    for (int tries = 0; tries < 100'000 && opening.size() < expected.size(); ++tries) {
      count = ::read(adapter, buffer.data(), buffer.size());
      if (count > 0) opening.append(buffer.data(), static_cast<std::size_t>(count));
    }
    EXPECT_EQ(opening, expected);
    const std::string answer = "\r\r\r\at1902ABCD\r";
    ASSERT_EQ(::write(adapter, answer.data(), answer.size()), static_cast<ssize_t>(answer.size()));
    ReceivedFrame received;
    ASSERT_TRUE(receive_soon(*bus, received));
    EXPECT_EQ(received.frame, (CanFrame{0x190, false, false, 2, {0xAB, 0xCD}}));
    EXPECT_EQ(bus->status().error_frames, 1u);
  }
  ::close(adapter);
}

TEST(SlcanStream, LineThatWasCutByAFullDeviceIsFinishedAndLaterOnesAreDropped) {
  const int adapter = ::posix_openpt(O_RDWR | O_NOCTTY | O_NONBLOCK);
  ASSERT_EQ(::grantpt(adapter), 0);
  ASSERT_EQ(::unlockpt(adapter), 0);
  {
    SlcanStream stream;
    stream.adopt(open_serial(::ptsname(adapter)));
    const std::string line = "T1ABCDEF08A1A2A3A4A5A6A7A\r";  // 26: no power of two divides it
    bool taken = true;
    for (int i = 0; i < 10'000 && taken; ++i) {
      taken = stream.stage(line);
      if (i % 50 == 49) stream.flush();
    }
    ASSERT_FALSE(taken);
    EXPECT_GT(stream.dropped(), 0u);
    std::string text;
    std::array<char, 4096> buffer{};
    for (int i = 0; i < 100; ++i) {
      const ssize_t count = ::read(adapter, buffer.data(), buffer.size());
      if (count > 0) text.append(buffer.data(), static_cast<std::size_t>(count));
      stream.flush();
    }
    ASSERT_TRUE(stream.stage("t0800\r"));
    stream.flush();
    const ssize_t count = ::read(adapter, buffer.data(), buffer.size());
    ASSERT_GT(count, 0);
    text.append(buffer.data(), static_cast<std::size_t>(count));
    std::size_t at = 0;
    while (text.compare(at, line.size(), line) == 0) at += line.size();
    EXPECT_GT(at, line.size());
    EXPECT_EQ(text.substr(at), "t0800\r");
  }
  ::close(adapter);
}

std::string refusal(const std::string& uri) {
  return tests::refusal([&] { (void)open_bus(uri, 1'000'000); });
}

TEST(OpenBus, RefusesWhatItCannotOpenInOneLineThatNamesIt) {
  for (const char* uri :
       {"", "can0", "slcan:ttyACM0", "slcan://", "slcan://127.0.0.1", "slcan://127.0.0.1:x",
        "slcan://127.0.0.1:70000", "slcan:/dev/nothing", "slcan-listen://127.0.0.1:-1",
        "socketcan:", "socketcan:none0", "socketcan:a-name-that-is-too-long"}) {
    const std::string message = refusal(uri);
    EXPECT_NE(message, "accepted") << uri;
    EXPECT_NE(message.find(uri), std::string::npos) << uri << " -> " << message;
    EXPECT_EQ(message.find('\n'), std::string::npos);
  }
  const auto server = open_bus("slcan-listen://127.0.0.1:0", 1'000'000);
  const std::string taken = "slcan-listen://127.0.0.1:" + std::to_string(listening_port(*server));
  EXPECT_NE(refusal(taken).find("cannot listen"), std::string::npos);
}

TEST(OpenBus, RefusesABitrateThatSlcanCannotSet) {
  Loopback loopback;
  EXPECT_THROW(
      (void)open_bus("slcan://127.0.0.1:" + std::to_string(listening_port(*loopback.server)),
                     123'456),
      InputError);
}

TEST(SocketcanErrors, BusOffPassiveAndOverrunsAreDecoded) {
  CanBusStatus status;
  apply_error_frame(CAN_ERR_CRTL, {0, CAN_ERR_CRTL_TX_PASSIVE}, status);
  EXPECT_TRUE(status.error_passive);
  apply_error_frame(CAN_ERR_CRTL, {0, CAN_ERR_CRTL_ACTIVE}, status);
  EXPECT_FALSE(status.error_passive);
  apply_error_frame(CAN_ERR_CRTL, {0, CAN_ERR_CRTL_RX_OVERFLOW}, status);
  EXPECT_EQ(status.overruns, 1u);
  apply_error_frame(CAN_ERR_BUSOFF, {}, status);
  EXPECT_TRUE(status.bus_off);
  apply_error_frame(CAN_ERR_RESTARTED, {}, status);
  EXPECT_FALSE(status.bus_off);
  EXPECT_EQ(status.error_frames, 5u);
}

TEST(CandumpLog, LinesAreCandumps) {
  const CanFrame setpoint{0x201, false, false, 4, {0x0F, 0x00, 0x01, 0x02}};
  EXPECT_EQ(candump_line({setpoint, 1'500'000'000}, "can0"), "(1.500000) can0 201#0F000102");
  EXPECT_EQ(candump_line({{0x12345, true, false, 1, {0xFF}}, 1'999}, "can1"),
            "(0.000001) can1 00012345#FF");
  EXPECT_EQ(candump_line({{0x080, false, false, 0, {}}, 0}, "can0"), "(0.000000) can0 080#");
  EXPECT_EQ(candump_line({{0x201, false, true, 6, {}}, 0}, "can0"), "(0.000000) can0 201#R6");
}

std::int64_t fixed_clock() noexcept { return 2'000'000'000; }

TEST(RecordingBus, EveryFrameThatPassedIsInTheLog) {
  sim::VirtualBus bus{{.bitrate_bps = 0}};
  CanBus& end = bus.attach();
  CanBus& other = bus.attach();
  const auto ring = std::make_unique<CanRecordRing>();
  RecordingBus recording(end, *ring, &fixed_clock);
  EXPECT_EQ(recording.send(frame_of(0x201, 1)), SendResult::kSent);
  bus.advance(3'000'000'000);
  EXPECT_EQ(other.send(frame_of(0x190, 2)), SendResult::kSent);
  ReceivedFrame received;
  EXPECT_TRUE(recording.receive(received));
  EXPECT_FALSE(recording.receive(received));
  bus.set_up(false);
  EXPECT_EQ(recording.send(frame_of(0x202, 1)), SendResult::kDown);
  EXPECT_FALSE(recording.status().up);

  const std::string file = testing::TempDir() + "tenon_candump_test.log";
  {
    CandumpLog log(file);
    log.drain(*ring);
    EXPECT_TRUE(log.good());
  }
  std::stringstream text;
  text << std::ifstream(file).rdbuf();
  EXPECT_EQ(text.str(), "(2.000000) can0 201#01\n(3.000000) can0 190#02\n");
  ::unlink(file.c_str());
  EXPECT_THROW(CandumpLog("/nowhere/run.log"), InputError);
}

}  // namespace
}  // namespace tenon::hw

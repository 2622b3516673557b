// slcan over TCP as a bus: frames go in at one end and come out at the others. Loopback sockets;
// bounded waits, no assertion on time.

#include <gtest/gtest.h>
#include <netdb.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <sys/time.h>

#include <array>
#include <cerrno>
#include <csignal>
#include <cstring>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include "hw/can/endpoints.h"
#include "tests/hw/loopback.h"

namespace tenon::hw {
namespace {

TEST(SlcanOverTcp, FramesGoBothWays) {
  Loopback loopback;
  const auto client = loopback.connect();
  ReceivedFrame received;
  EXPECT_EQ(client->send(frame_of(0x201, 7)), SendResult::kSent);
  client->flush();
  ASSERT_TRUE(receive_soon(*loopback.server, received));
  EXPECT_EQ(received.frame, frame_of(0x201, 7));
  EXPECT_GT(received.time_ns, 0);
  EXPECT_EQ(loopback.server->send(frame_of(0x190, 8)), SendResult::kSent);
  loopback.server->flush();
  ASSERT_TRUE(receive_soon(*client, received));
  EXPECT_EQ(received.frame, frame_of(0x190, 8));
  EXPECT_EQ(client->status().malformed, 0u);
}

class Alarms {
 public:
  Alarms() {
    struct sigaction action {};
    action.sa_handler = [](int) {};  // without SA_RESTART, as where a stop is asked for
    ::sigaction(SIGALRM, &action, &before_);
    const itimerval often{{0, 15}, {0, 15}};
    ::setitimer(ITIMER_REAL, &often, nullptr);
  }
  ~Alarms() {
    const itimerval never{};
    ::setitimer(ITIMER_REAL, &never, nullptr);
    ::sigaction(SIGALRM, &before_, nullptr);
  }
  Alarms(const Alarms&) = delete;
  Alarms& operator=(const Alarms&) = delete;

 private:
  struct sigaction before_ {};
};

// A stop that is asked for while a bus is being opened ends the run in good order, not as one whose
// bus cannot be reached.
TEST(SlcanOverTcp, ASignalDoesNotBreakAConnectionThatIsBeingMade) {
  const Descriptor listener = listen_tcp("127.0.0.1", 0);
  sockaddr_in open{};
  socklen_t size = sizeof(open);
  ASSERT_EQ(::getsockname(listener.get(), reinterpret_cast<sockaddr*>(&open), &size), 0);
  const Alarms alarms;
  for (int k = 0; k < 2000; ++k) {
    ASSERT_TRUE(connect_tcp("127.0.0.1", ntohs(open.sin_port)).is_open()) << k;
    while (!Descriptor(::accept(listener.get(), nullptr, nullptr)).is_open()) {
    }
  }
}

// As where a host's first address is one of IPv6 that the other end does not serve.
TEST(SlcanOverTcp, AHostsOtherAddressesAreTriedToo) {
  const Descriptor listener = listen_tcp("127.0.0.1", 0);
  sockaddr_in open{};
  socklen_t size = sizeof(open);
  ASSERT_EQ(::getsockname(listener.get(), reinterpret_cast<sockaddr*>(&open), &size), 0);
  sockaddr_in closed = open;
  closed.sin_port = htons(1);
  addrinfo second{};
  second.ai_family = AF_INET;
  second.ai_addr = reinterpret_cast<sockaddr*>(&open);
  second.ai_addrlen = size;
  addrinfo first = second;
  first.ai_addr = reinterpret_cast<sockaddr*>(&closed);
  EXPECT_FALSE(connect_any(&first).is_open());
  EXPECT_EQ(errno, ECONNREFUSED);
  first.ai_next = &second;
  EXPECT_TRUE(connect_any(&first).is_open());
}

TEST(SlcanOverTcp, FramesOfAClientReachTheOtherClients) {
  Loopback loopback;
  const auto first = loopback.connect();
  const auto second = loopback.connect();
  EXPECT_EQ(first->send(frame_of(0x123, 1)), SendResult::kSent);
  first->flush();
  ReceivedFrame received;
  ASSERT_TRUE(receive_soon(*loopback.server, received));
  loopback.server->flush();
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
    client->flush();
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
    if (sent % 16 == 0) loopback.server->flush();
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
  explicit Terminal(std::uint16_t port) : socket_(connect_tcp("127.0.0.1", port)) {}

  /// Sends a text and reads until `expected` characters are there, for a bounded time.
  std::string exchange(CanBus& server, const std::string& text, std::size_t expected) {
    EXPECT_EQ(::send(socket_.get(), text.data(), text.size(), 0),
              static_cast<ssize_t>(text.size()));
    std::string answer;
    for (int i = 0; i < 20 && (i == 0 || answer.size() < expected); ++i) {
      server.wait(1'000'000);
      ReceivedFrame received;
      while (server.receive(received)) frames.push_back(received.frame);
      std::array<char, 256> buffer{};
      const ssize_t count = ::recv(socket_.get(), buffer.data(), buffer.size(), MSG_DONTWAIT);
      if (count > 0) answer.append(buffer.data(), static_cast<std::size_t>(count));
    }
    return answer;
  }

  /// Reads whatever is on the way.
  void discard(CanBus& server) {
    std::vector<char> buffer(1 << 16);
    while (::recv(socket_.get(), buffer.data(), buffer.size(), MSG_DONTWAIT) > 0) server.flush();
  }

  std::vector<CanFrame> frames;

 private:
  Descriptor socket_;
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
    client->flush();
    ASSERT_TRUE(receive_soon(*loopback.server, received));
    ASSERT_EQ(received.frame, frame_of(0x123, i));
    ASSERT_EQ(loopback.server->send(frame_of(0x190, i)), SendResult::kSent);
    loopback.server->flush();
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
    loopback.server->flush();
    for (int i = 0; i < 100; ++i) ASSERT_TRUE(receive_soon(*client, received));
    ASSERT_EQ(received.frame, frame);
  }
  EXPECT_GE(loopback.server->status().send_failures, 100u);
  // Once it reads again it is told, once.
  sleeper.discard(*loopback.server);
  EXPECT_EQ(sleeper.exchange(*loopback.server, "F\rF\r", 8), "F08\rF00\r");
}

}  // namespace
}  // namespace tenon::hw

// An slcan server on one thread, a client that keeps up and one that sleeps on threads of their
// own.

#include "hw/can/slcan_server.h"

#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <cstdint>
#include <memory>
#include <string>
#include <thread>

#include "hw/can/endpoints.h"
#include "hw/can/open_bus.h"

namespace tenon::hw {
namespace {

constexpr std::chrono::nanoseconds kTurn{1'000'000};
constexpr std::uint32_t kQuestions = 2000;
constexpr std::uint32_t kAnswer = 0x190;

CanFrame question(std::uint32_t number) {
  return {0x100,
          false,
          false,
          4,
          {static_cast<std::uint8_t>(number), static_cast<std::uint8_t>(number >> 8), 0, 0}};
}

/// Asks, and waits for each answer. @return answers that were not to the question
std::uint32_t ask_all(const std::string& uri) {
  const auto bus = open_bus(uri, 1'000'000);
  std::uint32_t wrong = 0;
  for (std::uint32_t number = 0; number < kQuestions; ++number) {
    const CanFrame asked = question(number);
    if (bus->send(asked) != SendResult::kSent) ++wrong;
    ReceivedFrame received;
    int patience = 10'000;
    while (!bus->receive(received) && patience-- > 0) bus->wait(kTurn.count());
    if (received.frame.id != kAnswer || received.frame.data != asked.data) ++wrong;
  }
  return wrong;
}

TEST(SlcanServerThreads, AClientThatSleepsCostsTheOneThatAsksNothing) {
  const auto server = open_bus("slcan-listen://127.0.0.1:0", 1'000'000);
  const std::string uri = "slcan://127.0.0.1:" + std::to_string(listening_port(*server));
  std::atomic<bool> asleep{false};
  std::atomic<bool> done{false};
  std::uint32_t wrong = 0;
  std::thread sleeper([&] {
    const auto bus = open_bus(uri, 1'000'000);  // reads nothing until all is over
    asleep = true;
    while (!done) std::this_thread::sleep_for(kTurn);
    ReceivedFrame received;
    EXPECT_TRUE(bus->receive(received));
  });
  std::thread asker([&] {
    while (!asleep) std::this_thread::sleep_for(kTurn);
    wrong = ask_all(uri);
    done = true;
  });
  while (!done) {
    ReceivedFrame received;
    while (server->receive(received)) {
      received.frame.id = kAnswer;
      EXPECT_NE(server->send(received.frame), SendResult::kDown);
    }
    server->wait(kTurn.count());
  }
  asker.join();
  sleeper.join();
  EXPECT_EQ(wrong, 0U);
  EXPECT_EQ(server->status().received, kQuestions);
  EXPECT_EQ(server->status().malformed, 0U);
}

}  // namespace
}  // namespace tenon::hw

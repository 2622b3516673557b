#pragma once
// An slcan server and its clients in one process. Bounded waits.

#include <gtest/gtest.h>

#include <cstdint>
#include <memory>
#include <string>

#include "hw/can/open_bus.h"
#include "hw/can/slcan_server.h"
#include "shared/ports/can_bus.h"

namespace tenon::hw {

inline CanFrame frame_of(std::uint32_t id, std::uint8_t value) {
  return {id, false, false, 1, {value}};
}

/// Waits for a frame, a bounded number of times.
inline bool receive_soon(CanBus& bus, ReceivedFrame& received) {
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

}  // namespace tenon::hw

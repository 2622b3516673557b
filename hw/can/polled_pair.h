#pragma once
// Two buses of the system as one (shared/bus/bus_pair.h), waited for together.

#include <poll.h>

#include <array>
#include <cstdint>

#include "hw/can/poll_wait.h"
#include "shared/bus/bus_pair.h"

namespace tenon::hw {

class PolledPair final : public BusPair {
 public:
  using BusPair::BusPair;

  void wait(std::int64_t at_most_ns) noexcept override {
    flush();
    if (at_most_ns <= 0 || fetch()) return;
    std::array<pollfd, kBuses> wanted{};
    for (std::size_t i = 0; i < kBuses; ++i) {
      wanted[i] = {buses()[i]->descriptor(), POLLIN, 0};  // negative ones are skipped
    }
    (void)poll_wait(wanted, at_most_ns);
  }
};

}  // namespace tenon::hw

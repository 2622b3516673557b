#pragma once
// Two CAN buses as one, the arm's and one that the force/torque sensor has to itself: a frame
// leaves by the bus that it names, and names the one that it came by. What both have heard is read
// in the order of its arrival.
//
// Real-time as the two are; one thread; both outlive it.

#include <array>
#include <cstdint>
#include <optional>

#include "shared/ports/can_bus.h"

namespace tenon {

class BusPair : public CanBus {
 public:
  static constexpr std::size_t kBuses = 2;

  /// @param first bus 0  @param second bus 1
  BusPair(CanBus& first, CanBus& second) : buses_{&first, &second} {}

  [[nodiscard]] SendResult send(const CanFrame& frame) noexcept override;
  [[nodiscard]] bool receive(ReceivedFrame& received) noexcept override;
  void flush() noexcept override;
  /// As in lockstep: returns at once.
  void wait(std::int64_t at_most_ns) noexcept override;
  /// Up where both are. Counters are of both together.
  [[nodiscard]] CanBusStatus status() const noexcept override;

 protected:
  /// A frame is there already.
  [[nodiscard]] bool fetch() noexcept;
  [[nodiscard]] const std::array<CanBus*, kBuses>& buses() const { return buses_; }

 private:
  std::array<CanBus*, kBuses> buses_;
  std::array<std::optional<ReceivedFrame>, kBuses> next_;  ///< taken from a bus, not yet read
};

}  // namespace tenon

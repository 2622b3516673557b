#pragma once
// The devices' end of a bus that is not ours (slcan, SocketCAN), with the faults of a bus: what the
// stand-alone virtual arm puts between itself and the wire. Frames pass in both directions by the
// same faults as on a virtual bus; only times are as coarse as the caller's. A master's bus-off is
// seen from here as silence both ways.
//
// Time is the caller's: call advance() before each round. One thread; the bus must outlive it.

#include <cstdint>
#include <deque>
#include <span>

#include "shared/ports/can_bus.h"
#include "sim/cell/faults/bus_faults.h"
#include "sim/cell/faults/fault.h"

namespace tenon::sim {

class FaultyBus final : public CanBus {
 public:
  /// @param now_ns time 0 of the faults
  /// @param phases of the cell, for faults that wait for one; must outlive this
  FaultyBus(CanBus& bus, std::span<const Fault> faults, std::uint8_t master_node,
            std::int64_t now_ns, const FaultPhases* phases = nullptr);

  /// Delayed frames whose time has come move on.
  void advance(std::int64_t now_ns);

  [[nodiscard]] SendResult send(const CanFrame& frame) noexcept override;
  [[nodiscard]] bool receive(ReceivedFrame& received) noexcept override;
  void flush() noexcept override { bus_.flush(); }
  void wait(std::int64_t at_most_ns) noexcept override { bus_.wait(at_most_ns); }
  [[nodiscard]] CanBusStatus status() const noexcept override;

 private:
  static constexpr std::size_t kOurs = 0;    ///< the end that sends, as a disturbance knows it
  static constexpr std::size_t kMaster = 1;  ///< whatever is on the wire
  struct Delayed {
    CanFrame frame;
    std::int64_t due_ns = 0;
    bool outgoing = false;
  };

  [[nodiscard]] bool master_gone() const noexcept { return faults_.bus_off(master_node_, now_ns_); }
  void arrive(const ReceivedFrame& received);

  CanBus& bus_;
  BusFaults faults_;
  std::uint8_t master_node_;
  std::int64_t now_ns_;
  std::deque<Delayed> delayed_;
  std::deque<ReceivedFrame> arrived_;
};

}  // namespace tenon::sim

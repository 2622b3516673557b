#pragma once
// A link over two ends of a bus that is not ours, such as two sockets on one SocketCAN interface:
// there, frames take no virtual time. The link counts what each end sent and the other received,
// and so knows without a clock when the bus is quiet; for a frame that is missing it waits in real
// time, for a while, and then takes it as lost. One thread; the ends must outlive it.

#include <array>
#include <cstddef>
#include <cstdint>
#include <deque>

#include "shared/ports/can_bus.h"
#include "sim/cell/lockstep/link.h"

namespace tenon::sim {

class ForeignLink final : public Link {
 public:
  /// @param patience_ns real time that a frame may take; waited in tenths
  ForeignLink(CanBus& master, CanBus& devices, std::int64_t patience_ns);

  [[nodiscard]] CanBus& master() override { return master_; }
  [[nodiscard]] CanBus& devices() override { return devices_; }
  [[nodiscard]] std::int64_t advance(std::int64_t until_ns) override;
  [[nodiscard]] bool at_master() const override { return !master_.arrived.empty(); }
  [[nodiscard]] bool at_devices() const override { return !devices_.arrived.empty(); }
  [[nodiscard]] bool from_master() const override { return devices_.expected > 0; }

  /// Frames that were sent and did not come.
  [[nodiscard]] std::uint64_t lost() const { return lost_; }

 private:
  /// What each side of the lockstep sees of its end.
  struct Side final : CanBus {
    Side(CanBus& end_in, Side& other_in) : end(end_in), other(other_in) {}
    SendResult send(const CanFrame& frame) noexcept override;
    bool receive(ReceivedFrame& received) noexcept override;
    void flush() noexcept override { end.flush(); }
    void wait(std::int64_t /*at_most_ns*/) noexcept override { end.flush(); }
    CanBusStatus status() const noexcept override { return end.status(); }
    /// Takes in what there is; false: nothing.
    bool take(std::int64_t now_ns);

    CanBus& end;
    Side& other;
    std::deque<ReceivedFrame> arrived;
    std::uint64_t expected = 0;  ///< sent by the other side and not here yet
  };

  Side master_;
  Side devices_;
  std::int64_t patience_ns_;
  std::int64_t now_ns_ = 0;
  std::uint64_t lost_ = 0;
};

}  // namespace tenon::sim

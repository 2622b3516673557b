#pragma once
// A CAN bus behind an slcan adapter: a serial device or pty, or a TCP connection (the virtual arm).
//
// What send() takes leaves at the next flush(), receive() or wait(), so that the frames of one
// cycle cost one system call. Sending never blocks: where the other end reads too slowly, frames
// are dropped and reported as kQueueFull; a closed connection is kDown and status().up = false, for
// good. One thread. Owns the descriptor.

#include <cstdint>

#include "hw/can/slcan_stream.h"
#include "shared/ports/can_bus.h"
#include "shared/system/descriptor.h"

namespace tenon::hw {

class SlcanClient : public CanBus {
 public:
  /// Opens the channel: C, S by bit rate, O. Throws InputError where slcan has no such bit rate.
  /// @param descriptor open and non-blocking, taken over (see hw/can/endpoints.h)
  SlcanClient(Descriptor descriptor, std::uint32_t bitrate_bps);
  ~SlcanClient() override;

  [[nodiscard]] SendResult send(const CanFrame& frame) noexcept override;
  [[nodiscard]] bool receive(ReceivedFrame& received) noexcept override;
  void flush() noexcept override { stream_.flush(); }
  void wait(std::int64_t at_most_ns) noexcept override;
  [[nodiscard]] CanBusStatus status() const noexcept override;
  [[nodiscard]] int descriptor() const noexcept override { return stream_.descriptor(); }

 private:
  SlcanStream stream_;
  CanBusStatus status_;
  bool answered_ = false;  ///< C, which is refused where the channel was closed anyway
};

}  // namespace tenon::hw

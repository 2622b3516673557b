#pragma once
// A CAN interface of the Linux kernel (PF_CAN, raw socket), non-blocking. Its bit rate and transmit
// queue are set from outside (hw/README.md) and checked here. Error frames are subscribed to and
// show in status(): bus-off, error-passive, overruns. Own frames do not come back; other programs
// on this machine (candump) see them. Frames carry the kernel's receive time.
//
// A full transmit queue (ENOBUFS) is kQueueFull. An interface that is down is kDown and not up in
// status(), until it is up again, which also ends bus-off; one that was removed stays down. Frames
// that the kernel dropped because nobody read them (SO_RXQ_OVFL) are overruns, counted when the
// next one comes.
//
// One thread. Owns its socket. send, receive, flush, wait neither allocate nor throw.

#include <cstdint>
#include <string>

#include "shared/ports/can_bus.h"
#include "shared/system/descriptor.h"

namespace tenon::hw {

class SocketcanBus : public CanBus {
 public:
  /// Throws InputError naming the interface and what to do.
  /// @param bitrate_bps checked, where the interface has one
  /// @param burst_frames sent at once in a cycle; the transmit queue must hold them
  SocketcanBus(const std::string& interface, std::uint32_t bitrate_bps, std::uint32_t burst_frames);

  [[nodiscard]] SendResult send(const CanFrame& frame) noexcept override;
  [[nodiscard]] bool receive(ReceivedFrame& received) noexcept override;
  void flush() noexcept override {}  // the kernel has it already
  void wait(std::int64_t at_most_ns) noexcept override;
  [[nodiscard]] CanBusStatus status() const noexcept override { return status_; }
  [[nodiscard]] int descriptor() const noexcept override { return socket_.get(); }

 private:
  void configure_socket();
  [[nodiscard]] bool interface_is_up() const noexcept;
  void take_up() noexcept;

  const std::string interface_;
  const Descriptor socket_;
  int index_ = 0;
  std::uint32_t kernel_drops_ = 0;  ///< as the kernel last counted them
  std::int64_t newest_ns_ = 0;      ///< receive time of the last frame
  CanBusStatus status_;
};

}  // namespace tenon::hw

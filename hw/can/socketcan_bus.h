#pragma once
// A CAN interface of the Linux kernel (PF_CAN, raw socket), non-blocking. Its bit rate and transmit
// queue are set from outside (hw/README.md). Error frames are subscribed to and show in status():
// bus-off, error-passive, overruns. Frames carry the kernel's receive time. Own frames do not come
// back; other programs on this machine (candump) see them.
//
// A full transmit queue (ENOBUFS) is kQueueFull; an interface that is down is kDown until it is up
// again. One thread. Owns its socket. send, receive, wait neither allocate nor throw.

#include <cstdint>
#include <string>

#include "shared/ports/can_bus.h"

namespace tenon::hw {

class SocketcanBus : public CanBus {
 public:
  /// Throws InputError naming the interface and what to do.
  explicit SocketcanBus(const std::string& interface);
  ~SocketcanBus() override;

  [[nodiscard]] SendResult send(const CanFrame& frame) noexcept override;
  [[nodiscard]] bool receive(ReceivedFrame& received) noexcept override;
  void wait(std::int64_t at_most_ns) noexcept override;
  [[nodiscard]] CanBusStatus status() const noexcept override { return status_; }

 private:
  int socket_ = -1;
  std::uint32_t kernel_drops_ = 0;  ///< as the kernel last counted them
  CanBusStatus status_;
};

}  // namespace tenon::hw

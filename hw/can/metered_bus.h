#pragma once
// A bus that counts the bits of what passes, and shows that and the transport's own counters to one
// other thread: as they stood when the loop last flushed or waited. Real-time but for traffic();
// one thread, and any for traffic(). Owns no bus. Of several (CanFrame::bus) the bits are the
// first's: each has a rate of its own.
//
// Each number is read by itself, in no order with the others: they are shown, and nothing is
// concluded from two.

#include <atomic>
#include <cstdint>

#include "shared/ports/can_bus.h"

namespace tenon::hw {

class MeteredBus : public CanBus {
 public:
  explicit MeteredBus(CanBus& bus) : bus_(bus) { publish(); }

  [[nodiscard]] SendResult send(const CanFrame& frame) noexcept override;
  [[nodiscard]] bool receive(ReceivedFrame& received) noexcept override;
  void flush() noexcept override;
  void wait(std::int64_t at_most_ns) noexcept override;
  [[nodiscard]] CanBusStatus status() const noexcept override { return bus_.status(); }
  [[nodiscard]] int descriptor() const noexcept override { return bus_.descriptor(); }

  /// Any thread.
  [[nodiscard]] CanBusTraffic traffic() const noexcept;

 private:
  using Counter = std::atomic<std::uint64_t>;

  void count(const CanFrame& frame) noexcept;
  void publish() noexcept;

  CanBus& bus_;
  std::uint64_t nominal_bits_ = 0;
  std::uint64_t worst_bits_ = 0;

  // What the other thread reads. Relaxed: each stands for itself.
  Counter shown_nominal_bits_{0};
  Counter shown_worst_bits_{0};
  Counter sent_{0};
  Counter received_{0};
  Counter send_failures_{0};
  Counter malformed_{0};
  Counter error_frames_{0};
  Counter overruns_{0};
  std::atomic<bool> up_{true};
  std::atomic<bool> bus_off_{false};
  std::atomic<bool> error_passive_{false};
};

}  // namespace tenon::hw

#pragma once
// A bus that copies every frame that passes into a ring, for a log that another thread writes
// (hw/can/candump_log.h). Sent frames are recorded where the bus took them. A full ring loses
// frames of the log, never of the bus; it counts them. Real-time; one thread; owns neither bus nor
// ring.

#include <cstdint>

#include "shared/base/spsc_ring.h"
#include "shared/ports/can_bus.h"
#include "shared/system/monotonic_clock.h"

namespace tenon::hw {

/// Some seconds of a busy bus.
using CanRecordRing = SpscRing<ReceivedFrame, 32768>;  // a MB: give it static or heap storage

class RecordingBus : public CanBus {
 public:
  using Clock = std::int64_t (*)() noexcept;

  /// @param clock stamps what is sent
  RecordingBus(CanBus& bus, CanRecordRing& ring, Clock clock = &monotonic_now_ns)
      : bus_(bus), ring_(ring), clock_(clock) {}

  [[nodiscard]] SendResult send(const CanFrame& frame) noexcept override {
    const SendResult result = bus_.send(frame);
    if (result == SendResult::kSent) {
      ring_.push({frame, clock_()});
    }
    return result;
  }
  [[nodiscard]] bool receive(ReceivedFrame& received) noexcept override {
    const bool there = bus_.receive(received);
    if (there) {
      ring_.push(received);
    }
    return there;
  }
  void flush() noexcept override { bus_.flush(); }
  void wait(std::int64_t at_most_ns) noexcept override { bus_.wait(at_most_ns); }
  [[nodiscard]] CanBusStatus status() const noexcept override { return bus_.status(); }
  [[nodiscard]] int descriptor() const noexcept override { return bus_.descriptor(); }

 private:
  CanBus& bus_;
  CanRecordRing& ring_;
  Clock clock_;
};

}  // namespace tenon::hw

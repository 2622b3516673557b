#include "hw/can/metered_bus.h"

#include "shared/ports/frame_bits.h"

namespace tenon::hw {
namespace {

constexpr auto kRelaxed = std::memory_order_relaxed;

}  // namespace

SendResult MeteredBus::send(const CanFrame& frame) noexcept {
  const SendResult result = bus_.send(frame);
  if (result == SendResult::kSent) count(frame);
  return result;
}

bool MeteredBus::receive(ReceivedFrame& received) noexcept {
  const bool there = bus_.receive(received);
  if (there) count(received.frame);
  return there;
}

void MeteredBus::flush() noexcept {
  bus_.flush();
  publish();
}

void MeteredBus::wait(std::int64_t at_most_ns) noexcept {
  bus_.wait(at_most_ns);
  publish();
}

void MeteredBus::count(const CanFrame& frame) noexcept {
  if (frame.bus != 0) return;
  nominal_bits_ += nominal_frame_bits(frame);
  worst_bits_ += worst_frame_bits(frame);
}

void MeteredBus::publish() noexcept {
  const CanBusStatus status = bus_.status();
  shown_nominal_bits_.store(nominal_bits_, kRelaxed);
  shown_worst_bits_.store(worst_bits_, kRelaxed);
  sent_.store(status.sent, kRelaxed);
  received_.store(status.received, kRelaxed);
  send_failures_.store(status.send_failures, kRelaxed);
  malformed_.store(status.malformed, kRelaxed);
  error_frames_.store(status.error_frames, kRelaxed);
  overruns_.store(status.overruns, kRelaxed);
  up_.store(status.up, kRelaxed);
  bus_off_.store(status.bus_off, kRelaxed);
  error_passive_.store(status.error_passive, kRelaxed);
}

CanBusTraffic MeteredBus::traffic() const noexcept {
  CanBusTraffic traffic;
  traffic.nominal_bits = shown_nominal_bits_.load(kRelaxed);
  traffic.worst_bits = shown_worst_bits_.load(kRelaxed);
  traffic.status.sent = sent_.load(kRelaxed);
  traffic.status.received = received_.load(kRelaxed);
  traffic.status.send_failures = send_failures_.load(kRelaxed);
  traffic.status.malformed = malformed_.load(kRelaxed);
  traffic.status.error_frames = error_frames_.load(kRelaxed);
  traffic.status.overruns = overruns_.load(kRelaxed);
  traffic.status.up = up_.load(kRelaxed);
  traffic.status.bus_off = bus_off_.load(kRelaxed);
  traffic.status.error_passive = error_passive_.load(kRelaxed);
  return traffic;
}

}  // namespace tenon::hw

#include "shared/bus/bus_pair.h"

namespace tenon {

SendResult BusPair::send(const CanFrame& frame) noexcept {
  CanBus& bus = *buses_[frame.bus < kBuses ? frame.bus : 0];
  return bus.send(frame);
}

bool BusPair::fetch() noexcept {
  bool any = false;
  for (std::size_t i = 0; i < kBuses; ++i) {
    ReceivedFrame received;
    if (!next_[i] && buses_[i]->receive(received)) {
      received.frame.bus = static_cast<std::uint8_t>(i);
      next_[i] = received;
    }
    any = any || next_[i].has_value();
  }
  return any;
}

bool BusPair::receive(ReceivedFrame& received) noexcept {
  if (!fetch()) return false;
  const bool second = !next_[0] || (next_[1] && next_[1]->time_ns < next_[0]->time_ns);
  std::optional<ReceivedFrame>& next = next_[second ? 1 : 0];
  received = *next;
  next.reset();
  return true;
}

void BusPair::flush() noexcept {
  for (CanBus* bus : buses_) bus->flush();
}

void BusPair::wait(std::int64_t /*at_most_ns*/) noexcept { flush(); }

CanBusStatus BusPair::status() const noexcept {
  CanBusStatus all;
  for (std::size_t i = 0; i < kBuses; ++i) {
    const CanBusStatus one = buses_[i]->status();
    // A bus-off says why its bus is down: it goes first, on whichever bus it is.
    const bool worse = one.bus_off ? !all.bus_off : !one.up && all.up && !all.bus_off;
    if (worse) all.failed_bus = static_cast<std::uint8_t>(i);
    all.up = all.up && one.up;
    all.bus_off = all.bus_off || one.bus_off;
    all.error_passive = all.error_passive || one.error_passive;
    all.sent += one.sent;
    all.received += one.received;
    all.send_failures += one.send_failures;
    all.malformed += one.malformed;
    all.error_frames += one.error_frames;
    all.overruns += one.overruns;
  }
  return all;
}

}  // namespace tenon

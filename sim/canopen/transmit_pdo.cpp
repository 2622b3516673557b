#include "sim/canopen/transmit_pdo.h"

#include <algorithm>

namespace tenon::sim {

void TransmitPdo::on_sync(std::int64_t now_ns, std::vector<CanFrame>& outbox) {
  if (!parameters_.valid() || !parameters_.synchronous()) return;
  const std::uint8_t every = parameters_.transmission_type();
  const CanFrame frame = sample();
  if (every == 0) {
    if (frame != last_) send(frame, now_ns, outbox);
    return;
  }
  if (++syncs_ < every) return;
  syncs_ = 0;
  send(frame, now_ns, outbox);
}

void TransmitPdo::advance(std::int64_t now_ns, std::vector<CanFrame>& outbox) {
  if (!parameters_.valid() || parameters_.synchronous()) return;
  const std::int64_t timer_ns = parameters_.event_timer_ns();
  const bool due = last_ && timer_ns > 0 && now_ns - last_ns_ >= timer_ns;
  const bool inhibited = last_ && now_ns - last_ns_ < parameters_.inhibit_ns();
  const CanFrame frame = sample();
  if (due || (frame != last_ && !inhibited)) send(frame, now_ns, outbox);
}

void TransmitPdo::reset() {
  syncs_ = 0;
  last_.reset();
}

CanFrame TransmitPdo::sample() const {
  CanFrame frame;
  frame.id = parameters_.cob_id();
  for (std::size_t i = 0; i < parameters_.mapped_count(); ++i) {
    const std::vector<std::uint8_t> bytes = to_bytes(*parameters_.mapped(i));
    std::copy(bytes.begin(), bytes.end(), frame.data.begin() + frame.length);
    frame.length = static_cast<std::uint8_t>(frame.length + bytes.size());
  }
  return frame;
}

void TransmitPdo::send(const CanFrame& frame, std::int64_t now_ns, std::vector<CanFrame>& outbox) {
  outbox.push_back(frame);
  last_ = frame;
  last_ns_ = now_ns;
}

}  // namespace tenon::sim

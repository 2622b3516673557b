#include "sim/cell/canopen/transmit_pdo.h"

namespace tenon::sim {

void TransmitPdo::on_sync(std::uint8_t counter, std::int64_t now_ns,
                          std::vector<CanFrame>& outbox) {
  if (!parameters_.valid() || !parameters_.synchronous()) return;
  const std::uint8_t start = parameters_.sync_start();
  started_ = started_ || counter == 0 || start == 0 || counter == start;
  if (!started_) return;
  const std::uint8_t every = parameters_.transmission_type();
  const CanFrame frame = repeat_ && last_ ? *last_ : sample();
  if (every == 0) {
    if (frame != last_) send(frame, now_ns, outbox);
    return;
  }
  if (++syncs_ < every) return;
  syncs_ = 0;
  repeat_ = false;
  send(frame, now_ns, outbox);
}

void TransmitPdo::on_remote(std::uint32_t id, std::int64_t now_ns, std::vector<CanFrame>& outbox) {
  if (!parameters_.valid() || !parameters_.remote_allowed() || id != parameters_.cob_id()) return;
  send(sample(), now_ns, outbox);
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
  started_ = repeat_ = false;
  last_.reset();
}

CanFrame TransmitPdo::sample() const {
  CanFrame frame;
  frame.id = parameters_.cob_id();
  for (std::size_t i = 0; i < parameters_.mapped_count(); ++i) {
    const auto value = static_cast<std::uint64_t>(parameters_.mapped(i)->value);
    for (std::size_t byte = 0; byte < parameters_.bytes(i); ++byte) {
      frame.data[frame.length++] = static_cast<std::uint8_t>(value >> (8 * byte));
    }
  }
  return frame;
}

void TransmitPdo::send(const CanFrame& frame, std::int64_t now_ns, std::vector<CanFrame>& outbox) {
  outbox.push_back(frame);
  last_ = frame;
  last_ns_ = now_ns;
}

}  // namespace tenon::sim

#include "sim/cell/canopen/receive_pdo.h"

namespace tenon::sim {

ReceivePdo::Result ReceivePdo::receive(const CanFrame& frame, std::int64_t now_ns) {
  if (!parameters_.valid() || frame.id != parameters_.cob_id()) return Result::kNotMine;
  too_short_ = frame.length < parameters_.total_bytes();
  if (too_short_) return Result::kTooShort;
  seen_ns_ = now_ns;
  overdue_ = false;
  if (parameters_.synchronous()) {
    waiting_ = frame;
  } else {
    act(frame);
  }
  return Result::kTaken;
}

void ReceivePdo::advance(std::int64_t now_ns) {
  const std::int64_t deadline_ns = parameters_.event_timer_ns();
  overdue_ = parameters_.valid() && deadline_ns > 0 && seen_ns_ && now_ns - *seen_ns_ > deadline_ns;
}

void ReceivePdo::reset() {
  waiting_.reset();
  seen_ns_.reset();
  too_short_ = overdue_ = false;
}

void ReceivePdo::on_sync() {
  if (!waiting_) return;
  act(*waiting_);
  waiting_.reset();
}

void ReceivePdo::act(const CanFrame& frame) {
  std::size_t at = 0;
  for (std::size_t i = 0; i < parameters_.mapped_count(); ++i) {
    if (const ObjectEntry* entry = parameters_.mapped(i); entry != nullptr) {
      // A value that the object refuses is dropped, as by a drive.
      static_cast<void>(
          dictionary_.write(parameters_.mapped_id(i), from_bytes(entry->type, &frame.data[at])));
    }
    at += parameters_.bytes(i);
  }
}

}  // namespace tenon::sim

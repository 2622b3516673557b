#include "sim/cell/faults/faulty_bus.h"

namespace tenon::sim {

FaultyBus::FaultyBus(CanBus& bus, std::span<const Fault> faults, std::uint8_t master_node,
                     std::int64_t now_ns, const FaultPhases* phases)
    : bus_(bus),
      faults_(faults, master_node, now_ns, phases),
      master_node_(master_node),
      now_ns_(now_ns) {}

void FaultyBus::advance(std::int64_t now_ns) {
  now_ns_ = now_ns;
  std::erase_if(delayed_, [this](const Delayed& delayed) {
    if (delayed.due_ns > now_ns_) return false;
    if (!delayed.outgoing) {
      arrived_.push_back({delayed.frame, delayed.due_ns});
    } else if (!faults_.down(now_ns_) && !master_gone()) {
      (void)bus_.send(delayed.frame);
    }
    return true;
  });
}

SendResult FaultyBus::send(const CanFrame& frame) noexcept {
  if (faults_.down(now_ns_)) return SendResult::kDown;
  const SendResult answer = faults_.admit(frame, now_ns_);
  if (answer != SendResult::kSent) return answer;
  CanFrame sent = frame;
  const Disturbance::Fate fate = faults_.fate(sent, kOurs, now_ns_);
  if (fate.lost || master_gone()) return SendResult::kSent;
  if (fate.repeated) (void)bus_.send(sent);
  if (fate.delay_ns == 0) return bus_.send(sent);
  delayed_.push_back({sent, now_ns_ + fate.delay_ns, true});
  return SendResult::kSent;
}

bool FaultyBus::receive(ReceivedFrame& received) noexcept {
  while (arrived_.empty() && bus_.receive(received)) arrive(received);
  if (arrived_.empty()) return false;
  received = arrived_.front();
  arrived_.pop_front();
  return true;
}

/// A frame from the wire, to what becomes of it.
void FaultyBus::arrive(const ReceivedFrame& received) {
  if (faults_.down(now_ns_)) return;
  // Whatever keeps the master from sending is known here only once the frame has come.
  if (faults_.admit(received.frame, now_ns_) != SendResult::kSent) return;
  ReceivedFrame passed = received;
  const Disturbance::Fate fate = faults_.fate(passed.frame, kMaster, now_ns_);
  if (fate.lost) return;
  if (fate.repeated) arrived_.push_back(passed);
  if (fate.delay_ns == 0) {
    arrived_.push_back(passed);
  } else {
    delayed_.push_back({passed.frame, now_ns_ + fate.delay_ns, false});
  }
}

CanBusStatus FaultyBus::status() const noexcept {
  CanBusStatus status = bus_.status();
  status.up = status.up && !faults_.down(now_ns_);
  return status;
}

}  // namespace tenon::sim

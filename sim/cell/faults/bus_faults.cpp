#include "sim/cell/faults/bus_faults.h"

#include <algorithm>

#include "shared/base/time_units.h"

namespace tenon::sim {
namespace {

std::int64_t nanoseconds(double time_s) {
  return static_cast<std::int64_t>(time_s * kNanosecondsPerSecond);
}

}  // namespace

BusFaults::BusFaults(std::span<const Fault> faults, std::uint8_t master_node, std::int64_t on_ns,
                     const FaultPhases* phases)
    : sender_(master_node), on_ns_(on_ns), phases_(phases) {
  for (const Fault& fault : faults) {
    if (is_bus_fault(fault.kind)) active_.push_back({fault, Random(fault.seed)});
  }
}

SendResult BusFaults::admit(const CanFrame& frame, std::int64_t now_ns) noexcept {
  const std::uint8_t node = sender_.node_of(frame);
  SendResult answer = SendResult::kSent;
  for (Active& active : active_) {
    if (active.fault.kind == FaultKind::kQueueFull && strikes(active, frame, now_ns)) {
      answer = SendResult::kQueueFull;
    }
  }
  return bus_off(node, now_ns) ? SendResult::kDown : answer;
}

Disturbance::Fate BusFaults::fate(CanFrame& frame, std::size_t /*end*/,
                                  std::int64_t now_ns) noexcept {
  sender_.overhear(frame);
  Fate fate;
  for (Active& active : active_) {
    // Without a duration it strikes a single frame; the other kinds are states and last.
    if (!strikes_frames(active.fault.kind) || !strikes(active, frame, now_ns)) continue;
    active.spent = active.fault.duration_s <= 0.0;
    fate.lost = fate.lost || active.fault.kind == FaultKind::kDrop;
    fate.repeated = fate.repeated || active.fault.kind == FaultKind::kDuplicate;
    if (active.fault.kind == FaultKind::kDelay) fate.delay_ns += nanoseconds(active.fault.value);
    if (active.fault.kind == FaultKind::kCorruptLength && frame.length > 0) --frame.length;
  }
  return fate;
}

bool BusFaults::down(std::int64_t now_ns) const noexcept {
  return std::any_of(active_.begin(), active_.end(), [&](const Active& active) {
    return active.fault.kind == FaultKind::kInterfaceDown && lasts(active, now_ns);
  });
}

bool BusFaults::bus_off(std::uint8_t node, std::int64_t now_ns) const noexcept {
  return std::any_of(active_.begin(), active_.end(), [&](const Active& active) {
    return active.fault.kind == FaultKind::kBusOff && lasts(active, now_ns) &&
           (active.fault.node == 0 || active.fault.node == node);
  });
}

bool BusFaults::lasts(const Active& active, std::int64_t now_ns) const {
  const auto began_ns = begin_ns(active.fault, on_ns_, phases_);
  if (active.spent || !began_ns || now_ns < *began_ns) return false;
  const std::int64_t duration_ns = nanoseconds(active.fault.duration_s);
  return duration_ns <= 0 || now_ns < *began_ns + duration_ns;
}

bool BusFaults::means(const Fault& fault, const CanFrame& frame) const {
  if (fault.frames == FrameKind::kOne && frame.id != fault.cob_id) return false;
  const FrameKind kind = sender_.kind_of(frame);
  const bool all_kinds = fault.frames == FrameKind::kAny || fault.frames == FrameKind::kOne;
  if (!all_kinds && fault.frames != kind) return false;
  if (fault.node == 0 || fault.node == sender_.node_of(frame)) return true;
  return fault.frames == FrameKind::kSetpoints && sender_.is_for(frame, fault.node);
}

bool BusFaults::strikes(Active& active, const CanFrame& frame, std::int64_t now_ns) {
  if (!lasts(active, now_ns) || !means(active.fault, frame)) return false;
  const bool struck = active.source.uniform() < active.fault.probability;
  struck_ += struck ? 1 : 0;
  return struck;
}

std::vector<Fault> faults_of_devices(std::span<const Fault> faults, std::uint8_t master_node) {
  std::vector<Fault> of_devices;
  for (Fault fault : faults) {
    if (fault.kind == FaultKind::kBusOff && fault.node != 0 && fault.node != master_node) {
      fault.kind = FaultKind::kSilentNode;
    }
    if (!is_bus_fault(fault.kind)) of_devices.push_back(fault);
  }
  return of_devices;
}

}  // namespace tenon::sim

#include "sim/cell/faults/bus_faults.h"

#include <algorithm>
#include <limits>

#include "shared/base/time_units.h"

namespace tenon::sim {
namespace {

std::int64_t nanoseconds(double time_s) {
  return static_cast<std::int64_t>(time_s * kNanosecondsPerSecond);
}

/// Strikes a single frame where it has no duration; the other kinds are states and last.
bool strikes_once(FaultKind kind) {
  return kind == FaultKind::kDrop || kind == FaultKind::kDelay || kind == FaultKind::kDuplicate ||
         kind == FaultKind::kCorruptLength;
}

}  // namespace

BusFaults::BusFaults(std::span<const Fault> faults, std::uint8_t master_node, std::int64_t on_ns)
    : sender_(master_node) {
  for (const Fault& fault : faults) {
    if (!is_bus_fault(fault.kind)) continue;
    Active active{fault, on_ns + nanoseconds(fault.time_s), 0, Random(fault.seed), false};
    active.end_ns = fault.duration_s > 0.0 ? active.begin_ns + nanoseconds(fault.duration_s)
                                           : std::numeric_limits<std::int64_t>::max();
    active_.push_back(active);
  }
}

SendResult BusFaults::admit(const CanFrame& frame, std::int64_t now_ns) noexcept {
  const std::uint8_t node = sender_.node_of(frame);
  SendResult answer = SendResult::kSent;
  for (Active& active : active_) {
    if (active.fault.kind == FaultKind::kQueueFull && strikes(active, node, now_ns)) {
      answer = SendResult::kQueueFull;
    }
  }
  return bus_off(node, now_ns) ? SendResult::kDown : answer;
}

Disturbance::Fate BusFaults::fate(CanFrame& frame, std::size_t /*end*/,
                                  std::int64_t now_ns) noexcept {
  sender_.overhear(frame);
  const std::uint8_t node = sender_.node_of(frame);
  Fate fate;
  for (Active& active : active_) {
    if (!strikes_once(active.fault.kind) || !strikes(active, node, now_ns)) continue;
    active.spent = active.fault.duration_s <= 0.0;
    fate.lost = fate.lost || active.fault.kind == FaultKind::kDrop;
    fate.repeated = fate.repeated || active.fault.kind == FaultKind::kDuplicate;
    if (active.fault.kind == FaultKind::kDelay) fate.delay_ns += nanoseconds(active.fault.value);
    if (active.fault.kind == FaultKind::kCorruptLength && frame.length > 0) --frame.length;
  }
  return fate;
}

bool BusFaults::down(std::int64_t now_ns) const noexcept {
  return std::any_of(active_.begin(), active_.end(), [now_ns](const Active& active) {
    return active.fault.kind == FaultKind::kInterfaceDown && lasts(active, now_ns);
  });
}

bool BusFaults::bus_off(std::uint8_t node, std::int64_t now_ns) const noexcept {
  return std::any_of(active_.begin(), active_.end(), [node, now_ns](const Active& active) {
    return active.fault.kind == FaultKind::kBusOff && lasts(active, now_ns) &&
           (active.fault.node == 0 || active.fault.node == node);
  });
}

bool BusFaults::lasts(const Active& active, std::int64_t now_ns) {
  return now_ns >= active.begin_ns && now_ns < active.end_ns && !active.spent;
}

bool BusFaults::strikes(Active& active, std::uint8_t node, std::int64_t now_ns) {
  if (!lasts(active, now_ns) || (active.fault.node != 0 && active.fault.node != node)) return false;
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

#include "sim/cell/lockstep/foreign_link.h"

#include <algorithm>

namespace tenon::sim {
namespace {

constexpr int kWaits = 10;

}  // namespace

ForeignLink::ForeignLink(CanBus& master, CanBus& devices, std::int64_t patience_ns)
    : master_(master, devices_), devices_(devices, master_), patience_ns_(patience_ns) {}

std::int64_t ForeignLink::advance(std::int64_t until_ns) {
  for (int waits = 0; waits <= kWaits; ++waits) {
    const bool at_master = master_.take(now_ns_);
    const bool at_devices = devices_.take(now_ns_);
    if (at_master || at_devices) return now_ns_;
    if (master_.expected + devices_.expected == 0) break;
    Side& missing = master_.expected > 0 ? master_ : devices_;
    missing.end.wait(patience_ns_ / kWaits);
  }
  lost_ += master_.expected + devices_.expected;
  master_.expected = devices_.expected = 0;
  now_ns_ = until_ns;
  return now_ns_;
}

SendResult ForeignLink::Side::send(const CanFrame& frame) noexcept {
  const SendResult result = end.send(frame);
  if (result == SendResult::kSent) ++other.expected;
  return result;
}

bool ForeignLink::Side::receive(ReceivedFrame& received) noexcept {
  if (arrived.empty()) return false;
  received = arrived.front();
  arrived.pop_front();
  return true;
}

bool ForeignLink::Side::take(std::int64_t now_ns) {
  end.flush();
  const std::size_t before = arrived.size();
  for (ReceivedFrame received; end.receive(received);) {
    arrived.push_back({received.frame, now_ns});
    expected -= std::min<std::uint64_t>(expected, 1);  // others may send, too
  }
  return arrived.size() > before;
}

}  // namespace tenon::sim

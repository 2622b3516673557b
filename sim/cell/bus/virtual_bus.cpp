#include "sim/cell/bus/virtual_bus.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <span>

#include "sim/cell/bus/bus_end.h"

namespace tenon::sim {
namespace {

constexpr std::uint32_t kAfterAckSlotBits = 8;  // ACK delimiter, end of frame
constexpr std::uint32_t kErrorFrameBits = 6 + 8;
constexpr std::uint32_t kPauseBits = 8;
constexpr std::uint32_t kRecessiveBits = 11;
constexpr std::uint32_t kRecoveries = 128;

}  // namespace

VirtualBus::VirtualBus(const Parameters& parameters)
    : parameters_(parameters), noise_(stream_seed(parameters.seed, "bit_errors")) {}

VirtualBus::~VirtualBus() = default;

CanBus& VirtualBus::attach(const EndParameters& parameters) {
  assert(parameters.transmit_frames > 0 && parameters.receive_frames > 0);
  ends_.push_back(std::make_unique<End>(*this, ends_.size(), parameters));
  return *ends_.back();
}

// --- time ----------------------------------------------------------------------------------------

void VirtualBus::advance(std::int64_t until_ns) {
  assert(until_ns >= now_ns_);
  if (parameters_.bitrate_bps == 0) {
    deliver_at_once();
  }
  while (true) {
    if (!on_wire_) {
      // Who sends at the very instant takes part in the arbitration, so it is over only later.
      const auto next = plan();
      if (next && next->start_ns < until_ns) begin(*next);
    }
    if (!on_wire_ || on_wire_->end_ns > until_ns) break;
    const Attempt attempt = *on_wire_;
    on_wire_.reset();
    now_ns_ = attempt.end_ns;
    idle_ns_ = attempt.idle_ns;
    statistics_.busy_ns += attempt.idle_ns - attempt.start_ns;
    attempt.ending == Ending::kAcknowledged ? finish(attempt) : fail(attempt);
  }
  now_ns_ = until_ns;
  deliver_delayed();
  update_states();
}

std::int64_t VirtualBus::next_event_ns() const {
  std::int64_t next_ns = kNever_ns;
  if (on_wire_) {
    next_ns = on_wire_->end_ns;
  } else if (const auto next = plan()) {
    next_ns = next->end_ns;
  }
  for (const Delayed& delayed : delayed_) next_ns = std::min(next_ns, delayed.received.time_ns);
  return next_ns;
}

/// The arbitration as the queues stand. Where it starts at once, more may still join.
std::optional<VirtualBus::Attempt> VirtualBus::plan() const {
  if (parameters_.bitrate_bps == 0) return std::nullopt;
  std::optional<Attempt> best;
  std::uint64_t lowest = 0;
  for (const auto& end : ends_) {
    if (end->empty() || end->is_bus_off()) continue;
    const std::int64_t start_ns = std::max({now_ns_, idle_ns_, end->paused_until_ns});
    const std::size_t place = end->next();
    const std::uint64_t arbitration = end->at(place).arbitration;
    if (best &&
        (start_ns > best->start_ns || (start_ns == best->start_ns && arbitration >= lowest))) {
      continue;
    }
    best = Attempt{};
    best->end = end->index();
    best->place = place;
    best->start_ns = start_ns;
    lowest = arbitration;
  }
  if (best) {
    best->end_ns = best->start_ns + duration_ns(ends_[best->end]->at(best->place).bits);
    best->idle_ns = best->end_ns + bits_ns(kIntermissionBits);
  }
  return best;
}

void VirtualBus::begin(Attempt attempt) {
  const FrameBits& bits = ends_[attempt.end]->at(attempt.place).bits;
  std::uint32_t bit = 0;
  if (destroyed_bit(bits, bit)) {
    attempt.ending = Ending::kDestroyed;
    const std::uint32_t sent = bit + 1;
    const std::uint32_t arbitration = std::min(sent, bits.nominal - kTailBits);
    const std::uint32_t data = std::min(sent - arbitration, bits.data);
    attempt.end_ns = attempt.start_ns + duration_ns({sent - data, data});
  } else if (!acknowledged(attempt.end)) {
    attempt.ending = Ending::kNotAcknowledged;
    attempt.end_ns -= bits_ns(kAfterAckSlotBits);
  }
  if (attempt.ending != Ending::kAcknowledged) {
    attempt.idle_ns = attempt.end_ns + bits_ns(kErrorFrameBits + kIntermissionBits);
  }
  on_wire_ = attempt;
}

void VirtualBus::finish(const Attempt& attempt) {
  End& sender = *ends_[attempt.end];
  End::Pending& place = sender.at(attempt.place);
  const End::Pending pending = place;
  Disturbance::Fate fate;
  CanFrame frame = pending.frame;
  if (disturbance_ != nullptr && !pending.settled) {
    fate = disturbance_->fate(frame, attempt.end, attempt.end_ns);
  }
  if (fate.repeated) {
    place.frame = frame;
    place.settled = true;
  } else {
    sender.erase(attempt.place);
  }

  ++statistics_.frames;
  sender.sent_well();
  if (sender.is_error_passive()) sender.paused_until_ns = attempt.idle_ns + bits_ns(kPauseBits);
  for (const auto& end : ends_) {
    if (end->index() != attempt.end && !end->is_bus_off()) end->received_well();
    // A frame ends in eleven recessive bits, whatever it was before.
    if (end->recovered_ns != kNever_ns) {
      end->recovered_ns += attempt.idle_ns - attempt.start_ns - bits_ns(kRecessiveBits);
    }
  }
  if (observer_) {
    observer_({pending.frame, attempt.end, pending.queued_ns, attempt.start_ns, attempt.end_ns,
               pending.bits});
  }
  if (fate.lost) return;
  if (fate.delay_ns > 0) {
    delayed_.push_back({{frame, attempt.end_ns + fate.delay_ns}, attempt.end});
  } else {
    deliver(frame, attempt.end, attempt.end_ns);
  }
}

/// An error frame; the frame stays where it is.
void VirtualBus::fail(const Attempt& attempt) {
  ++statistics_.error_frames;
  End& sender = *ends_[attempt.end];
  if (attempt.ending == Ending::kDestroyed) {
    for (const auto& end : ends_) {
      if (end->index() != attempt.end && !end->is_bus_off()) end->received_badly();
    }
  }
  // Alone on the bus, a sender becomes error passive and not bus-off (12.1.4.2 c, exception 1).
  if (attempt.ending == Ending::kDestroyed || !sender.is_error_passive()) sender.sent_badly();
  if (sender.is_error_passive()) sender.paused_until_ns = attempt.idle_ns + bits_ns(kPauseBits);
  if (sender.is_bus_off()) sender.clear();
}

// --- frames --------------------------------------------------------------------------------------

SendResult VirtualBus::send(const CanFrame& frame, End& end) noexcept {
  if (!up_ || end.is_bus_off()) return SendResult::kDown;
  if (disturbance_ != nullptr) {
    const SendResult answer = disturbance_->admit(frame, now_ns_);
    if (answer != SendResult::kSent) return answer;
  }
  if (end.full()) return SendResult::kQueueFull;
  end.push({frame, arbitration_of(frame), bits_of(frame), now_ns_, false});
  if (parameters_.bitrate_bps == 0) deliver_at_once();
  return SendResult::kSent;
}

void VirtualBus::deliver(const CanFrame& frame, std::size_t from, std::int64_t time_ns) {
  for (const auto& end : ends_) {
    if (end->index() != from && !end->is_bus_off()) end->accept({frame, time_ns});
  }
}

void VirtualBus::deliver_delayed() {
  if (delayed_.empty()) return;
  const auto later = [this](const Delayed& delayed) { return delayed.received.time_ns > now_ns_; };
  std::stable_sort(delayed_.begin(), delayed_.end(), [](const Delayed& a, const Delayed& b) {
    return a.received.time_ns < b.received.time_ns;
  });
  const auto first_later = std::find_if(delayed_.begin(), delayed_.end(), later);
  for (auto due = delayed_.begin(); due != first_later; ++due) {
    deliver(due->received.frame, due->from, due->received.time_ns);
  }
  delayed_.erase(delayed_.begin(), first_later);
}

/// Without a bit rate: all that can go, in the order of the ends.
void VirtualBus::deliver_at_once() {
  for (const auto& end : ends_) {
    while (!end->empty() && acknowledged(end->index())) {
      finish({end->index(), end->next(), now_ns_, now_ns_, now_ns_, Ending::kAcknowledged});
    }
  }
}

bool VirtualBus::acknowledged(std::size_t from) const {
  return std::any_of(ends_.begin(), ends_.end(), [from](const std::unique_ptr<End>& end) {
    return end->index() != from && !end->is_bus_off();
  });
}

// --- states --------------------------------------------------------------------------------------

void VirtualBus::set_up(bool up) {
  up_ = up;
  if (up) return;
  for (const auto& end : ends_) end->clear();
  on_wire_.reset();
  delayed_.clear();
}

void VirtualBus::set_bus_off(std::size_t end, bool bus_off) {
  ends_.at(end)->set_bus_off(bus_off);
  ends_[end]->recovered_ns = kNever_ns;
  if (!bus_off) return;
  ends_[end]->clear();
  if (on_wire_ && on_wire_->end == end) on_wire_.reset();
}

void VirtualBus::recover(std::size_t end) {
  if (ends_.at(end)->is_bus_off() && ends_[end]->recovered_ns == kNever_ns) {
    ends_[end]->recovered_ns = now_ns_ + bits_ns(kRecoveries * kRecessiveBits);
  }
}

void VirtualBus::update_states() {
  for (const auto& end : ends_) {
    if (now_ns_ >= end->recovered_ns) set_bus_off(end->index(), false);
  }
  if (disturbance_ == nullptr) return;
  const bool down = disturbance_->down(now_ns_);
  if (down != disturbed_) set_up(!down);
  disturbed_ = down;
  for (const auto& end : ends_) {
    const bool bus_off = disturbance_->bus_off(end->node(), now_ns_);
    if (bus_off != end->disturbed) set_bus_off(end->index(), bus_off);
    end->disturbed = bus_off;
  }
}

std::size_t VirtualBus::arrived(std::size_t end) const { return ends_.at(end)->arrived(); }

std::size_t VirtualBus::queued(std::size_t end) const { return ends_.at(end)->queued(); }

VirtualBus::ErrorCounters VirtualBus::error_counters(std::size_t end) const {
  return ends_.at(end)->counters();
}

// --- bits ----------------------------------------------------------------------------------------

/// Bits fail independently: how many go well before the first that does not, is one draw.
bool VirtualBus::destroyed_bit(const FrameBits& bits, std::uint32_t& bit) {
  if (parameters_.bit_error_rate <= 0.0) return false;
  const double well =
      std::floor(std::log(noise_.uniform()) / std::log1p(-parameters_.bit_error_rate));
  if (well >= static_cast<double>(bits.nominal + bits.data)) return false;
  bit = static_cast<std::uint32_t>(well);
  return true;
}

FrameBits VirtualBus::bits_of(const CanFrame& frame) const {
  if (parameters_.bitrate_bps == 0) return {};
  if (parameters_.data_bitrate_bps == 0 || frame.remote) return classic_frame_bits(frame);
  const std::size_t length = std::min<std::size_t>(frame.length, frame.data.size());
  return fd_frame_bits(frame.id, frame.extended, std::span(frame.data).first(length), true);
}

std::int64_t VirtualBus::duration_ns(const FrameBits& bits) const {
  const std::int64_t nominal_ns = bits_ns(bits.nominal);
  if (bits.data == 0) return nominal_ns;
  const std::int64_t rate = parameters_.data_bitrate_bps;
  return nominal_ns + (std::int64_t{bits.data} * 1'000'000'000 + rate - 1) / rate;
}

std::int64_t VirtualBus::bits_ns(std::uint32_t bits) const {
  const std::int64_t rate = parameters_.bitrate_bps;
  return rate == 0 ? 0 : (std::int64_t{bits} * 1'000'000'000 + rate - 1) / rate;
}

}  // namespace tenon::sim

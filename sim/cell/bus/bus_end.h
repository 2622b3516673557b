#pragma once
// One controller on a virtual bus: its queues, its error counters. Private to the bus, which is the
// only one to call it but for the port's functions.

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "shared/ports/can_bus.h"
#include "sim/cell/bus/frame_bits.h"
#include "sim/cell/bus/virtual_bus.h"

namespace tenon::sim {

/// The fields that arbitration compares, first bit highest: the lower number wins.
[[nodiscard]] constexpr std::uint64_t arbitration_of(const CanFrame& frame) {
  const std::uint64_t remote = frame.remote ? 1 : 0;
  if (!frame.extended) return std::uint64_t{frame.id & 0x7FFu} << 21 | remote << 20;
  const std::uint64_t recessive = 0b11;  // SRR, IDE
  return std::uint64_t{frame.id >> 18 & 0x7FFu} << 21 | recessive << 19 |
         std::uint64_t{frame.id & 0x3FFFFu} << 1 | remote;
}

class VirtualBus::End final : public CanBus {
 public:
  static constexpr std::uint32_t kErrorPassive = 128;
  static constexpr std::uint32_t kBusOff = 256;
  static constexpr std::uint32_t kErrorWeight = 8;  ///< of an error while sending

  struct Pending {
    CanFrame frame;
    std::uint64_t arbitration = 0;
    FrameBits bits;
    std::int64_t queued_ns = 0;
    bool settled = false;  ///< its fate has been asked for
  };

  End(VirtualBus& bus, std::size_t index, const EndParameters& parameters)
      : bus_(bus),
        index_(index),
        order_(parameters.order),
        node_(parameters.node),
        transmit_frames_(parameters.transmit_frames),
        arrived_(parameters.receive_frames) {
    queue_.reserve(transmit_frames_);
  }

  // The port.
  SendResult send(const CanFrame& frame) noexcept override {
    const SendResult result = bus_.send(frame, *this);
    ++(result == SendResult::kSent ? status_.sent : status_.send_failures);
    return result;
  }
  bool receive(ReceivedFrame& received) noexcept override {
    if (arrived_count_ == 0) return false;
    received = arrived_[arrived_first_];
    arrived_first_ = (arrived_first_ + 1) % arrived_.size();
    --arrived_count_;
    ++status_.received;
    return true;
  }
  void flush() noexcept override {}
  void wait(std::int64_t /*at_most_ns*/) noexcept override {}
  CanBusStatus status() const noexcept override {
    CanBusStatus status = status_;
    status.up = bus_.up_;
    status.bus_off = is_bus_off();
    status.error_passive = is_error_passive();
    return status;
  }

  // Sending.
  [[nodiscard]] bool full() const { return queue_.size() == transmit_frames_; }
  [[nodiscard]] bool empty() const { return queue_.empty(); }
  [[nodiscard]] std::size_t queued() const { return queue_.size(); }
  void push(const Pending& pending) { queue_.push_back(pending); }
  /// The place in the queue of the frame that goes next. Not of an empty queue.
  [[nodiscard]] std::size_t next() const {
    if (order_ == Order::kFifo) return 0;
    const auto first = std::min_element(
        queue_.begin(), queue_.end(),
        [](const Pending& a, const Pending& b) { return a.arbitration < b.arbitration; });
    return static_cast<std::size_t>(first - queue_.begin());
  }
  [[nodiscard]] Pending& at(std::size_t place) { return queue_[place]; }
  void erase(std::size_t place) {
    queue_.erase(queue_.begin() + static_cast<std::ptrdiff_t>(place));
  }
  void clear() { queue_.clear(); }

  // Receiving.
  [[nodiscard]] std::size_t arrived() const { return arrived_count_; }
  void accept(const ReceivedFrame& received) {
    if (arrived_count_ == arrived_.size()) {
      ++status_.overruns;
      return;
    }
    arrived_[(arrived_first_ + arrived_count_) % arrived_.size()] = received;
    ++arrived_count_;
  }

  // Error counters (ISO 11898-1:2015, 12.1.4).
  void sent_well() { transmit_errors_ -= transmit_errors_ > 0 && !is_bus_off() ? 1 : 0; }
  void received_well() {
    if (receive_errors_ >= kErrorPassive) {
      receive_errors_ = kErrorPassive - 1;
    } else if (receive_errors_ > 0) {
      --receive_errors_;
    }
  }
  void sent_badly() {
    transmit_errors_ += kErrorWeight;
    ++status_.error_frames;
  }
  void received_badly() {
    ++receive_errors_;
    ++status_.error_frames;
  }
  void set_bus_off(bool bus_off) {
    transmit_errors_ = bus_off ? kBusOff : 0;
    receive_errors_ = 0;
  }
  [[nodiscard]] bool is_bus_off() const { return transmit_errors_ >= kBusOff; }
  [[nodiscard]] bool is_error_passive() const {
    return transmit_errors_ >= kErrorPassive || receive_errors_ >= kErrorPassive;
  }
  [[nodiscard]] ErrorCounters counters() const { return {transmit_errors_, receive_errors_}; }

  [[nodiscard]] std::size_t index() const { return index_; }
  [[nodiscard]] std::uint8_t node() const { return node_; }

  std::int64_t paused_until_ns = 0;       ///< an error-passive sender lets the others go first
  std::int64_t recovered_ns = kNever_ns;  ///< when the recessive bits that it waits for have passed
  bool disturbed = false;                 ///< a disturbance has taken it off the bus

 private:
  VirtualBus& bus_;
  const std::size_t index_;
  const Order order_;
  const std::uint8_t node_;
  const std::size_t transmit_frames_;
  std::vector<Pending> queue_;
  std::vector<ReceivedFrame> arrived_;
  std::size_t arrived_first_ = 0;
  std::size_t arrived_count_ = 0;
  std::uint32_t transmit_errors_ = 0;
  std::uint32_t receive_errors_ = 0;
  CanBusStatus status_;
};

}  // namespace tenon::sim

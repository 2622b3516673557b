#include "hw/can/in_process_bus.h"

#include <cassert>

namespace tenon::hw {

class InProcessBus::End : public CanBus {
 public:
  End(InProcessBus& bus, std::size_t index, std::size_t queue_frames)
      : bus_(bus), index_(index), queue_(queue_frames) {}

  SendResult send(const CanFrame& frame) noexcept override {
    const SendResult result = bus_.deliver(frame, index_);
    ++(result == SendResult::kSent ? status_.sent : status_.send_failures);
    return result;
  }

  bool receive(ReceivedFrame& received) noexcept override {
    if (count_ == 0) {
      return false;
    }
    received = queue_[first_];
    first_ = (first_ + 1) % queue_.size();
    --count_;
    ++status_.received;
    return true;
  }

  void wait(std::int64_t /*at_most_ns*/) noexcept override {}

  CanBusStatus status() const noexcept override {
    CanBusStatus status = status_;
    status.up = bus_.up_;
    return status;
  }

  void accept(const ReceivedFrame& received) noexcept {
    if (status_.bus_off) {
      return;
    }
    if (count_ == queue_.size()) {
      ++status_.overruns;
      return;
    }
    queue_[(first_ + count_) % queue_.size()] = received;
    ++count_;
  }

  void set_bus_off(bool bus_off) noexcept { status_.bus_off = bus_off; }
  [[nodiscard]] bool bus_off() const noexcept { return status_.bus_off; }

 private:
  InProcessBus& bus_;
  const std::size_t index_;
  std::vector<ReceivedFrame> queue_;
  std::size_t first_ = 0;
  std::size_t count_ = 0;
  CanBusStatus status_;
};

InProcessBus::InProcessBus(std::size_t queue_frames) : queue_frames_(queue_frames) {
  assert(queue_frames > 0);
}

InProcessBus::~InProcessBus() = default;

CanBus& InProcessBus::attach() {
  ends_.push_back(std::make_unique<End>(*this, ends_.size(), queue_frames_));
  return *ends_.back();
}

void InProcessBus::set_bus_off(std::size_t end, bool bus_off) {
  ends_.at(end)->set_bus_off(bus_off);
}

SendResult InProcessBus::deliver(const CanFrame& frame, std::size_t from) noexcept {
  if (!up_ || ends_[from]->bus_off()) {
    return SendResult::kDown;
  }
  ReceivedFrame received{frame, now_ns_};
  if (filter_ && !filter_(received.frame, from)) {
    return SendResult::kSent;  // the sender cannot tell
  }
  for (std::size_t i = 0; i < ends_.size(); ++i) {
    if (i != from) {
      ends_[i]->accept(received);
    }
  }
  return SendResult::kSent;
}

}  // namespace tenon::hw

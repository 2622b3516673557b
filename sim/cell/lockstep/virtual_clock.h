#pragma once
// The clock of a lockstep, for a loop that runs by itself: waiting lets the cell and the bus go on.
// It wakes the loop late where it is told to. One thread.

#include <algorithm>
#include <cstdint>
#include <functional>
#include <utility>

#include "shared/ports/can_bus.h"
#include "shared/ports/clock.h"
#include "sim/cell/lockstep/lockstep.h"

namespace tenon::sim {

class VirtualClock final : public Clock {
 public:
  /// By how much a wait until a time ends after it, ns; must not throw.
  using Lateness = std::function<std::int64_t(std::int64_t due_ns)>;

  /// @param time must outlive it
  VirtualClock(Lockstep& time, Lateness late) : time_(time), late_(std::move(late)) {}

  [[nodiscard]] std::int64_t now_ns() noexcept override { return time_.now_ns(); }
  void wait_until_ns(std::int64_t time_ns) noexcept override {
    time_.run_until(std::max(time_ns, time_.now_ns()) + late_(time_ns));
  }

 private:
  Lockstep& time_;
  Lateness late_;
};

/// The master's end of a link, whose wait() lets a lockstep go on once it has one. Both must
/// outlive it.
class LockstepBus final : public CanBus {
 public:
  explicit LockstepBus(CanBus& bus) : bus_(bus) {}
  void wait_by(Lockstep& time) { time_ = &time; }

  [[nodiscard]] SendResult send(const CanFrame& frame) noexcept override {
    return bus_.send(frame);
  }
  [[nodiscard]] bool receive(ReceivedFrame& received) noexcept override {
    return bus_.receive(received);
  }
  void flush() noexcept override { bus_.flush(); }
  void wait(std::int64_t at_most_ns) noexcept override {
    if (time_ != nullptr) time_->await_master(time_->now_ns() + at_most_ns);
  }
  [[nodiscard]] CanBusStatus status() const noexcept override { return bus_.status(); }

 private:
  CanBus& bus_;
  Lockstep* time_ = nullptr;
};

}  // namespace tenon::sim

#pragma once
// Interferes with the frames of a virtual bus as a test says, for as long as it lives: sees each
// frame once at its end, may alter it, and loses it where the function returns false. `end` is the
// sender in the order of attach().

#include <cstddef>
#include <functional>
#include <utility>

#include "sim/cell/bus/virtual_bus.h"

namespace tenon::tests {

class FrameFilter final : public sim::Disturbance {
 public:
  using Function = std::function<bool(CanFrame& frame, std::size_t end)>;

  FrameFilter(sim::VirtualBus& bus, Function function) : bus_(bus), function_(std::move(function)) {
    bus_.set_disturbance(this);
  }
  ~FrameFilter() override { bus_.set_disturbance(nullptr); }

  [[nodiscard]] Fate fate(CanFrame& frame, std::size_t end,
                          std::int64_t /*now_ns*/) noexcept override {
    Fate fate;
    fate.lost = !function_(frame, end);
    return fate;
  }

 private:
  sim::VirtualBus& bus_;
  Function function_;
};

}  // namespace tenon::tests

#pragma once
// A link over a virtual bus: frames take their time, arbitrate, and may be disturbed. The master's
// end is a FIFO, as SocketCAN's is; the devices' end stands for a node each. One thread.

#include <algorithm>
#include <cstddef>
#include <cstdint>

#include "sim/cell/bus/virtual_bus.h"
#include "sim/cell/lockstep/link.h"

namespace tenon::sim {

class VirtualLink final : public Link {
 public:
  static constexpr std::size_t kMaster = 0;  ///< the ends of bus()
  static constexpr std::size_t kDevices = 1;

  /// @param master_node by which a disturbance knows the master's end
  VirtualLink(const VirtualBus::Parameters& parameters, std::uint8_t master_node)
      : bus_(parameters),
        master_(bus_.attach({.order = VirtualBus::Order::kFifo, .node = master_node})),
        devices_(bus_.attach({.order = VirtualBus::Order::kByIdentifier})) {}

  [[nodiscard]] CanBus& master() override { return master_; }
  [[nodiscard]] CanBus& devices() override { return devices_; }
  [[nodiscard]] std::int64_t advance(std::int64_t until_ns) override {
    bus_.advance(std::clamp(bus_.next_event_ns(), bus_.now_ns(), until_ns));
    return bus_.now_ns();
  }
  [[nodiscard]] bool at_master() const override { return bus_.arrived(kMaster) > 0; }
  [[nodiscard]] bool at_devices() const override { return bus_.arrived(kDevices) > 0; }
  [[nodiscard]] bool from_master() const override { return bus_.queued(kMaster) > 0; }

  [[nodiscard]] VirtualBus& bus() { return bus_; }

 private:
  VirtualBus bus_;
  CanBus& master_;
  CanBus& devices_;
};

}  // namespace tenon::sim

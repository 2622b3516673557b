#pragma once
// A link over a virtual bus: frames take their time, arbitrate, and may be disturbed. The master's
// end is a FIFO, as SocketCAN's is; the devices' end stands for a node each. Where the sensor has a
// bus to itself, there is a second one of the kind, and each end stands for both. One thread.

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <optional>

#include "shared/bus/bus_pair.h"
#include "sim/cell/bus/virtual_bus.h"
#include "sim/cell/lockstep/link.h"

namespace tenon::sim {

class VirtualLink final : public Link {
 public:
  static constexpr std::size_t kMaster = 0;  ///< the ends of bus()
  static constexpr std::size_t kDevices = 1;

  /// @param master_node by which a disturbance knows the master's end
  /// @param sensor_bitrate_bps of the sensor's own bus; 0: there is none
  VirtualLink(const VirtualBus::Parameters& parameters, std::uint8_t master_node,
              std::uint32_t sensor_bitrate_bps = 0)
      : arm_(parameters, master_node) {
    if (sensor_bitrate_bps == 0) return;
    VirtualBus::Parameters own = parameters;
    own.bitrate_bps = sensor_bitrate_bps;
    sensor_.emplace(own, master_node);
    master_.emplace(arm_.master, sensor_->master);
    devices_.emplace(arm_.devices, sensor_->devices);
  }

  [[nodiscard]] CanBus& master() override {
    return master_ ? static_cast<CanBus&>(*master_) : arm_.master;
  }
  [[nodiscard]] CanBus& devices() override {
    return devices_ ? static_cast<CanBus&>(*devices_) : arm_.devices;
  }
  [[nodiscard]] std::int64_t advance(std::int64_t until_ns) override {
    std::int64_t next_ns = arm_.bus.next_event_ns();
    if (sensor_) next_ns = std::min(next_ns, sensor_->bus.next_event_ns());
    const std::int64_t to_ns = std::clamp(next_ns, arm_.bus.now_ns(), until_ns);
    arm_.bus.advance(to_ns);
    if (sensor_) sensor_->bus.advance(to_ns);
    return to_ns;
  }
  [[nodiscard]] bool at_master() const override { return arrived(kMaster); }
  [[nodiscard]] bool at_devices() const override { return arrived(kDevices); }
  [[nodiscard]] bool from_master() const override {
    return arm_.bus.queued(kMaster) > 0 || (sensor_ && sensor_->bus.queued(kMaster) > 0);
  }

  [[nodiscard]] VirtualBus& bus() { return arm_.bus; }
  /// Only where the sensor has one.
  [[nodiscard]] VirtualBus& sensor_bus() { return sensor_->bus; }

 private:
  struct Wire {
    Wire(const VirtualBus::Parameters& parameters, std::uint8_t master_node)
        : bus(parameters),
          master(bus.attach({.order = VirtualBus::Order::kFifo, .node = master_node})),
          devices(bus.attach({.order = VirtualBus::Order::kByIdentifier})) {}
    VirtualBus bus;
    CanBus& master;
    CanBus& devices;
  };

  [[nodiscard]] bool arrived(std::size_t end) const {
    return arm_.bus.arrived(end) > 0 || (sensor_ && sensor_->bus.arrived(end) > 0);
  }

  Wire arm_;
  std::optional<Wire> sensor_;
  std::optional<BusPair> master_;
  std::optional<BusPair> devices_;
};

}  // namespace tenon::sim

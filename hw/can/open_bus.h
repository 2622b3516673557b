#pragma once
// A CAN bus by its URI. Set-up code; throws InputError with one line.
//
//   socketcan:can0                  an interface of the kernel
//   slcan:/dev/ttyACM0              a serial adapter, or a pty
//   slcan://127.0.0.1:29536         slcan over TCP, as the virtual arm offers it
//   slcan-listen://127.0.0.1:29536  the virtual arm's end of that; port 0 takes a free one
//
// An arm whose force/torque sensor has a bus to itself: arm=socketcan:can0,sensor=socketcan:can1

#include <array>
#include <cstdint>
#include <memory>
#include <string>

#include "shared/bus/bus_pair.h"
#include "shared/cell/robot.h"
#include "shared/ports/can_bus.h"

namespace tenon::hw {

/// @param bitrate_bps told to slcan adapters; a SocketCAN interface is set from outside and checked
/// @param burst_frames what a cycle sends at once; a SocketCAN transmit queue must hold it
[[nodiscard]] std::unique_ptr<CanBus> open_bus(const std::string& uri, std::uint32_t bitrate_bps,
                                               std::uint32_t burst_frames = 1);

/// What --can names: one bus, or arm=URI,sensor=URI.
struct BusUris {
  std::string arm;
  std::string sensor;  ///< empty: on the arm's
};

/// @throws InputError where it is neither; the URIs themselves are not looked at
[[nodiscard]] BusUris parse_bus_uris(const std::string& text);

/// A sensor that has a bus of its own by the command line alone has one of the arm's bit rate.
/// @throws InputError where the robot's file gives it one, and none is named
void settle_buses(const BusUris& uris, Robot& robot);

/// The buses of an arm, as one where there are two.
class Buses {
 public:
  /// @param burst_frames of each bus, see open_bus()
  Buses(const BusUris& uris, const Robot& robot,
        const std::array<std::uint32_t, BusPair::kBuses>& burst_frames = {1, 1});

  [[nodiscard]] CanBus& all() { return pair_ ? static_cast<CanBus&>(*pair_) : *arm_; }
  [[nodiscard]] CanBus& arm() { return *arm_; }
  /// Null: it is on the arm's.
  [[nodiscard]] CanBus* sensor() { return sensor_.get(); }

 private:
  std::unique_ptr<CanBus> arm_;
  std::unique_ptr<CanBus> sensor_;
  std::unique_ptr<BusPair> pair_;
};

/// The port of a slcan-listen bus, 0 for any other.
[[nodiscard]] std::uint16_t listening_port(const CanBus& bus);

}  // namespace tenon::hw

#include "hw/can/open_bus.h"

#include <algorithm>
#include <charconv>
#include <string_view>

#include "hw/can/endpoints.h"
#include "hw/can/polled_pair.h"
#include "hw/can/slcan_client.h"
#include "hw/can/slcan_server.h"
#include "hw/can/socketcan_bus.h"
#include "shared/base/error.h"

namespace tenon::hw {
namespace {

struct Authority {
  std::string host;
  std::uint16_t port = 0;
};

/// The rest of `uri` where it starts with `prefix`.
bool take_prefix(std::string_view& uri, std::string_view prefix) {
  if (!uri.starts_with(prefix)) return false;
  uri.remove_prefix(prefix.size());
  return true;
}

Authority authority_of(const std::string& uri, std::string_view text) {
  const std::size_t colon = text.rfind(':');
  Authority authority;
  if (colon != std::string_view::npos && colon > 0) {
    authority.host = text.substr(0, colon);
    const std::string_view port = text.substr(colon + 1);
    const auto [end, error] =
        std::from_chars(port.data(), port.data() + port.size(), authority.port);
    if (error == std::errc() && end == port.data() + port.size()) {
      return authority;
    }
  }
  throw InputError("CAN bus '" + uri +
                   "': HOST:PORT expected after '//', with a port of 0..65535, such as "
                   "127.0.0.1:29536");
}

}  // namespace

std::unique_ptr<CanBus> open_bus(const std::string& uri, std::uint32_t bitrate_bps,
                                 std::uint32_t burst_frames) {
  std::string_view rest = uri;
  if (take_prefix(rest, "socketcan:")) {
    return std::make_unique<SocketcanBus>(std::string(rest), bitrate_bps, burst_frames);
  }
  if (take_prefix(rest, "slcan-listen://")) {
    const Authority authority = authority_of(uri, rest);
    return std::make_unique<SlcanServer>(listen_tcp(authority.host, authority.port));
  }
  if (take_prefix(rest, "slcan://")) {
    const Authority authority = authority_of(uri, rest);
    return std::make_unique<SlcanClient>(connect_tcp(authority.host, authority.port), bitrate_bps);
  }
  if (take_prefix(rest, "slcan:") && rest.starts_with('/')) {
    return std::make_unique<SlcanClient>(open_serial(std::string(rest)), bitrate_bps);
  }
  throw InputError("CAN bus '" + uri +
                   "': not understood; use socketcan:INTERFACE, slcan:/dev/TTY, "
                   "slcan://HOST:PORT or slcan-listen://HOST:PORT");
}

BusUris parse_bus_uris(const std::string& text) {
  constexpr std::string_view kArm = "arm=";
  constexpr std::string_view kSensor = "sensor=";
  if (!text.starts_with(kArm) && !text.starts_with(kSensor)) return {text, ""};
  const std::size_t comma = std::min(text.find(','), text.size());
  const std::string_view all = text;
  BusUris uris;
  for (std::string_view part :
       {all.substr(0, comma), all.substr(std::min(comma + 1, all.size()))}) {
    if (take_prefix(part, kArm)) {
      uris.arm = part;
    } else if (take_prefix(part, kSensor)) {
      uris.sensor = part;
    }
  }
  if (uris.arm.empty() || uris.sensor.empty()) {
    throw InputError("--can '" + text +
                     "': two buses are named as arm=URI,sensor=URI, such as "
                     "arm=socketcan:can0,sensor=socketcan:can1");
  }
  // Port 0 is another one each time.
  if (uris.arm == uris.sensor && !uris.arm.ends_with(":0")) {
    throw InputError("--can '" + text +
                     "': names one bus twice; where the sensor is on the arm's, name it once");
  }
  return uris;
}

void settle_buses(const BusUris& uris, Robot& robot) {
  if (robot.sensor.has_own_bus() && uris.sensor.empty()) {
    throw InputError("--can '" + uris.arm + "': the force/torque sensor of robot '" + robot.name +
                     "' has a bus of its own; name both, as arm=" + uris.arm +
                     ",sensor=socketcan:can1");
  }
  if (!uris.sensor.empty() && !robot.sensor.has_own_bus()) {
    robot.sensor.own_bitrate_bps = robot.bitrate_bps;
  }
}

Buses::Buses(const BusUris& uris, const Robot& robot,
             const std::array<std::uint32_t, BusPair::kBuses>& burst_frames)
    : arm_(open_bus(uris.arm, robot.bitrate_bps, burst_frames[kArmBus])) {
  if (uris.sensor.empty()) return;
  sensor_ = open_bus(uris.sensor, robot.sensor.own_bitrate_bps, burst_frames[kSensorBus]);
  pair_ = std::make_unique<PolledPair>(*arm_, *sensor_);
}

std::uint16_t listening_port(const CanBus& bus) {
  const auto* server = dynamic_cast<const SlcanServer*>(&bus);
  return server != nullptr ? server->port() : std::uint16_t{0};
}

}  // namespace tenon::hw

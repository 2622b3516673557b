#include "hw/check/object_names.h"

#include <algorithm>
#include <array>
#include <string>
#include <utility>

#include "shared/canopen/constants.h"

namespace tenon::hw {
namespace {

using Named = std::pair<std::uint16_t, const char*>;

constexpr std::array<Named, 22> kNames = {{
    {tenon::canopen::kDeviceType, "device type"},
    {tenon::canopen::kSyncCobId, "SYNC identifier"},
    {tenon::canopen::kSyncPeriod, "SYNC period"},
    {tenon::canopen::kHeartbeatConsumer, "watch on the master"},
    {tenon::canopen::kHeartbeatProducer, "heartbeat period"},
    {tenon::canopen::kIdentity, "identity"},
    {tenon::canopen::kSyncOverflow, "SYNC counter overflow"},
    {tenon::canopen::kAbortConnectionOption, "lost-connection option"},
    {tenon::canopen::kQuickStopOption, "quick-stop option"},
    {tenon::canopen::kShutdownOption, "shutdown option"},
    {tenon::canopen::kDisableOption, "disable option"},
    {tenon::canopen::kFaultReactionOption, "fault-reaction option"},
    {tenon::canopen::kMode, "mode of operation"},
    {tenon::canopen::kModeDisplay, "mode display"},
    {tenon::canopen::kFollowingWindow, "following-error window"},
    {tenon::canopen::kFollowingTimeout, "following-error time"},
    {tenon::canopen::kTorqueMax, "largest torque"},
    {tenon::canopen::kPositionLimits, "position limits"},
    {tenon::canopen::kQuickStopDeceleration, "quick-stop deceleration"},
    {tenon::canopen::kInterpolationData, "interpolation target"},
    {tenon::canopen::kInterpolationPeriod, "interpolation period"},
    {tenon::canopen::kSupportedModes, "supported modes"},
}};

constexpr std::array<Named, 4> kPdoNames = {{
    {tenon::canopen::kRpdoCommunication, "RPDO # identifier, type, deadline"},
    {tenon::canopen::kRpdoMapping, "RPDO # mapping"},
    {tenon::canopen::kTpdoCommunication, "TPDO # identifier, type"},
    {tenon::canopen::kTpdoMapping, "TPDO # mapping"},
}};

}  // namespace

std::string object_name(std::uint16_t index) {
  const auto* named = std::find_if(kNames.begin(), kNames.end(),
                                   [index](const Named& each) { return each.first == index; });
  if (named != kNames.end()) return named->second;
  for (const auto& [first, name] : kPdoNames) {
    if (index < first || index >= first + tenon::canopen::kPdos) continue;
    std::string text = name;
    text.replace(text.find('#'), 1, std::to_string(index - first + 1));
    return text;
  }
  return "";
}

}  // namespace tenon::hw

#include "hw/arm/drive_settings.h"

#include <algorithm>
#include <cmath>
#include <initializer_list>
#include <limits>

#include "hw/arm/node_settings.h"
#include "shared/base/text.h"
#include "shared/canopen/constants.h"
#include "shared/canopen/robot_drives.h"

namespace tenon::hw {
namespace {

using canopen::ObjectSetting;
using Action = ObjectSetting::Action;
using Settings = std::vector<ObjectSetting>;

constexpr std::uint32_t kOptionQuickStopOnLostMaster = 3;
// And not 6, which holds under power until somebody commands the drive: after a quick stop for want
// of a master nobody does, and the only way out, disable voltage, lets the axis go before the brake
// holds it.
constexpr std::uint32_t kOptionQuickRampThenDisable = 2;
constexpr std::uint32_t kOptionRampDownThenDisable = 1;
constexpr std::uint32_t kFollowingTimeout_ms = 10;

/// The magnitude of a length in m or rad, in counts, as a u32 object takes it.
std::uint32_t counts_of(const Joint& joint, double magnitude) {
  const double counts = std::round(std::abs(magnitude * joint.counts_per_unit));
  return static_cast<std::uint32_t>(
      std::clamp(counts, 1.0, static_cast<double>(std::numeric_limits<std::int32_t>::max())));
}

/// An end of the joint's range. Outwards where it falls between two counts: no setpoint within the
/// range may be cut.
std::uint32_t end_of_range(const Joint& joint, bool lowest) {
  const double lower = joint.lower * joint.counts_per_unit + joint.zero_counts;
  const double upper = joint.upper * joint.counts_per_unit + joint.zero_counts;
  const double counts =
      lowest ? std::floor(std::min(lower, upper)) : std::ceil(std::max(lower, upper));
  return static_cast<std::uint32_t>(static_cast<std::int32_t>(counts));
}

std::uint32_t effort_max_permille(const Joint& joint) {
  const double permille = std::round(1000.0 * joint.effort_max / joint.rated_effort);
  return static_cast<std::uint32_t>(std::clamp(permille, 1.0, 65535.0));
}

Action action_of(Treatment treatment) {
  switch (treatment) {
    case Treatment::kWrite:
      return Action::kWrite;
    case Treatment::kClamp:
      return Action::kWriteOrTake;
    case Treatment::kCheck:
      return Action::kExpect;
    case Treatment::kAccept:
      return Action::kTake;
  }
  return Action::kWrite;
}

ObjectSetting setting_of(const Robot& robot, const Joint& joint, DriveObject object) {
  const DriveObjectRow& row = row_of(object);
  const DriveProfile::Object& how = canopen_drive(joint).profile.object(object);
  ObjectSetting setting{action_of(how.treatment), row.index, row.sub, row.size_bytes,
                        wanted_value(robot, joint, object)};
  if (object == DriveObject::kSupportedModes) setting.compare_mask = setting.value;
  setting.optional = how.presence == Presence::kOptional;
  setting.zero_is_off =
      object == DriveObject::kFollowingWindow || object == DriveObject::kTorqueMax;
  return setting;
}

/// What a device keeps from the last power-on or from its factory, and mostly is as it should be:
/// looked at first. The counter of SYNC changes only while the period is 0 (CiA 301, 7.5.2.22).
void append_if_other(Settings& settings, const Joint& joint, ObjectSetting setting) {
  ObjectSetting looked_at = setting;
  looked_at.action = Action::kCompare;
  settings.push_back(looked_at);
  if (setting.index == tenon::canopen::kSyncOverflow &&
      canopen_drive(joint).profile.object(DriveObject::kSyncPeriod).presence != Presence::kAbsent) {
    settings.push_back(
        {Action::kWriteIfOther, tenon::canopen::kSyncPeriod, 0, 4, 0, 0xFFFFFFFF, true});
  }
  setting.action = Action::kWriteIfOther;
  settings.push_back(setting);
}

/// Whether the profile leaves one of the objects to the device.
bool leaves(const DriveProfile& drive, std::initializer_list<DriveObject> objects) {
  return std::any_of(objects.begin(), objects.end(), [&](DriveObject object) {
    const DriveProfile::Object& how = drive.object(object);
    return how.presence != Presence::kRequired || how.treatment == Treatment::kAccept;
  });
}

std::vector<std::string> remarks_of(const DriveProfile& drive) {
  std::vector<std::string> lines;
  using enum DriveObject;
  if (leaves(drive, {kMasterWatch, kConnectionOption})) {
    lines.emplace_back(
        "nothing makes them stop when the executor or the bus dies (1016h, 6007h): they may go on "
        "under power; the cell must cut their power by a stop of its own");
  }
  if (leaves(drive, {kQuickStopOption, kShutdownOption, kDisableOption})) {
    lines.emplace_back(
        "how they stop and switch off cannot be set (605Ah, 605Bh, 605Ch): they may hold under "
        "power, or drop before a brake holds; the cell must hold the arm by brakes that close "
        "without them");
  }
  if (leaves(drive, {kQuickStopDeceleration})) {
    lines.emplace_back(
        "how hard they brake in a quick stop cannot be set (6085h); the cell must leave room for "
        "the longest way that they take");
  }
  if (leaves(drive, {kFollowingWindow})) {
    lines.emplace_back(
        "they do not watch their following error (6065h); only the executor does, while it runs");
  }
  return lines;
}

}  // namespace

std::uint32_t wanted_value(const Robot& robot, const Joint& joint, DriveObject object) {
  const InterpolationPeriod period = interpolation_period(robot.cycle_us).value();
  switch (object) {
    case DriveObject::kSupportedModes:
      return 1u << (static_cast<unsigned>(canopen_drive(joint).mode) - 1);
    case DriveObject::kSyncCobId:
      return tenon::canopen::kSync;
    case DriveObject::kSyncOverflow:
      return 0;
    case DriveObject::kSyncPeriod:
      return robot.cycle_us;
    case DriveObject::kInterpolationValue:
      return period.value;
    case DriveObject::kInterpolationExponent:
      return static_cast<std::uint8_t>(period.exponent);
    case DriveObject::kMasterWatch:
      return static_cast<std::uint32_t>(robot.master_node) << 16 | robot.heartbeat_timeout_ms;
    case DriveObject::kConnectionOption:
      return kOptionQuickStopOnLostMaster;
    case DriveObject::kQuickStopOption:
      return kOptionQuickRampThenDisable;
    case DriveObject::kShutdownOption:
    case DriveObject::kDisableOption:
      return kOptionRampDownThenDisable;
    case DriveObject::kQuickStopDeceleration:
      return counts_of(joint, joint.acceleration_max);
    case DriveObject::kFollowingWindow:
      return counts_of(joint, joint.following_error_max);
    case DriveObject::kFollowingTimeout:
      return kFollowingTimeout_ms;
    case DriveObject::kTorqueMax:
      return effort_max_permille(joint);
    case DriveObject::kPositionMin:
    case DriveObject::kPositionMax:
      return end_of_range(joint, object == DriveObject::kPositionMin);
  }
  return 0;
}

void append_drive_objects(Settings& settings, const Robot& robot, const Joint& joint,
                          DriveObject first, DriveObject last) {
  for (const DriveObjectRow& row : kDriveObjectRows) {
    const DriveProfile::Object& how = canopen_drive(joint).profile.object(row.object);
    if (row.object < first || row.object > last || how.presence == Presence::kAbsent) continue;
    const ObjectSetting setting = setting_of(robot, joint, row.object);
    const bool of_sync =
        row.object == DriveObject::kSyncCobId || row.object == DriveObject::kSyncOverflow;
    if (of_sync && how.treatment == Treatment::kWrite) {
      append_if_other(settings, joint, setting);
    } else {
      settings.push_back(setting);
    }
  }
}

void append_extra_objects(Settings& settings, const Joint& joint) {
  for (const DriveProfile::Extra& extra : canopen_drive(joint).profile.extra) {
    if (extra.how.presence == Presence::kAbsent) continue;
    settings.push_back({action_of(extra.how.treatment), extra.index, extra.sub, extra.size_bytes,
                        extra.value, 0xFFFFFFFF, extra.how.presence == Presence::kOptional});
  }
}

std::vector<std::string> drive_remarks(const Robot& robot) {
  std::vector<std::string> lines;
  std::vector<std::string> told;
  for (const Joint& joint : robot.joints) {
    if (std::find(told.begin(), told.end(), canopen_drive(joint).profile.name) != told.end())
      continue;
    std::string joints;
    for (const Joint& other : robot.joints) {
      if (canopen_drive(other).profile.name == canopen_drive(joint).profile.name)
        joints += (joints.empty() ? "" : ", ") + other.name;
    }
    told.push_back(canopen_drive(joint).profile.name);
    for (const std::string& remark : remarks_of(canopen_drive(joint).profile)) {
      lines.push_back(format("joints %s (drive %s): %s", joints.c_str(),
                             canopen_drive(joint).profile.name.c_str(), remark.c_str()));
    }
  }
  return lines;
}

}  // namespace tenon::hw

#include "hw/arm/node_settings.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include "hw/arm/cob_ids.h"
#include "hw/arm/drive_settings.h"
#include "hw/arm/identifiers.h"
#include "hw/canopen/pdo.h"
#include "shared/base/error.h"
#include "shared/base/text.h"
#include "shared/canopen/constants.h"
#include "shared/canopen/robot_drives.h"
#include "shared/ports/arm.h"

namespace tenon::hw {
namespace {

using canopen::ObjectSetting;
using canopen::PdoConfiguration;
using Action = ObjectSetting::Action;
using Settings = std::vector<ObjectSetting>;

constexpr std::uint32_t kDriveProfile = 402;
void append_mode(Settings& settings, const Joint& joint) {
  const auto mode = static_cast<std::uint32_t>(canopen_drive(joint).mode);
  settings.push_back({Action::kWrite, tenon::canopen::kMode, 0, 1, mode});
  settings.push_back({Action::kAwait, tenon::canopen::kModeDisplay, 0, 1, mode});
}

canopen::PdoFreedom freedom_of(const DriveProfile& drive) {
  return {!drive.fixed_mapping, !drive.fixed_identifiers, !drive.fixed_transmission_types};
}

canopen::PdoEntry target_of(const Joint& joint) {
  return canopen_drive(joint).mode == DriveMode::kInterpolatedPosition
             ? canopen::PdoEntry{tenon::canopen::kInterpolationData, 1, 32}
             : canopen::PdoEntry{tenon::canopen::kTargetPosition, 0, 32};
}

}  // namespace

bool takes_stop(const DriveProfile& drive) {
  const canopen::PdoFreedom free = freedom_of(drive);
  return free.mapping && free.identifier && free.transmission_type;
}

namespace {

void append_receive_pdos(Settings& settings, const Robot& robot, std::size_t index) {
  using Direction = PdoConfiguration::Direction;
  const Joint& joint = robot.joints[index];
  const canopen::PdoEntry controlword{tenon::canopen::kControlword, 0, 16};
  const canopen::PdoEntry target = target_of(joint);
  if (robot.targets_per_frame == 1) {
    canopen::append_pdo(settings,
                        {Direction::kReceive,
                         1,
                         joint_command_cob_id(joint.node),
                         canopen::kEverySync,
                         {controlword, target}},
                        freedom_of(canopen_drive(joint).profile));
    return;
  }
  // Both of a pair take the same frame, each its own half.
  const std::size_t first = index - index % 2;
  PdoConfiguration targets{Direction::kReceive,
                           1,
                           joint_command_cob_id(robot.joints[first].node),
                           canopen::kEverySync,
                           {target}};
  const canopen::PdoEntry skipped{canopen::kDummyI32, 0, 32};
  if (index != first) {
    targets.entries.insert(targets.entries.begin(), skipped);
  } else if (index + 1 < robot.joints.size()) {
    targets.entries.push_back(skipped);
  }
  canopen::append_pdo(settings, targets);
  canopen::append_pdo(settings, {Direction::kReceive,
                                 2,
                                 joint_controlword_cob_id(joint.node),
                                 canopen::kAtOnce,
                                 {controlword}});
}

/// A drive that has it watches its setpoints, too, at rest as in motion, and takes their loss for
/// its master's.
void append_setpoint_deadline(Settings& settings, const Robot& robot, const Joint& joint) {
  if (canopen_drive(joint).profile.fixed_identifiers) return;
  settings.push_back({Action::kWriteOrTake, tenon::canopen::kRpdoCommunication,
                      tenon::canopen::kPdoEventTimer, 2, robot.heartbeat_timeout_ms, 0xFFFFFFFF,
                      true});
}

/// The first RPDO that no setpoint needs.
std::uint8_t stop_rpdo(const Robot& robot) { return robot.targets_per_frame == 1 ? 2 : 3; }

/// What a device sends or acts on unasked.
void append_unused_pdos(Settings& settings, const Robot& robot, const Joint& joint) {
  using Direction = PdoConfiguration::Direction;
  const int first = stop_rpdo(robot) + (takes_stop(canopen_drive(joint).profile) ? 1 : 0);
  for (auto number = static_cast<std::uint8_t>(first); number <= 4; ++number) {
    canopen::append_unused_pdo(settings, Direction::kReceive, joint.node, number);
  }
  for (std::uint8_t number = 2; number <= 4; ++number) {
    canopen::append_unused_pdo(settings, Direction::kTransmit, joint.node, number);
  }
}

/// The controlword of all drives at once.
void append_stop_pdo(Settings& settings, const Robot& robot) {
  canopen::append_optional_pdo(settings, {PdoConfiguration::Direction::kReceive,
                                          stop_rpdo(robot),
                                          kStopCobId,
                                          canopen::kAtOnce,
                                          {{tenon::canopen::kControlword, 0, 16}}});
}

[[noreturn]] void refuse(const Robot& robot, const std::string& what) {
  throw InputError("robot '" + robot.name + "': " + what);
}

void check_nodes(const Robot& robot) {
  std::vector<std::pair<unsigned, std::string>> nodes{{robot.master_node, "the master"}};
  for (const Joint& joint : robot.joints) {
    nodes.emplace_back(joint.node, "joint " + joint.name);
  }
  if (robot.sensor.protocol == SensorProtocol::kNode) {
    nodes.emplace_back(robot.sensor.node, "the force/torque sensor");
  }
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    const auto& [node, owner] = nodes[i];
    if (node < 1 || node > 127) {
      refuse(robot, "node " + std::to_string(node) + " of " + owner + " must be in 1..127");
    }
    for (std::size_t k = 0; k < i; ++k) {
      if (nodes[k].first == node) {
        refuse(robot, "node " + std::to_string(node) + " is given to both " + nodes[k].second +
                          " and " + owner + "; every node needs its own");
      }
    }
  }
}

void check_joint(const Robot& robot, const Joint& joint) {
  const auto positive = [&](double value, const char* name) {
    if (!(value > 0.0) || !std::isfinite(value)) {
      refuse(robot, "joint " + joint.name + ": " + name + " = " + std::to_string(value) +
                        ", must be positive and finite");
    }
  };
  positive(std::abs(joint.counts_per_unit), "|counts per unit|");
  positive(joint.rated_effort, "rated effort");
  positive(joint.following_error_max, "following error limit");
  positive(joint.acceleration_max, "acceleration limit");
  for (const double end : {joint.lower, joint.upper}) {
    const double counts = end * joint.counts_per_unit + joint.zero_counts;
    if (!(std::abs(counts) < static_cast<double>(std::numeric_limits<std::int32_t>::max()))) {
      refuse(robot, "joint " + joint.name + ": its limit lies at " + std::to_string(counts) +
                        " counts, must fit 32 bits");
    }
  }
}

/// What a drive cannot be told its neighbours must leave room for.
void check_fixed(const Robot& robot) {
  for (std::size_t i = 0; i < robot.joints.size(); ++i) {
    const Joint& joint = robot.joints[i];
    const DriveProfile& drive = canopen_drive(joint).profile;
    const bool fixed =
        drive.fixed_mapping || drive.fixed_identifiers || drive.fixed_transmission_types;
    if (fixed && robot.targets_per_frame != 1) {
      refuse(robot, "joint " + joint.name + ": the PDOs of drive " + drive.name +
                        " are fixed, and no frame of theirs holds two targets; set "
                        "targets_per_frame: 1");
    }
    const std::uint32_t id = joint_feedback_cob_id(robot, i);
    bool taken = id == kForceCobId || id == kTorqueCobId || id == kStopCobId;
    for (std::size_t k = 0; k < robot.joints.size(); ++k) {
      taken = taken || (k != i && joint_feedback_cob_id(robot, k) == id);
    }
    if (taken && drive.fixed_identifiers) {
      refuse(robot, "joint " + joint.name +
                        format(": its feedback stays at %03Xh, which another frame has (drive %s "
                               "has fixed identifiers); give it another node than %u",
                               id, drive.name.c_str(), static_cast<unsigned>(joint.node)));
    }
  }
}

}  // namespace

double boot_s(const Robot& robot, std::uint8_t node) {
  const auto joint = std::find_if(robot.joints.begin(), robot.joints.end(),
                                  [&](const Joint& each) { return each.node == node; });
  return joint == robot.joints.end() ? DriveProfile{}.boot_s : canopen_drive(*joint).profile.boot_s;
}

ObjectSetting heartbeat_setting(const Robot& robot) {
  return {Action::kWrite, tenon::canopen::kHeartbeatProducer, 0, 2, robot.heartbeat_ms};
}

Settings joint_settings(const Robot& robot, std::size_t index) {
  using namespace tenon::canopen;
  const Joint& joint = robot.joints.at(index);
  Settings settings;
  settings.push_back({Action::kExpect, kDeviceType, 0, 4, kDriveProfile, 0xFFFF});
  append_extra_objects(settings, joint);
  append_drive_objects(settings, robot, joint, DriveObject::kSupportedModes,
                       DriveObject::kInterpolationExponent);
  append_mode(settings, joint);
  append_drive_objects(settings, robot, joint, DriveObject::kMasterWatch,
                       DriveObject::kPositionMax);
  append_receive_pdos(settings, robot, index);
  append_setpoint_deadline(settings, robot, joint);
  if (takes_stop(canopen_drive(joint).profile)) append_stop_pdo(settings, robot);
  canopen::append_pdo(settings,
                      {PdoConfiguration::Direction::kTransmit,
                       1,
                       joint_feedback_cob_id(robot, index),
                       canopen::kEverySync,
                       {{kStatusword, 0, 16}, {kTorqueActual, 0, 16}, {kPositionActual, 0, 32}}},
                      freedom_of(canopen_drive(joint).profile));
  if (!canopen_drive(joint).profile.fixed_identifiers) append_unused_pdos(settings, robot, joint);
  return settings;
}

Settings sensor_settings(const Robot& robot) {
  using namespace tenon::canopen;
  Settings settings;
  settings.push_back({Action::kExpect, kSensorStatus, 0, 2, 0});
  for (unsigned half = 0; half < 2; ++half) {
    PdoConfiguration pdo{PdoConfiguration::Direction::kTransmit,
                         static_cast<std::uint8_t>(half + 1),
                         half == 0 ? kForceCobId : kTorqueCobId,
                         static_cast<std::uint8_t>(robot.sensor.cycles_per_sample),
                         {}};
    for (unsigned axis = 1; axis <= 3; ++axis) {
      pdo.entries.push_back({kForceInputs, static_cast<std::uint8_t>(3 * half + axis), 16});
    }
    pdo.entries.push_back({kSampleCounter, 0, 16});
    canopen::append_pdo(settings, pdo);
  }
  for (const std::uint8_t number : {std::uint8_t{3}, std::uint8_t{4}}) {
    canopen::append_unused_pdo(settings, PdoConfiguration::Direction::kTransmit, robot.sensor.node,
                               number);
  }
  return settings;
}

std::optional<InterpolationPeriod> interpolation_period(std::uint32_t cycle_us) {
  // The coarsest exponent that is exact: devices know the usual milliseconds best.
  std::uint32_t unit_us = 1000;
  for (std::int8_t exponent = -3; exponent >= -6; --exponent, unit_us /= 10) {
    const std::uint32_t value = cycle_us / unit_us;
    if (value * unit_us == cycle_us && value >= 1 && value <= 255) {
      return InterpolationPeriod{static_cast<std::uint8_t>(value), exponent};
    }
  }
  return std::nullopt;
}

void check_robot(const Robot& robot) {
  if (robot.joints.empty() || robot.joints.size() > kMaxJoints) {
    refuse(robot, std::to_string(robot.joints.size()) + " joints, must be 1.." +
                      std::to_string(kMaxJoints));
  }
  check_nodes(robot);
  for (const Joint& joint : robot.joints) {
    check_joint(robot, joint);
  }
  if (!interpolation_period(robot.cycle_us)) {
    refuse(robot, "cycle of " + std::to_string(robot.cycle_us) +
                      " us cannot be written to 60C2h (1..255 times a power of ten); take a "
                      "multiple of 1000 us");
  }
  if (robot.targets_per_frame != 1 && robot.targets_per_frame != 2) {
    refuse(robot, std::to_string(robot.targets_per_frame) + " targets a frame, must be 1 or 2");
  }
  check_fixed(robot);
  check_sensor_identifiers(robot, canopen_identifiers(robot));
  if (robot.heartbeat_ms == 0 || robot.heartbeat_timeout_ms > 65535 ||
      robot.heartbeat_timeout_ms < 2 * robot.heartbeat_ms) {
    refuse(robot, "heartbeat of " + std::to_string(robot.heartbeat_ms) + " ms with a timeout of " +
                      std::to_string(robot.heartbeat_timeout_ms) +
                      " ms; the timeout must be at least twice the heartbeat and fit 16 bits");
  }
}

}  // namespace tenon::hw

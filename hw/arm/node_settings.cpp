#include "hw/arm/node_settings.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include "hw/arm/cob_ids.h"
#include "hw/canopen/pdo.h"
#include "shared/base/error.h"
#include "shared/canopen/constants.h"
#include "shared/ports/arm.h"

namespace tenon::hw {
namespace {

using canopen::ObjectSetting;
using canopen::PdoConfiguration;
using Action = ObjectSetting::Action;
using Settings = std::vector<ObjectSetting>;

constexpr std::uint32_t kDriveProfile = 402;
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

void append_supervision(Settings& settings, const Robot& robot, const Joint& joint) {
  using namespace tenon::canopen;
  const std::uint32_t consumer =
      static_cast<std::uint32_t>(robot.master_node) << 16 | robot.heartbeat_timeout_ms;
  settings.push_back({Action::kWrite, kHeartbeatConsumer, 1, 4, consumer});
  settings.push_back({Action::kWrite, kAbortConnectionOption, 0, 2, kOptionQuickStopOnLostMaster});
  settings.push_back({Action::kWrite, kQuickStopOption, 0, 2, kOptionQuickRampThenDisable});
  settings.push_back({Action::kWrite, kShutdownOption, 0, 2, kOptionRampDownThenDisable});
  settings.push_back({Action::kWrite, kDisableOption, 0, 2, kOptionRampDownThenDisable});
  settings.push_back(
      {Action::kWrite, kQuickStopDeceleration, 0, 4, counts_of(joint, joint.acceleration_max)});
  settings.push_back(
      {Action::kWrite, kFollowingWindow, 0, 4, counts_of(joint, joint.following_error_max)});
  settings.push_back({Action::kWrite, kFollowingTimeout, 0, 2, kFollowingTimeout_ms});
}

void append_timing_and_mode(Settings& settings, const Robot& robot, const Joint& joint) {
  using namespace tenon::canopen;
  const InterpolationPeriod period = interpolation_period(robot.cycle_us).value();
  const auto mode = static_cast<std::uint32_t>(joint.mode);
  const std::uint32_t mode_bit = 1u << (mode - 1);
  settings.push_back({Action::kExpect, kSupportedModes, 0, 4, mode_bit, mode_bit});
  settings.push_back({Action::kWrite, tenon::canopen::kSyncPeriod, 0, 4, robot.cycle_us});
  settings.push_back({Action::kWrite, kInterpolationPeriod, 1, 1, period.value});
  settings.push_back(
      {Action::kWrite, kInterpolationPeriod, 2, 1, static_cast<std::uint8_t>(period.exponent)});
  settings.push_back({Action::kWrite, kMode, 0, 1, mode});
  settings.push_back({Action::kAwait, kModeDisplay, 0, 1, mode});
}

canopen::PdoEntry target_of(const Joint& joint) {
  return joint.mode == Joint::Mode::kInterpolatedPosition
             ? canopen::PdoEntry{tenon::canopen::kInterpolationData, 1, 32}
             : canopen::PdoEntry{tenon::canopen::kTargetPosition, 0, 32};
}

void append_receive_pdos(Settings& settings, const Robot& robot, std::size_t index) {
  using Direction = PdoConfiguration::Direction;
  const Joint& joint = robot.joints[index];
  const canopen::PdoEntry controlword{tenon::canopen::kControlword, 0, 16};
  const canopen::PdoEntry target = target_of(joint);
  if (robot.targets_per_frame == 1) {
    canopen::append_pdo(settings, {Direction::kReceive,
                                   1,
                                   joint_command_cob_id(joint.node),
                                   canopen::kEverySync,
                                   {controlword, target}});
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

[[noreturn]] void refuse(const Robot& robot, const std::string& what) {
  throw InputError("robot '" + robot.name + "': " + what);
}

void check_nodes(const Robot& robot) {
  std::vector<std::pair<unsigned, std::string>> nodes{{robot.master_node, "the master"}};
  for (const Joint& joint : robot.joints) {
    nodes.emplace_back(joint.node, "joint " + joint.name);
  }
  nodes.emplace_back(robot.sensor.node, "the force/torque sensor");
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

}  // namespace

ObjectSetting heartbeat_setting(const Robot& robot) {
  return {Action::kWrite, tenon::canopen::kHeartbeatProducer, 0, 2, robot.heartbeat_ms};
}

Settings joint_settings(const Robot& robot, std::size_t index) {
  using namespace tenon::canopen;
  const Joint& joint = robot.joints.at(index);
  Settings settings;
  settings.push_back({Action::kExpect, kDeviceType, 0, 4, kDriveProfile, 0xFFFF});
  append_timing_and_mode(settings, robot, joint);
  append_supervision(settings, robot, joint);
  append_receive_pdos(settings, robot, index);
  canopen::append_pdo(settings,
                      {PdoConfiguration::Direction::kTransmit,
                       1,
                       joint_feedback_cob_id(index),
                       canopen::kEverySync,
                       {{kStatusword, 0, 16}, {kTorqueActual, 0, 16}, {kPositionActual, 0, 32}}});
  for (const std::uint8_t number : {std::uint8_t{2}, std::uint8_t{3}, std::uint8_t{4}}) {
    canopen::append_unused_tpdo(settings, joint.node, number);
  }
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
                         canopen::kEverySync,
                         {}};
    for (unsigned axis = 1; axis <= 3; ++axis) {
      pdo.entries.push_back({kForceInputs, static_cast<std::uint8_t>(3 * half + axis), 16});
    }
    pdo.entries.push_back({kSampleCounter, 0, 16});
    canopen::append_pdo(settings, pdo);
  }
  for (const std::uint8_t number : {std::uint8_t{3}, std::uint8_t{4}}) {
    canopen::append_unused_tpdo(settings, robot.sensor.node, number);
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
  if (robot.heartbeat_ms == 0 || robot.heartbeat_timeout_ms > 65535 ||
      robot.heartbeat_timeout_ms < 2 * robot.heartbeat_ms) {
    refuse(robot, "heartbeat of " + std::to_string(robot.heartbeat_ms) + " ms with a timeout of " +
                      std::to_string(robot.heartbeat_timeout_ms) +
                      " ms; the timeout must be at least twice the heartbeat and fit 16 bits");
  }
}

}  // namespace tenon::hw

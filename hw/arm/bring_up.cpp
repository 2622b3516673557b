#include "hw/arm/bring_up.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "hw/arm/node_settings.h"
#include "hw/canopen/nmt.h"
#include "hw/canopen/sdo.h"
#include "shared/base/time_units.h"
#include "shared/canopen/constants.h"
#include "shared/canopen/robot_drives.h"

namespace tenon::hw {
namespace {

using canopen::ObjectSetting;
using Action = ObjectSetting::Action;

constexpr std::array<ObjectSetting, 3> kIdentityObjects{{
    {Action::kRecord, tenon::canopen::kDeviceType, 0},
    {Action::kRecord, tenon::canopen::kIdentity, 1},
    {Action::kRecord, tenon::canopen::kIdentity, 2},
}};

}  // namespace

BringUp::BringUp(const Robot& robot)
    : other_master_(robot), listen_ns_(robot.heartbeat_timeout_ms * kNanosecondsPerMillisecond) {
  const auto add_node = [&](std::uint8_t node, double boot_s,
                            const std::vector<ObjectSetting>& settings) {
    nodes_.push_back({node, std::llround(1e9 * boot_s)});
    watch_.add(node);
    announce_.push_back({node, heartbeat_setting(robot)});
    for (const ObjectSetting& setting : kIdentityObjects) {
      configure_.push_back({node, setting});
    }
    for (const ObjectSetting& setting : settings) {
      configure_.push_back({node, setting});
    }
  };
  for (std::size_t i = 0; i < robot.joints.size(); ++i) {
    const Joint& joint = robot.joints[i];
    add_node(joint.node, canopen_drive(joint).profile.boot_s, joint_settings(robot, i));
    if (!takes_stop(canopen_drive(joint).profile))
      known_.push_back({SettingNote::Kind::kNoStop, joint.node});
  }
  if (robot.sensor.node != 0) {
    add_node(robot.sensor.node, boot_s(robot, robot.sensor.node), sensor_settings(robot));
  }
  runner_.reset(known_);
}

void BringUp::restart() {
  state_ = State::kListen;
  entered_ns_.reset();
  fault_ = {};
  runner_.reset(known_);
}

void BringUp::process(const CanFrame& frame, std::int64_t now_ns, CanBus& bus) {
  if (other_master_.sent(frame)) {
    return fail({ArmFaultKind::kOtherMaster, 0, 0, frame.id});
  }
  if (state_ == State::kListen) {
    return;
  }
  if (const auto heartbeat = canopen::decode_heartbeat(frame)) {
    const bool ours = watch_.process(*heartbeat, now_ns);
    const bool settled = state_ == State::kConfigure || state_ == State::kOperational;
    if (ours && settled && heartbeat->state == tenon::canopen::kStateBootUp) {
      fail({ArmFaultKind::kUnexpectedReset, heartbeat->node, 0, 0});
    }
    return;
  }
  if (state_ == State::kCensus) {
    return count_answer(frame);
  }
  runner_.process(frame, now_ns, bus);
}

void BringUp::update(std::int64_t now_ns, CanBus& bus) {
  if (!entered_ns_) {
    entered_ns_ = now_ns;
  }
  switch (state_) {
    case State::kListen:
      if (now_ns - *entered_ns_ >= listen_ns_) {
        enter_state(State::kBootUp, now_ns, bus);
      }
      return;
    case State::kBootUp:
      return await_boot_up(now_ns, bus);
    case State::kCensus:
      return judge_census(now_ns, bus);
    case State::kAnnounce:
      return run_settings(State::kPreOperational, now_ns, bus);
    case State::kPreOperational:
      return await_all(tenon::canopen::kStatePreOperational, State::kConfigure, now_ns, bus);
    case State::kConfigure:
      return run_settings(State::kStart, now_ns, bus);
    case State::kStart:
      enter_state(State::kOperational, now_ns, bus);
      return;
    case State::kOperational:
      return await_all(tenon::canopen::kStateOperational, State::kDone, now_ns, bus);
    case State::kDone:
    case State::kFailed:
      return;
  }
}

void BringUp::enter_state(State state, std::int64_t now_ns, CanBus& bus) {
  state_ = state;
  entered_ns_ = now_ns;
  switch (state) {
    case State::kBootUp:
      for (Node& node : nodes_) node.reset_again = false;
      watch_.restart(now_ns);
      command_all(tenon::canopen::kNmtResetCommunication, bus);
      return;
    case State::kCensus:
      for (Node& node : nodes_) {
        node.answers = 0;
        send(canopen::sdo_upload({node.id, tenon::canopen::kDeviceType, 0}), bus);
      }
      return;
    case State::kAnnounce:
      watch_.restart(now_ns);
      command_all(tenon::canopen::kNmtPreOperational, bus);
      runner_.start(announce_);
      return;
    case State::kConfigure:
      runner_.start(configure_);
      return;
    case State::kOperational:
      watch_.restart(now_ns);
      command_all(tenon::canopen::kNmtStart, bus);
      return;
    case State::kListen:
    case State::kPreOperational:
    case State::kStart:
    case State::kDone:
    case State::kFailed:
      return;
  }
}

// A reset in the middle of a boot would begin it anew, so nobody is reset before its time is over.
void BringUp::await_boot_up(std::int64_t now_ns, CanBus& bus) {
  const std::int64_t waited_ns = now_ns - *entered_ns_;
  bool all = true;
  for (Node& node : nodes_) {
    if (watch_.state(node.id) == tenon::canopen::kStateBootUp) {
      continue;
    }
    all = false;
    if (waited_ns >= 2 * node.boot_ns) {
      return fail({ArmFaultKind::kNoAnswer, node.id, 0, tenon::canopen::kStateBootUp});
    }
    if (!node.reset_again && waited_ns >= node.boot_ns) {
      node.reset_again = true;
      send(canopen::nmt_frame(tenon::canopen::kNmtResetCommunication, node.id), bus);
    }
  }
  if (all) {
    enter_state(State::kCensus, now_ns, bus);
  }
}

void BringUp::count_answer(const CanFrame& frame) {
  if (frame.extended || frame.remote || frame.length != 8) {
    return;
  }
  for (Node& node : nodes_) {
    if (frame.id == tenon::canopen::kSdoResponse + node.id) ++node.answers;
  }
}

void BringUp::judge_census(std::int64_t now_ns, CanBus& bus) {
  if (now_ns - *entered_ns_ < kCensus_ns) {
    return;
  }
  for (const Node& node : nodes_) {
    if (node.answers > 1) {
      return fail(
          {ArmFaultKind::kConfiguration, node.id, 0, static_cast<std::uint32_t>(node.answers)});
    }
  }
  enter_state(State::kAnnounce, now_ns, bus);
}

void BringUp::await_all(std::uint8_t nmt_state, State next, std::int64_t now_ns, CanBus& bus) {
  for (const Node& node : nodes_) {
    if (watch_.state(node.id) == nmt_state) {
      continue;
    }
    if (now_ns - *entered_ns_ >= kStateTimeout_ns) {
      fail({ArmFaultKind::kNoAnswer, node.id, 0, nmt_state});
    }
    return;
  }
  enter_state(next, now_ns, bus);
}

void BringUp::run_settings(State next, std::int64_t now_ns, CanBus& bus) {
  switch (runner_.update(now_ns, bus)) {
    case SettingRunner::State::kRunning:
      return;
    case SettingRunner::State::kDone:
      return enter_state(next, now_ns, bus);
    case SettingRunner::State::kFailed:
      return fail(runner_.fault());
  }
}

void BringUp::command_all(std::uint8_t command, CanBus& bus) {
  for (const Node& node : nodes_) {
    send(canopen::nmt_frame(command, node.id), bus);
  }
}

void BringUp::send(const CanFrame& frame, CanBus& bus) {
  // A full queue shows as a node that does not answer; only a dead bus is worth naming.
  if (bus.send(frame) == SendResult::kDown) {
    fail({ArmFaultKind::kBusDown, 0, 0, bus.status().failed_bus});
  }
}

void BringUp::fail(const ArmFault& fault) {
  if (state_ != State::kFailed) {
    state_ = State::kFailed;
    fault_ = fault;
  }
}

}  // namespace tenon::hw

#include "hw/arm/bring_up.h"

#include <array>
#include <span>

#include "hw/arm/node_settings.h"
#include "hw/canopen/nmt.h"
#include "shared/base/bytes.h"
#include "shared/canopen/constants.h"

namespace tenon::hw {
namespace {

using canopen::ObjectSetting;
using canopen::SdoClient;
using Action = ObjectSetting::Action;

constexpr std::array<ObjectSetting, 3> kIdentityObjects{{
    {Action::kRecord, tenon::canopen::kDeviceType, 0},
    {Action::kRecord, tenon::canopen::kIdentity, 1},
    {Action::kRecord, tenon::canopen::kIdentity, 2},
}};

}  // namespace

BringUp::BringUp(const Robot& robot)
    : other_master_(robot), listen_ns_(robot.heartbeat_timeout_ms * std::int64_t{1'000'000}) {
  const auto add_node = [&](std::uint8_t node, const std::vector<ObjectSetting>& settings) {
    nodes_.push_back(node);
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
    add_node(robot.joints[i].node, joint_settings(robot, i));
  }
  add_node(robot.sensor.node, sensor_settings(robot));
}

void BringUp::restart() {
  state_ = State::kListen;
  entered_ns_.reset();
  fault_ = {};
  identities_.clear();
  sdo_ = SdoClient{};
  transfer_ = Transfer::kNone;
}

void BringUp::process(const CanFrame& frame, std::int64_t now_ns, CanBus& bus) {
  if (other_master_.sent(frame)) {
    return fail(ArmFaultKind::kOtherMaster, 0, 0, frame.id);
  }
  if (state_ == State::kListen) {
    return;
  }
  if (const auto heartbeat = canopen::decode_heartbeat(frame)) {
    const bool ours = watch_.process(*heartbeat, now_ns);
    const bool settled = state_ == State::kConfigure || state_ == State::kOperational;
    if (ours && settled && heartbeat->state == tenon::canopen::kStateBootUp) {
      fail(ArmFaultKind::kUnexpectedReset, heartbeat->node, 0, 0);
    }
    return;
  }
  if (const auto reply = sdo_.process(frame, now_ns)) {
    send(*reply, bus);
  }
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
      if (!reset_again_ && now_ns - *entered_ns_ >= kBootUpTimeout_ns / 2) {
        reset_again_ = true;
        for (const std::uint8_t node : nodes_) {
          if (watch_.state(node) != tenon::canopen::kStateBootUp) {
            send(canopen::nmt_frame(tenon::canopen::kNmtResetCommunication, node), bus);
          }
        }
      }
      return await_all(tenon::canopen::kStateBootUp, kBootUpTimeout_ns, State::kAnnounce, now_ns,
                       bus);
    case State::kAnnounce:
      return run_tasks(State::kPreOperational, now_ns, bus);
    case State::kPreOperational:
      return await_all(tenon::canopen::kStatePreOperational, kStateTimeout_ns, State::kConfigure,
                       now_ns, bus);
    case State::kConfigure:
      return run_tasks(State::kStart, now_ns, bus);
    case State::kStart:
      enter_state(State::kOperational, now_ns, bus);
      return;
    case State::kOperational:
      return await_all(tenon::canopen::kStateOperational, kStateTimeout_ns, State::kDone, now_ns,
                       bus);
    case State::kDone:
    case State::kFailed:
      return;
  }
}

void BringUp::enter_state(State state, std::int64_t now_ns, CanBus& bus) {
  state_ = state;
  entered_ns_ = now_ns;
  task_ = 0;
  comparing_ = false;
  transfer_ = Transfer::kNone;
  switch (state) {
    case State::kBootUp:
      reset_again_ = false;
      watch_.restart(now_ns);
      command_all(tenon::canopen::kNmtResetCommunication, bus);
      return;
    case State::kAnnounce:
      watch_.restart(now_ns);
      command_all(tenon::canopen::kNmtPreOperational, bus);
      return;
    case State::kOperational:
      watch_.restart(now_ns);
      command_all(tenon::canopen::kNmtStart, bus);
      return;
    case State::kListen:
    case State::kPreOperational:
    case State::kConfigure:
    case State::kStart:
    case State::kDone:
    case State::kFailed:
      return;
  }
}

void BringUp::await_all(std::uint8_t nmt_state, std::int64_t timeout_ns, State next,
                        std::int64_t now_ns, CanBus& bus) {
  for (const std::uint8_t node : nodes_) {
    if (watch_.state(node) == nmt_state) {
      continue;
    }
    if (now_ns - *entered_ns_ >= timeout_ns) {
      fail(ArmFaultKind::kNoAnswer, node, 0, nmt_state);
    }
    return;
  }
  enter_state(next, now_ns, bus);
}

void BringUp::run_tasks(State next, std::int64_t now_ns, CanBus& bus) {
  const std::vector<Task>& tasks = state_ == State::kAnnounce ? announce_ : configure_;
  if (transfer_ != Transfer::kNone) {
    if (const auto abort = sdo_.update(now_ns)) {
      send(*abort, bus);
    }
    if (sdo_.state() == SdoClient::State::kBusy) {
      return;
    }
    finish_transfer(tasks[task_], now_ns, bus);
  }
  if (state_ == State::kFailed || transfer_ != Transfer::kNone) {
    return;
  }
  while (task_ < tasks.size() && same_ && tasks[task_].setting.action == Action::kWriteIfOther) {
    next_task();
  }
  if (task_ == tasks.size()) {
    enter_state(next, now_ns, bus);
    return;
  }
  task_started_ns_ = now_ns;
  const Task& task = tasks[task_];
  switch (task.setting.action) {
    case Action::kWrite:
    case Action::kWriteIfExists:
    case Action::kWriteIfOther:
      return start_writing(task, now_ns, bus);
    case Action::kCompare:
    case Action::kExpect:
    case Action::kAwait:
    case Action::kRecord:
      return start_reading(task, now_ns, bus);
  }
}

void BringUp::start_writing(const Task& task, std::int64_t now_ns, CanBus& bus) {
  std::array<std::uint8_t, 4> bytes{};
  store_le(std::span<std::uint8_t>(bytes), task.setting.value);
  transfer_ = Transfer::kWriting;
  send(sdo_.start_download({task.node, task.setting.index, task.setting.sub},
                           std::span(bytes).first(task.setting.size_bytes), now_ns),
       bus);
}

void BringUp::start_reading(const Task& task, std::int64_t now_ns, CanBus& bus) {
  transfer_ = Transfer::kReading;
  send(sdo_.start_upload({task.node, task.setting.index, task.setting.sub}, now_ns), bus);
}

void BringUp::finish_transfer(const Task& task, std::int64_t now_ns, CanBus& bus) {
  const bool may_be_absent =
      task.setting.action == Action::kWriteIfExists || task.setting.action == Action::kRecord;
  switch (sdo_.state()) {
    case SdoClient::State::kTimedOut:
      return fail(ArmFaultKind::kNoAnswer, task.node, task.setting.object(), 0);
    case SdoClient::State::kAborted:
      if (may_be_absent && (sdo_.abort_code() == tenon::canopen::kAbortNoObject ||
                            sdo_.abort_code() == tenon::canopen::kAbortSubIndex)) {
        return next_task();
      }
      if (task.setting.action == Action::kCompare) {
        return finish_comparing(false);
      }
      return fail(ArmFaultKind::kConfiguration, task.node, task.setting.object(),
                  sdo_.abort_code());
    case SdoClient::State::kDone:
      if (transfer_ == Transfer::kWriting) {
        return start_reading(task, now_ns, bus);
      }
      return finish_reading(task, now_ns, bus);
    case SdoClient::State::kIdle:
    case SdoClient::State::kBusy:
      return;
  }
}

void BringUp::finish_reading(const Task& task, std::int64_t now_ns, CanBus& bus) {
  if (task.setting.action == Action::kRecord) {
    record(task, sdo_.value());
    return next_task();
  }
  if (task.setting.action == Action::kCompare) {
    return finish_comparing(task.setting.matches(sdo_.value()));
  }
  if (task.setting.matches(sdo_.value())) {
    return next_task();
  }
  if (task.setting.action == Action::kAwait && now_ns - task_started_ns_ < kAwaitTimeout_ns) {
    return start_reading(task, now_ns, bus);
  }
  const bool sensor = task.setting.index == tenon::canopen::kSensorStatus;
  fail(sensor ? ArmFaultKind::kSensorInvalid : ArmFaultKind::kConfiguration, task.node,
       task.setting.object(), sdo_.value());
}

void BringUp::finish_comparing(bool same) {
  same_ = same && (same_ || !comparing_);
  next_task();
  comparing_ = true;
}

void BringUp::next_task() {
  ++task_;
  comparing_ = false;
  transfer_ = Transfer::kNone;
}

void BringUp::record(const Task& task, std::uint32_t value) {
  if (identities_.empty() || identities_.back().node != task.node) {
    identities_.push_back({task.node});
  }
  Identity& identity = identities_.back();
  if (task.setting.index == tenon::canopen::kDeviceType) {
    identity.device_type = value;
  } else if (task.setting.sub == 1) {
    identity.vendor = value;
  } else {
    identity.product = value;
  }
}

void BringUp::command_all(std::uint8_t command, CanBus& bus) {
  for (const std::uint8_t node : nodes_) {
    send(canopen::nmt_frame(command, node), bus);
  }
}

void BringUp::send(const CanFrame& frame, CanBus& bus) {
  // A full queue shows as a node that does not answer; only a dead bus is worth naming.
  if (bus.send(frame) == SendResult::kDown) {
    fail(ArmFaultKind::kBusDown, 0, 0, 0);
  }
}

void BringUp::fail(ArmFaultKind kind, std::uint8_t node, std::uint32_t object, std::uint32_t code) {
  if (state_ != State::kFailed) {
    state_ = State::kFailed;
    fault_ = {kind, node, object, code};
  }
}

}  // namespace tenon::hw

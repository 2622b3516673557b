#include "hw/arm/setting_runner.h"

#include <algorithm>
#include <array>
#include <utility>

#include "shared/base/bytes.h"
#include "shared/canopen/constants.h"

namespace tenon::hw {
namespace {

using canopen::SdoClient;
using Action = canopen::ObjectSetting::Action;

bool says_absent(std::uint32_t abort_code) {
  return abort_code == tenon::canopen::kAbortNoObject ||
         abort_code == tenon::canopen::kAbortSubIndex;
}

}  // namespace

void SettingRunner::reset(std::vector<SettingNote> notes) {
  notes_ = std::move(notes);
  identities_.clear();
  start({});
}

void SettingRunner::start(std::span<const SettingTask> tasks) {
  tasks_ = tasks;
  sdo_ = SdoClient{};
  state_ = State::kRunning;
  fault_ = {};
  task_ = 0;
  transfer_ = Transfer::kNone;
  comparing_ = false;
}

void SettingRunner::process(const CanFrame& frame, std::int64_t now_ns, CanBus& bus) {
  if (const auto reply = sdo_.process(frame, now_ns)) {
    send(*reply, bus);
  }
}

SettingRunner::State SettingRunner::update(std::int64_t now_ns, CanBus& bus) {
  if (state_ != State::kRunning) {
    return state_;
  }
  if (transfer_ != Transfer::kNone) {
    if (const auto abort = sdo_.update(now_ns)) {
      send(*abort, bus);
    }
    if (sdo_.state() == SdoClient::State::kBusy) {
      return state_;
    }
    finish_transfer(tasks_[task_], now_ns, bus);
  }
  if (state_ == State::kFailed || transfer_ != Transfer::kNone) {
    return state_;
  }
  while (task_ < tasks_.size() && is_spared(tasks_[task_])) {
    next_task();
  }
  if (task_ == tasks_.size()) {
    state_ = State::kDone;
    return state_;
  }
  task_started_ns_ = now_ns;
  refusal_ = 0;
  start_transfer(tasks_[task_], now_ns, bus);
  return state_;
}

void SettingRunner::start_transfer(const SettingTask& task, std::int64_t now_ns, CanBus& bus) {
  switch (task.setting.action) {
    case Action::kWrite:
    case Action::kWriteOrTake:
    case Action::kWriteIfOther:
    case Action::kTry:
      return start_writing(task, now_ns, bus);
    case Action::kCompare:
    case Action::kExpect:
    case Action::kTake:
    case Action::kAwait:
    case Action::kRecord:
      return start_reading(task, now_ns, bus);
  }
}

void SettingRunner::start_writing(const SettingTask& task, std::int64_t now_ns, CanBus& bus) {
  std::array<std::uint8_t, 4> bytes{};
  store_le(std::span<std::uint8_t>(bytes), task.setting.value);
  transfer_ = Transfer::kWriting;
  send(sdo_.start_download({task.node, task.setting.index, task.setting.sub},
                           std::span(bytes).first(task.setting.size_bytes), now_ns),
       bus);
}

void SettingRunner::start_reading(const SettingTask& task, std::int64_t now_ns, CanBus& bus) {
  transfer_ = Transfer::kReading;
  send(sdo_.start_upload({task.node, task.setting.index, task.setting.sub}, now_ns), bus);
}

void SettingRunner::finish_transfer(const SettingTask& task, std::int64_t now_ns, CanBus& bus) {
  switch (sdo_.state()) {
    case SdoClient::State::kTimedOut:
      if (task.setting.action == Action::kRecord) return next_task();
      return fail({ArmFaultKind::kNoAnswer, task.node, task.setting.object(), 0});
    case SdoClient::State::kAborted:
      return finish_refused(task, now_ns, bus);
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

void SettingRunner::finish_refused(const SettingTask& task, std::int64_t now_ns, CanBus& bus) {
  const Action action = task.setting.action;
  const bool absent = task.setting.optional && says_absent(sdo_.abort_code());
  if (action == Action::kCompare) {
    // There is nothing to be written where it does not exist.
    return finish_comparing(absent);
  }
  if (action == Action::kRecord) {
    return next_task();
  }
  if (action == Action::kTry) {
    return give_up(task);
  }
  if (absent) {
    note(SettingNote::Kind::kAbsent, task, 0);
    return next_task();
  }
  if (action == Action::kWriteOrTake && transfer_ == Transfer::kWriting) {
    refusal_ = sdo_.abort_code();
    return start_reading(task, now_ns, bus);
  }
  fail({ArmFaultKind::kConfiguration, task.node, task.setting.object(), sdo_.abort_code(), true});
}

void SettingRunner::finish_reading(const SettingTask& task, std::int64_t now_ns, CanBus& bus) {
  const std::uint32_t found = sdo_.value();
  switch (task.setting.action) {
    case Action::kRecord:
      record(task, found);
      return next_task();
    case Action::kCompare:
      return finish_comparing(task.setting.matches(found));
    case Action::kTake:
      note(SettingNote::Kind::kTaken, task, found);
      return next_task();
    case Action::kWrite:
    case Action::kWriteOrTake:
    case Action::kExpect:
    case Action::kAwait:
    case Action::kWriteIfOther:
    case Action::kTry:
      break;
  }
  if (task.setting.matches(found)) {
    return next_task();
  }
  if (task.setting.action == Action::kTry) {
    return give_up(task);
  }
  if (task.setting.action == Action::kAwait && now_ns - task_started_ns_ < kAwaitTimeout_ns) {
    return start_reading(task, now_ns, bus);
  }
  if (task.setting.action == Action::kWriteOrTake && !task.setting.means_off(found)) {
    note(SettingNote::Kind::kOther, task, found);
    return next_task();
  }
  if (refusal_ != 0) {
    return fail({ArmFaultKind::kConfiguration, task.node, task.setting.object(), refusal_, true});
  }
  const bool sensor = task.setting.index == tenon::canopen::kSensorStatus;
  fail({sensor ? ArmFaultKind::kSensorInvalid : ArmFaultKind::kConfiguration, task.node,
        task.setting.object(), found});
}

void SettingRunner::finish_comparing(bool same) {
  same_ = same && (same_ || !comparing_);
  next_task();
  comparing_ = true;
}

void SettingRunner::give_up(const SettingTask& task) {
  notes_.push_back({SettingNote::Kind::kNoStop, task.node, task.setting.object()});
  next_task();
}

bool SettingRunner::is_spared(const SettingTask& task) const {
  if (task.setting.action == Action::kWriteIfOther) return same_;
  return task.setting.action == Action::kTry &&
         std::any_of(notes_.begin(), notes_.end(), [&](const SettingNote& note) {
           return note.kind == SettingNote::Kind::kNoStop && note.node == task.node;
         });
}

void SettingRunner::next_task() {
  ++task_;
  comparing_ = false;
  transfer_ = Transfer::kNone;
}

void SettingRunner::note(SettingNote::Kind kind, const SettingTask& task, std::uint32_t found) {
  // How many PDOs a device has concerns nobody.
  const std::uint16_t index = task.setting.index;
  if (index >= tenon::canopen::kRpdoCommunication && index < tenon::canopen::kTpdoMapping) return;
  notes_.push_back({kind, task.node, task.setting.object(), found & task.setting.size_mask(),
                    task.setting.value & task.setting.size_mask()});
}

void SettingRunner::record(const SettingTask& task, std::uint32_t value) {
  if (identities_.empty() || identities_.back().node != task.node) {
    identities_.push_back({task.node});
  }
  NodeIdentity& identity = identities_.back();
  if (task.setting.index == tenon::canopen::kDeviceType) {
    identity.device_type = value;
  } else if (task.setting.sub == 1) {
    identity.vendor = value;
  } else {
    identity.product = value;
  }
}

void SettingRunner::send(const CanFrame& frame, CanBus& bus) {
  // A full queue shows as a node that does not answer; only a dead bus is worth naming.
  if (bus.send(frame) == SendResult::kDown) {
    fail({ArmFaultKind::kBusDown, 0, 0, bus.status().failed_bus});
  }
}

void SettingRunner::fail(const ArmFault& fault) {
  if (state_ != State::kFailed) {
    state_ = State::kFailed;
    fault_ = fault;
  }
}

}  // namespace tenon::hw

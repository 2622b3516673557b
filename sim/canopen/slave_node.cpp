#include "sim/canopen/slave_node.h"

#include <algorithm>

namespace tenon::sim {
namespace {

constexpr std::int64_t kNanosecondsPerMillisecond = 1'000'000;
constexpr std::uint16_t kDeviceName = 0x1008;
constexpr std::uint16_t kEmergencyCobId = 0x1014;
constexpr std::uint8_t kRegisterGeneric = 0x01;
constexpr std::uint8_t kRegisterCommunication = 0x10;
constexpr std::uint8_t kRegisterProfile = 0x20;
constexpr std::uint8_t kSdoBytes = 8;

CanFrame frame_of(std::uint32_t id, std::initializer_list<std::uint8_t> data) {
  CanFrame frame;
  frame.id = id;
  frame.length = static_cast<std::uint8_t>(data.size());
  std::copy(data.begin(), data.end(), frame.data.begin());
  return frame;
}

/// Bits of 1001h by the class of the error code (CiA 301, 7.2.7.1).
std::uint8_t register_bits(std::uint16_t code) {
  const bool communication = (code & 0xFF00) == 0x8100 || (code & 0xFF00) == 0x8200;
  return kRegisterGeneric | (communication ? kRegisterCommunication : kRegisterProfile);
}

}  // namespace

SlaveNode::SlaveNode(const Parameters& parameters, NodeApplication& application)
    : node_(parameters.node), application_(application) {
  add_communication_objects(parameters);
  for (const PdoDefaults& defaults : parameters.receive_pdos) {
    const auto number = static_cast<std::uint8_t>(receive_pdos_.size());
    receive_pdos_.emplace_back(dictionary_, number, defaults);
  }
  for (const PdoDefaults& defaults : parameters.transmit_pdos) {
    const auto number = static_cast<std::uint8_t>(transmit_pdos_.size());
    transmit_pdos_.emplace_back(dictionary_, number, defaults);
  }
}

void SlaveNode::add_communication_objects(const Parameters& parameters) {
  using enum DataType;
  using enum Access;
  const auto add = [this](std::uint16_t index, std::uint8_t sub, ObjectEntry entry) {
    dictionary_.add(object_id(index, sub), std::move(entry));
  };
  add(canopen::kDeviceType, 0, {.type = kU32, .value = parameters.device_type});
  add(canopen::kErrorRegister, 0, {.type = kU8, .mappable = Mappable::kTransmit});
  add(canopen::kSyncCobId, 0, {.type = kU32, .value = canopen::kSync});
  add(canopen::kSyncPeriod, 0, {.type = kU32, .access = kReadWrite});
  add(canopen::kSyncWindow, 0, {.type = kU32, .access = kReadWrite});
  add(kDeviceName, 0, {.type = kText, .text = parameters.name});
  add(kEmergencyCobId, 0, {.type = kU32, .value = canopen::kEmergency + node_});
  add(canopen::kHeartbeatConsumer, 0, {.type = kU8, .value = 1});
  add(canopen::kHeartbeatConsumer, 1,
      {.type = kU32, .access = kReadWrite, .high = 0x007FFFFF, .on_write = [this](std::int64_t) {
         watched_seen_ns_.reset();
         return 0U;
       }});
  add(canopen::kHeartbeatProducer, 0,
      {.type = kU16, .access = kReadWrite, .on_write = [this](std::int64_t) {
         next_heartbeat_ns_.reset();
         return 0U;
       }});
  add(canopen::kIdentity, 0, {.type = kU8, .value = 4});
  add(canopen::kIdentity, 1, {.type = kU32});  // no vendor
  add(canopen::kIdentity, 2, {.type = kU32, .value = parameters.product_code});
  add(canopen::kIdentity, 3, {.type = kU32, .value = 0x00010000});
  add(canopen::kIdentity, 4, {.type = kU32, .value = node_});
}

void SlaveNode::power_on(std::int64_t now_ns) { reset(true, now_ns); }

void SlaveNode::reset(bool application_objects, std::int64_t now_ns) {
  dictionary_.reset(0x1000, application_objects ? 0xFFFF : 0x1FFF);
  for (ReceivePdo& pdo : receive_pdos_) pdo.reset();
  sdo_server_.reset();
  errors_.clear();
  watched_seen_ns_.reset();
  next_heartbeat_ns_.reset();
  state_ = NmtState::kInitialising;
  if (application_objects) application_.on_reset(now_ns);
  outbox_.push_back(frame_of(canopen::kHeartbeat + node_, {canopen::kStateBootUp}));
  enter_state(NmtState::kPreOperational);
}

void SlaveNode::enter_state(NmtState next) {
  if (next == state_) return;
  state_ = next;
  for (ReceivePdo& pdo : receive_pdos_) pdo.reset();
  for (TransmitPdo& pdo : transmit_pdos_) pdo.reset();
}

void SlaveNode::receive(const CanFrame& frame, std::int64_t now_ns) {
  if (frame.extended || frame.remote) return;
  if (frame.id == canopen::kNmt) return on_nmt(frame, now_ns);
  if (frame.id == canopen::kSync) return on_sync(now_ns);
  if (frame.id == canopen::kSdoRequest + node_) return on_sdo(frame);
  if (frame.id >> 7 == canopen::kHeartbeat >> 7) return on_heartbeat(frame, now_ns);
  on_pdo(frame);
}

void SlaveNode::on_nmt(const CanFrame& frame, std::int64_t now_ns) {
  if (frame.length != 2 || (frame.data[1] != 0 && frame.data[1] != node_)) return;
  switch (frame.data[0]) {
    case canopen::kNmtStart:
      return enter_state(NmtState::kOperational);
    case canopen::kNmtPreOperational:
      return enter_state(NmtState::kPreOperational);
    case canopen::kNmtStop:
      enter_state(NmtState::kStopped);
      return application_.on_connection_lost();
    case canopen::kNmtResetNode:
      return reset(true, now_ns);
    case canopen::kNmtResetCommunication:
      application_.on_connection_lost();
      return reset(false, now_ns);
    default:  // a command that no standard assigns
      return;
  }
}

void SlaveNode::on_sync(std::int64_t now_ns) {
  if (state_ != NmtState::kOperational) return;
  application_.on_sample();
  for (TransmitPdo& pdo : transmit_pdos_) pdo.on_sync(now_ns, outbox_);
  for (ReceivePdo& pdo : receive_pdos_) pdo.on_sync();
  application_.on_sync();
}

std::uint8_t SlaveNode::watched_node() const {
  return static_cast<std::uint8_t>(
      dictionary_.value(object_id(canopen::kHeartbeatConsumer, 1)) >> 16 & 0x7F);
}

void SlaveNode::on_heartbeat(const CanFrame& frame, std::int64_t now_ns) {
  if (frame.length != 1 || (frame.id & 0x7F) == 0 || (frame.id & 0x7F) != watched_node()) return;
  watched_seen_ns_ = now_ns;
  clear_error(canopen::kEmergencyHeartbeat);
}

void SlaveNode::on_sdo(const CanFrame& frame) {
  if (frame.length != kSdoBytes || state_ == NmtState::kStopped) return;
  const std::optional<SdoServer::Message> answer = sdo_server_.answer(frame.data);
  if (!answer) return;
  CanFrame reply;
  reply.id = canopen::kSdoResponse + node_;
  reply.length = kSdoBytes;
  reply.data = *answer;
  outbox_.push_back(reply);
}

void SlaveNode::on_pdo(const CanFrame& frame) {
  if (state_ != NmtState::kOperational) return;
  for (ReceivePdo& pdo : receive_pdos_) {
    switch (pdo.receive(frame)) {
      case ReceivePdo::Result::kNotMine:
        break;
      case ReceivePdo::Result::kTaken:
        clear_error(canopen::kEmergencyPdoLength);
        break;
      case ReceivePdo::Result::kTooShort:
        raise_error(canopen::kEmergencyPdoLength);
        break;
    }
  }
}

void SlaveNode::advance(std::int64_t now_ns) {
  if (state_ == NmtState::kInitialising) return;
  const std::int64_t period_ns =
      dictionary_.value(object_id(canopen::kHeartbeatProducer)) * kNanosecondsPerMillisecond;
  if (period_ns > 0 && now_ns >= next_heartbeat_ns_.value_or(now_ns)) {
    outbox_.push_back(frame_of(canopen::kHeartbeat + node_, {static_cast<std::uint8_t>(state_)}));
    // Keeps its phase, unless it was held up for more than a period.
    const std::int64_t due_ns = next_heartbeat_ns_.value_or(now_ns);
    next_heartbeat_ns_ = std::max(due_ns, now_ns - period_ns + 1) + period_ns;
  }
  const std::int64_t watch_ns =
      (dictionary_.value(object_id(canopen::kHeartbeatConsumer, 1)) & 0xFFFF) *
      kNanosecondsPerMillisecond;
  if (watched_seen_ns_ && watch_ns > 0 && now_ns - *watched_seen_ns_ > watch_ns) {
    watched_seen_ns_.reset();
    raise_error(canopen::kEmergencyHeartbeat);
    // 1029h is absent: its default, leaving operational.
    if (state_ == NmtState::kOperational) enter_state(NmtState::kPreOperational);
    application_.on_connection_lost();
  }
  if (state_ != NmtState::kOperational) return;
  for (TransmitPdo& pdo : transmit_pdos_) pdo.advance(now_ns, outbox_);
}

void SlaveNode::take(std::vector<CanFrame>& frames) {
  frames.insert(frames.end(), outbox_.begin(), outbox_.end());
  outbox_.clear();
}

void SlaveNode::raise_error(std::uint16_t code) {
  if (std::find(errors_.begin(), errors_.end(), code) != errors_.end()) return;
  errors_.push_back(code);
  send_emergency(code);
}

void SlaveNode::clear_error(std::uint16_t code) {
  if (std::erase(errors_, code) > 0) send_emergency(canopen::kEmergencyReset);
}

void SlaveNode::send_emergency(std::uint16_t code) {
  std::uint8_t error_register = 0;
  for (const std::uint16_t error : errors_) error_register |= register_bits(error);
  dictionary_.set(object_id(canopen::kErrorRegister), error_register);
  if (state_ == NmtState::kInitialising || state_ == NmtState::kStopped) return;
  outbox_.push_back(frame_of(canopen::kEmergency + node_,
                             {static_cast<std::uint8_t>(code), static_cast<std::uint8_t>(code >> 8),
                              error_register, 0, 0, 0, 0, 0}));
}

}  // namespace tenon::sim

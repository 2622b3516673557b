#include "sim/cell/canopen/slave_node.h"

#include <algorithm>

#include "shared/base/time_units.h"

namespace tenon::sim {
namespace {

constexpr std::uint16_t kDeviceName = 0x1008;
constexpr std::uint16_t kHardwareVersion = 0x1009;
constexpr std::uint16_t kSoftwareVersion = 0x100A;
constexpr std::uint16_t kRestore = 0x1011;
constexpr std::uint16_t kErrorBehaviour = 0x1029;
constexpr std::uint16_t kLabel = 0x2000;
constexpr std::size_t kLabelBytesMax = 32;
constexpr std::int64_t kSignatureSave = 0x65766173;  // "save"
constexpr std::int64_t kSignatureLoad = 0x64616F6C;  // "load"
constexpr std::uint32_t kAbortCannotStore = 0x08000020;
constexpr std::int64_t kToPreOperational = 0;  // 1029h
constexpr std::int64_t kToStopped = 2;
constexpr std::uint8_t kSdoBytes = 8;

CanFrame frame_of(std::uint32_t id, std::initializer_list<std::uint8_t> data) {
  CanFrame frame;
  frame.id = id;
  frame.length = static_cast<std::uint8_t>(data.size());
  std::copy(data.begin(), data.end(), frame.data.begin());
  return frame;
}

/// Bits 30 (this node makes the SYNC) and 29 (extended) are refused as out of any identifier.
std::uint32_t check_sync_cob_id(std::int64_t value) {
  return is_restricted_cob_id(static_cast<std::uint32_t>(value)) ? canopen::kAbortValue : 0;
}

}  // namespace

SlaveNode::SlaveNode(const Parameters& parameters, NodeApplication& application)
    : node_(parameters.node), application_(application), errors_(dictionary_, parameters.node) {
  add_identity(parameters);
  add_sync_objects();
  add_heartbeat_objects();
  add_storage_objects();
  for (const PdoDefaults& defaults : parameters.receive_pdos) {
    const auto number = static_cast<std::uint8_t>(receive_pdos_.size());
    receive_pdos_.emplace_back(dictionary_, number, defaults);
  }
  for (const PdoDefaults& defaults : parameters.transmit_pdos) {
    const auto number = static_cast<std::uint8_t>(transmit_pdos_.size());
    transmit_pdos_.emplace_back(dictionary_, number, defaults);
  }
}

void SlaveNode::add_identity(const Parameters& parameters) {
  using enum DataType;
  const auto add = [this](std::uint16_t index, std::uint8_t sub, ObjectEntry entry) {
    dictionary_.add(object_id(index, sub), std::move(entry));
  };
  add(canopen::kDeviceType, 0,
      {.name = "Device type", .type = kU32, .value = parameters.device_type});
  add(kDeviceName, 0, {.name = "Manufacturer device name", .type = kText, .text = parameters.name});
  add(kHardwareVersion, 0,
      {.name = "Manufacturer hardware version", .type = kText, .text = "virtual"});
  add(kSoftwareVersion, 0, {.name = "Manufacturer software version", .type = kText, .text = "1.0"});
  dictionary_.describe(canopen::kIdentity, {"Identity object", Structure::kRecord});
  add(canopen::kIdentity, 0, {.name = "Highest sub-index supported", .value = 4});
  add(canopen::kIdentity, 1, {.name = "Vendor-ID", .type = kU32});  // no vendor
  add(canopen::kIdentity, 2,
      {.name = "Product code", .type = kU32, .value = parameters.product_code});
  add(canopen::kIdentity, 3, {.name = "Revision number", .type = kU32, .value = 0x00010000});
  add(canopen::kIdentity, 4,
      {.name = "Serial number", .type = kU32, .value = node_, .contains_node = true});
  add(kLabel, 0,
      {.name = "Label",
       .type = kText,
       .access = Access::kReadWrite,
       .text_bytes_max = kLabelBytesMax});
}

void SlaveNode::add_sync_objects() {
  using enum DataType;
  constexpr Access kReadWrite = Access::kReadWrite;
  const auto add = [this](std::uint16_t index, ObjectEntry entry) {
    return &dictionary_.add(object_id(index), std::move(entry));
  };
  sync_cob_id_ = add(canopen::kSyncCobId, {.name = "COB-ID SYNC",
                                           .type = kU32,
                                           .access = kReadWrite,
                                           .value = canopen::kSync,
                                           .on_write = check_sync_cob_id});
  sync_period_ = add(canopen::kSyncPeriod,
                     {.name = "Communication cycle period", .type = kU32, .access = kReadWrite});
  sync_window_ = add(canopen::kSyncWindow,
                     {.name = "Synchronous window length", .type = kU32, .access = kReadWrite});
  sync_overflow_ = add(canopen::kSyncOverflow,
                       {.name = "Synchronous counter overflow value",
                        .type = kU8,
                        .access = kReadWrite,
                        .high = 240,
                        .on_write = [this](std::int64_t value) {
                          if (value == 1) return canopen::kAbortValue;
                          return sync_period_->value != 0 ? canopen::kAbortDeviceState : 0;
                        }});
}

void SlaveNode::add_heartbeat_objects() {
  using enum DataType;
  constexpr Access kReadWrite = Access::kReadWrite;
  const auto add = [this](std::uint16_t index, std::uint8_t sub, ObjectEntry entry) {
    return &dictionary_.add(object_id(index, sub), std::move(entry));
  };
  dictionary_.describe(canopen::kHeartbeatConsumer, {"Consumer heartbeat time", Structure::kArray});
  add(canopen::kHeartbeatConsumer, 0, {.name = "Highest sub-index supported", .value = 1});
  watched_ = add(canopen::kHeartbeatConsumer, 1,
                 {.name = "Consumer heartbeat time 1",
                  .type = kU32,
                  .access = kReadWrite,
                  .high = 0x007FFFFF,
                  .on_write = [this](std::int64_t) {
                    watched_seen_ns_.reset();
                    return 0U;
                  }});
  heartbeat_period_ = add(canopen::kHeartbeatProducer, 0,
                          {.name = "Producer heartbeat time",
                           .type = kU16,
                           .access = kReadWrite,
                           .on_write = [this](std::int64_t) {
                             next_heartbeat_ns_.reset();
                             return 0U;
                           }});
  dictionary_.describe(kErrorBehaviour, {"Error behaviour", Structure::kArray});
  add(kErrorBehaviour, 0, {.name = "Highest sub-index supported", .value = 1});
  communication_error_ =
      add(kErrorBehaviour, 1,
          {.name = "Communication error", .type = kU8, .access = kReadWrite, .high = kToStopped});
}

void SlaveNode::add_storage_objects() {
  const auto add = [this](std::uint16_t index, const char* name, const char* entry_name,
                          std::int64_t signature, void (ObjectDictionary::*act)()) {
    dictionary_.describe(index, {name, Structure::kArray});
    dictionary_.add(object_id(index), {.name = "Highest sub-index supported", .value = 1});
    dictionary_.add(object_id(index, 1), {.name = entry_name,
                                          .type = DataType::kU32,
                                          .access = Access::kReadWrite,
                                          .value = 1,  // on command
                                          .is_command = true,
                                          .on_write = [this, signature, act](std::int64_t value) {
                                            if (value != signature) return kAbortCannotStore;
                                            if (!application_.may_store()) {
                                              return canopen::kAbortDeviceState;
                                            }
                                            (dictionary_.*act)();
                                            return 0U;
                                          }});
  };
  add(canopen::kStoreParameters, "Store parameters", "Save all parameters", kSignatureSave,
      &ObjectDictionary::store_settings);
  add(kRestore, "Restore default parameters", "Restore all default parameters", kSignatureLoad,
      &ObjectDictionary::restore_defaults);
}

void SlaveNode::power_on(std::int64_t now_ns) { reset(true, now_ns); }

void SlaveNode::reset(bool application_objects, std::int64_t now_ns) {
  dictionary_.reset(0x1000, application_objects ? 0xFFFF : 0x1FFF);
  errors_.reset(application_objects);
  sdo_server_.reset();
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
  sdo_server_.reset();
  for (ReceivePdo& pdo : receive_pdos_) pdo.reset();
  for (TransmitPdo& pdo : transmit_pdos_) pdo.reset();
}

void SlaveNode::receive(const CanFrame& frame, std::int64_t now_ns) {
  if (silent_ || frame.extended) return;
  if (frame.remote) return on_remote(frame, now_ns);
  if (frame.id == canopen::kNmt) return on_nmt(frame, now_ns);
  if (frame.id == static_cast<std::uint32_t>(sync_cob_id_->value)) return on_sync(frame, now_ns);
  if (frame.id == canopen::kSdoRequest + node_) return on_sdo(frame);
  if (frame.id >> 7 == canopen::kHeartbeat >> 7) return on_heartbeat(frame, now_ns);
  on_pdo(frame, now_ns);
}

void SlaveNode::on_remote(const CanFrame& frame, std::int64_t now_ns) {
  if (state_ != NmtState::kOperational) return;
  for (TransmitPdo& pdo : transmit_pdos_) pdo.on_remote(frame.id, now_ns, outbox_);
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

void SlaveNode::on_sync(const CanFrame& frame, std::int64_t now_ns) {
  if (state_ != NmtState::kOperational) return;
  const bool counted = sync_overflow_->value != 0;
  const bool good = frame.length == (counted ? 1 : 0);
  set_error(!good, canopen::kEmergencySyncLength);
  if (!good) return;
  sync_ns_ = now_ns;
  application_.on_sample();
  const std::uint8_t counter = counted ? frame.data[0] : 0;
  for (TransmitPdo& pdo : transmit_pdos_) pdo.on_sync(counter, now_ns, outbox_);
  for (ReceivePdo& pdo : receive_pdos_) pdo.on_sync();
  application_.on_sync();
}

std::uint8_t SlaveNode::watched_node() const {
  return static_cast<std::uint8_t>(watched_->value >> 16 & 0x7F);
}

void SlaveNode::on_heartbeat(const CanFrame& frame, std::int64_t now_ns) {
  if (frame.length != 1 || (frame.id & 0x7F) == 0 || (frame.id & 0x7F) != watched_node()) return;
  watched_seen_ns_ = now_ns;
  clear_error(canopen::kEmergencyHeartbeat, ErrorSource::kCommunication);
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

bool SlaveNode::outside_sync_window(std::int64_t now_ns) const {
  const std::int64_t window_ns = sync_window_->value * kNanosecondsPerMicrosecond;
  return window_ns > 0 && now_ns - sync_ns_ > window_ns;
}

void SlaveNode::on_pdo(const CanFrame& frame, std::int64_t now_ns) {
  if (state_ != NmtState::kOperational) return;
  bool mine = false;
  for (ReceivePdo& pdo : receive_pdos_) {
    if (pdo.synchronous() && outside_sync_window(now_ns)) continue;
    mine = pdo.receive(frame, now_ns) != ReceivePdo::Result::kNotMine || mine;
  }
  if (!mine) return;
  set_error(std::any_of(receive_pdos_.begin(), receive_pdos_.end(),
                        [](const ReceivePdo& pdo) { return pdo.too_short(); }),
            canopen::kEmergencyPdoLength);
}

void SlaveNode::advance(std::int64_t now_ns) {
  if (state_ == NmtState::kInitialising) return;
  produce_heartbeat(now_ns);
  watch_heartbeat(now_ns);
  if (state_ != NmtState::kOperational) return;
  watch_receive_pdos(now_ns);
  for (TransmitPdo& pdo : transmit_pdos_) pdo.advance(now_ns, outbox_);
}

void SlaveNode::produce_heartbeat(std::int64_t now_ns) {
  const std::int64_t period_ns = heartbeat_period_->value * kNanosecondsPerMillisecond;
  if (period_ns == 0 || now_ns < next_heartbeat_ns_.value_or(now_ns)) return;
  outbox_.push_back(frame_of(canopen::kHeartbeat + node_, {static_cast<std::uint8_t>(state_)}));
  // Keeps its phase, unless it was held up for more than a period.
  const std::int64_t due_ns = next_heartbeat_ns_.value_or(now_ns);
  next_heartbeat_ns_ = std::max(due_ns, now_ns - period_ns + 1) + period_ns;
}

void SlaveNode::watch_heartbeat(std::int64_t now_ns) {
  const std::int64_t watch_ns = (watched_->value & 0xFFFF) * kNanosecondsPerMillisecond;
  if (!watched_seen_ns_ || watch_ns == 0 || now_ns - *watched_seen_ns_ <= watch_ns) return;
  watched_seen_ns_.reset();
  raise_error(canopen::kEmergencyHeartbeat, ErrorSource::kCommunication);
  const std::int64_t behaviour = communication_error_->value;
  if (behaviour == kToPreOperational && state_ == NmtState::kOperational) {
    enter_state(NmtState::kPreOperational);
  }
  if (behaviour == kToStopped) enter_state(NmtState::kStopped);
  application_.on_connection_lost();
}

void SlaveNode::watch_receive_pdos(std::int64_t now_ns) {
  bool overdue = false;
  bool news = false;
  for (ReceivePdo& pdo : receive_pdos_) {
    const bool before = pdo.overdue();
    pdo.advance(now_ns);
    overdue = overdue || pdo.overdue();
    news = news || (pdo.overdue() && !before);
  }
  set_error(overdue, canopen::kEmergencyRpdoTimeout);
  if (news) application_.on_connection_lost();
}

void SlaveNode::take(std::vector<CanFrame>& frames) {
  if (!silent_) frames.insert(frames.end(), outbox_.begin(), outbox_.end());
  outbox_.clear();
}

void SlaveNode::set_error(bool present, std::uint16_t code) {
  if (present) {
    raise_error(code, ErrorSource::kCommunication);
  } else {
    clear_error(code, ErrorSource::kCommunication);
  }
}

void SlaveNode::raise_error(std::uint16_t code, ErrorSource source) {
  send(errors_.raise(code, source));
}

void SlaveNode::clear_error(std::uint16_t code, ErrorSource source) {
  send(errors_.clear(code, source));
}

void SlaveNode::send(const std::optional<CanFrame>& emergency) {
  if (!emergency || state_ == NmtState::kInitialising || state_ == NmtState::kStopped) return;
  outbox_.push_back(*emergency);
}

}  // namespace tenon::sim

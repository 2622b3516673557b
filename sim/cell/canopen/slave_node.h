#pragma once
// A CANopen slave (CiA 301): NMT state machine, boot-up and heartbeat, heartbeat consumer, SDO
// server, SYNC with its counter and window, four PDOs each way with their deadlines, emergencies,
// stored settings. What the device is about, its application adds. Node guarding, the time stamp,
// and SDO block transfer it does not have.
//
//            power_on, reset                  Start
//   Initialising ──boot-up──> PreOperational <────────> Operational
//                                    └────────> Stopped <────┘
//
// No I/O, no clock: frames and time come in, frames leave through take(). One thread.

#include <array>
#include <cstdint>
#include <deque>
#include <optional>
#include <string>
#include <vector>

#include "shared/canopen/constants.h"
#include "shared/ports/can_bus.h"
#include "sim/cell/canopen/error_log.h"
#include "sim/cell/canopen/object_dictionary.h"
#include "sim/cell/canopen/receive_pdo.h"
#include "sim/cell/canopen/sdo_server.h"
#include "sim/cell/canopen/transmit_pdo.h"

namespace tenon::sim {

enum class NmtState : std::uint8_t {
  kInitialising = canopen::kStateBootUp,
  kStopped = canopen::kStateStopped,
  kOperational = canopen::kStateOperational,
  kPreOperational = canopen::kStatePreOperational,
};

/// The device behind the node. Called from within the node's own functions.
class NodeApplication {
 public:
  NodeApplication() = default;
  NodeApplication(const NodeApplication&) = delete;
  NodeApplication& operator=(const NodeApplication&) = delete;
  virtual ~NodeApplication() = default;

  /// Power-on or an NMT reset; the dictionary is back at its defaults.
  virtual void on_reset(std::int64_t now_ns) = 0;
  /// Operational: the inputs that this SYNC's PDOs will carry are taken now.
  virtual void on_sample() = 0;
  /// Operational: what the PDOs brought is in the dictionary and acts from this SYNC on.
  virtual void on_sync() = 0;
  /// A watched heartbeat or RPDO is gone, or NMT stopped the node (CiA 402, object 6007h).
  virtual void on_connection_lost() = 0;
  /// Whether settings may be stored or restored now (1010h, 1011h).
  [[nodiscard]] virtual bool may_store() const { return true; }
};

class SlaveNode {
 public:
  struct Parameters {
    std::uint8_t node = 1;
    std::uint32_t device_type = 0;
    std::uint32_t product_code = 0;
    std::string name;  ///< 1008h
    std::vector<PdoDefaults> receive_pdos;
    std::vector<PdoDefaults> transmit_pdos;
  };

  /// @param application must outlive the node, and adds its objects to dictionary() before
  /// power_on()
  SlaveNode(const Parameters& parameters, NodeApplication& application);

  void power_on(std::int64_t now_ns);
  void receive(const CanFrame& frame, std::int64_t now_ns);
  /// Timers.
  void advance(std::int64_t now_ns);
  /// Moves what is to be sent to the end of `frames`.
  void take(std::vector<CanFrame>& frames);

  /// Emergencies: an error stays in 1001h until cleared; raising it twice says it once.
  void raise_error(std::uint16_t code, ErrorSource source = ErrorSource::kDevice);
  void clear_error(std::uint16_t code, ErrorSource source = ErrorSource::kDevice);

  /// A fault to inject: while silent it neither sends nor receives.
  void set_silent(bool silent) { silent_ = silent; }
  /// A fault to inject: that PDO's next frame carries the data of the one before. From 0.
  void repeat_transmit_pdo(std::size_t number) { transmit_pdos_.at(number).repeat_once(); }

  [[nodiscard]] ObjectDictionary& dictionary() { return dictionary_; }
  [[nodiscard]] const ObjectDictionary& dictionary() const { return dictionary_; }
  [[nodiscard]] NmtState state() const { return state_; }
  [[nodiscard]] std::uint8_t node() const { return node_; }

 private:
  void add_identity(const Parameters& parameters);
  void add_sync_objects();
  void add_heartbeat_objects();
  void add_storage_objects();
  void reset(bool application_objects, std::int64_t now_ns);
  void enter_state(NmtState next);
  void on_remote(const CanFrame& frame, std::int64_t now_ns);
  void on_nmt(const CanFrame& frame, std::int64_t now_ns);
  void on_sync(const CanFrame& frame, std::int64_t now_ns);
  void on_heartbeat(const CanFrame& frame, std::int64_t now_ns);
  void on_sdo(const CanFrame& frame);
  void on_pdo(const CanFrame& frame, std::int64_t now_ns);
  void produce_heartbeat(std::int64_t now_ns);
  void watch_heartbeat(std::int64_t now_ns);
  void watch_receive_pdos(std::int64_t now_ns);
  void set_error(bool present, std::uint16_t code);
  void send(const std::optional<CanFrame>& emergency);
  [[nodiscard]] std::uint8_t watched_node() const;
  [[nodiscard]] bool outside_sync_window(std::int64_t now_ns) const;

  std::uint8_t node_;
  NodeApplication& application_;
  ObjectDictionary dictionary_;
  ErrorLog errors_;
  SdoServer sdo_server_{dictionary_};
  std::deque<ReceivePdo> receive_pdos_;
  std::deque<TransmitPdo> transmit_pdos_;
  std::vector<CanFrame> outbox_;
  NmtState state_ = NmtState::kInitialising;
  bool silent_ = false;
  std::optional<std::int64_t> next_heartbeat_ns_;  ///< unset: at once
  std::optional<std::int64_t> watched_seen_ns_;    ///< last heartbeat of the watched node
  std::int64_t sync_ns_ = 0;                       ///< the last one
  // Into the dictionary, set by the constructor.
  ObjectEntry* sync_cob_id_ = nullptr;
  ObjectEntry* sync_period_ = nullptr;
  ObjectEntry* sync_window_ = nullptr;
  ObjectEntry* sync_overflow_ = nullptr;
  ObjectEntry* watched_ = nullptr;
  ObjectEntry* heartbeat_period_ = nullptr;
  ObjectEntry* communication_error_ = nullptr;
};

}  // namespace tenon::sim

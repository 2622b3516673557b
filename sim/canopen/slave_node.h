#pragma once
// A CANopen slave (CiA 301): NMT state machine, boot-up and heartbeat, heartbeat consumer, SDO
// server, four PDOs each way, emergencies. What the device is about, its application adds.
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
#include "sim/canopen/object_dictionary.h"
#include "sim/canopen/receive_pdo.h"
#include "sim/canopen/sdo_server.h"
#include "sim/canopen/transmit_pdo.h"

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
  /// The watched heartbeat is gone, or NMT stopped the node (CiA 402, object 6007h).
  virtual void on_connection_lost() = 0;
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
  void raise_error(std::uint16_t code);
  void clear_error(std::uint16_t code);

  [[nodiscard]] ObjectDictionary& dictionary() { return dictionary_; }
  [[nodiscard]] const ObjectDictionary& dictionary() const { return dictionary_; }
  [[nodiscard]] NmtState state() const { return state_; }
  [[nodiscard]] std::uint8_t node() const { return node_; }

 private:
  void add_communication_objects(const Parameters& parameters);
  void reset(bool application_objects, std::int64_t now_ns);
  void enter_state(NmtState next);
  void on_nmt(const CanFrame& frame, std::int64_t now_ns);
  void on_sync(std::int64_t now_ns);
  void on_heartbeat(const CanFrame& frame, std::int64_t now_ns);
  void on_sdo(const CanFrame& frame);
  void on_pdo(const CanFrame& frame);
  void send_emergency(std::uint16_t code);
  [[nodiscard]] std::uint8_t watched_node() const;

  std::uint8_t node_;
  NodeApplication& application_;
  ObjectDictionary dictionary_;
  SdoServer sdo_server_{dictionary_};
  std::deque<ReceivePdo> receive_pdos_;
  std::deque<TransmitPdo> transmit_pdos_;
  std::vector<CanFrame> outbox_;
  std::vector<std::uint16_t> errors_;
  NmtState state_ = NmtState::kInitialising;
  std::optional<std::int64_t> next_heartbeat_ns_;  ///< unset: at once
  std::optional<std::int64_t> watched_seen_ns_;    ///< last heartbeat of the watched node
};

}  // namespace tenon::sim

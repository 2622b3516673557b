#pragma once
// Brings the nodes of an arm from anywhere to operational, configured. A state machine with time
// and frames as arguments; what it sends leaves by the bus. Not real-time (built on vectors), one
// thread.
//
//   kListen ---- no foreign SYNC or heartbeat of the master's node -> kBootUp
//                (for a heartbeat timeout: to reset an arm that another master moves would stop it)
//   kBootUp ---- NMT reset communication, 700h + n: 00 from all ----> kAnnounce
//                (who is late is reset once more at half time)
//   kAnnounce -- NMT pre-operational, 1017h by SDO -----------------> kPreOperational
//   kPreOperational -- heartbeat 7Fh from every node ---------------> kConfigure
//   kConfigure - identity read; every setting written, read back ---> kStart
//   kStart ----- NMT start to every node ---------------------------> kOperational
//   kOperational -- heartbeat 05 from every node -------------------> kDone
//   any: silence, refusal, another value ---------------------------> kFailed, see fault()

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "hw/arm/other_master.h"
#include "hw/canopen/heartbeat_watch.h"
#include "hw/canopen/object_setting.h"
#include "hw/canopen/sdo_client.h"
#include "shared/cell/robot.h"
#include "shared/ports/arm.h"
#include "shared/ports/can_bus.h"

namespace tenon::hw {

class BringUp {
 public:
  enum class State : std::uint8_t {
    kListen,
    kBootUp,
    kAnnounce,
    kPreOperational,
    kConfigure,
    kStart,
    kOperational,
    kDone,
    kFailed,
  };
  /// 1018h as read from a node; all 0 where the node has no such object.
  struct Identity {
    std::uint8_t node = 0;
    std::uint32_t device_type = 0;
    std::uint32_t vendor = 0;
    std::uint32_t product = 0;
  };
  static constexpr std::int64_t kBootUpTimeout_ns = 1'000'000'000;
  static constexpr std::int64_t kStateTimeout_ns = 1'000'000'000;
  static constexpr std::int64_t kAwaitTimeout_ns = 500'000'000;

  /// @param robot must pass check_robot()
  explicit BringUp(const Robot& robot);

  /// Starts over.
  void restart();
  /// Takes in a frame.
  void process(const CanFrame& frame, std::int64_t now_ns, CanBus& bus);
  /// Goes on as far as it can. The first call after restart() starts listening.
  void update(std::int64_t now_ns, CanBus& bus);

  [[nodiscard]] State state() const { return state_; }
  [[nodiscard]] ArmFault fault() const { return fault_; }
  [[nodiscard]] const std::vector<Identity>& identities() const { return identities_; }

 private:
  struct Task {
    std::uint8_t node = 0;
    canopen::ObjectSetting setting;
  };
  enum class Transfer : std::uint8_t { kNone, kWriting, kReading };

  void enter_state(State state, std::int64_t now_ns, CanBus& bus);
  void await_all(std::uint8_t nmt_state, std::int64_t timeout_ns, State next, std::int64_t now_ns,
                 CanBus& bus);
  void run_tasks(State next, std::int64_t now_ns, CanBus& bus);
  void start_writing(const Task& task, std::int64_t now_ns, CanBus& bus);
  void start_reading(const Task& task, std::int64_t now_ns, CanBus& bus);
  void finish_transfer(const Task& task, std::int64_t now_ns, CanBus& bus);
  void finish_reading(const Task& task, std::int64_t now_ns, CanBus& bus);
  void finish_comparing(bool same);
  void next_task();
  void record(const Task& task, std::uint32_t value);
  void command_all(std::uint8_t command, CanBus& bus);
  void send(const CanFrame& frame, CanBus& bus);
  void fail(ArmFaultKind kind, std::uint8_t node, std::uint32_t object, std::uint32_t code);

  std::vector<std::uint8_t> nodes_;
  std::vector<Task> announce_;
  std::vector<Task> configure_;
  std::vector<Identity> identities_;
  canopen::HeartbeatWatch watch_;
  canopen::SdoClient sdo_;

  const OtherMaster other_master_;
  const std::int64_t listen_ns_;

  State state_ = State::kListen;
  ArmFault fault_;
  std::optional<std::int64_t> entered_ns_;  ///< unset: kListen has not begun
  bool reset_again_ = false;
  std::size_t task_ = 0;  ///< within the list of the state
  Transfer transfer_ = Transfer::kNone;
  bool comparing_ = false;  ///< the task before this one was a comparison
  bool same_ = false;       ///< what was compared last is as wanted
  std::int64_t task_started_ns_ = 0;
};

}  // namespace tenon::hw

#pragma once
// Brings the nodes of an arm from anywhere to operational, configured. A state machine with time
// and frames as arguments; what it sends leaves by the bus. Not real-time (built on vectors), one
// thread.
//
//   kListen ---- no foreign SYNC or heartbeat of the master's node -> kBootUp
//                (for a heartbeat timeout: to reset an arm that another master moves would stop it)
//   kBootUp ---- NMT reset communication, 700h + n: 00 from all ----> kCensus
//                (who has not booted within its drive's boot time is reset once more)
//   kCensus ---- every node asked for 1000h, none answers twice ----> kAnnounce
//   kAnnounce -- NMT pre-operational, 1017h by SDO -----------------> kPreOperational
//   kPreOperational -- heartbeat 7Fh from every node ---------------> kConfigure
//   kConfigure - identity read; every setting written, read back ---> kStart
//   kStart ----- NMT start to every node ---------------------------> kOperational
//   kOperational -- heartbeat 05 from every node -------------------> kDone
//   any: silence, refusal, another value ---------------------------> kFailed, see fault()

#include <cstdint>
#include <optional>
#include <vector>

#include "hw/arm/other_master.h"
#include "hw/arm/setting_runner.h"
#include "hw/canopen/heartbeat_watch.h"
#include "shared/cell/robot.h"
#include "shared/ports/arm.h"
#include "shared/ports/can_bus.h"

namespace tenon::hw {

class BringUp {
 public:
  enum class State : std::uint8_t {
    kListen,
    kBootUp,
    kCensus,
    kAnnounce,
    kPreOperational,
    kConfigure,
    kStart,
    kOperational,
    kDone,
    kFailed,
  };
  static constexpr std::int64_t kStateTimeout_ns = 1'000'000'000;
  static constexpr std::int64_t kCensus_ns = 50'000'000;

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
  [[nodiscard]] const std::vector<NodeIdentity>& identities() const { return runner_.identities(); }
  /// What the devices lack or made of what was asked; describe() has the lines for people.
  [[nodiscard]] const std::vector<SettingNote>& notes() const { return runner_.notes(); }

 private:
  struct Node {
    std::uint8_t id = 0;
    std::int64_t boot_ns = 0;
    bool reset_again = false;
    int answers = 0;  ///< to the census
  };

  void enter_state(State state, std::int64_t now_ns, CanBus& bus);
  void await_boot_up(std::int64_t now_ns, CanBus& bus);
  void count_answer(const CanFrame& frame);
  void judge_census(std::int64_t now_ns, CanBus& bus);
  void await_all(std::uint8_t nmt_state, State next, std::int64_t now_ns, CanBus& bus);
  void run_settings(State next, std::int64_t now_ns, CanBus& bus);
  void command_all(std::uint8_t command, CanBus& bus);
  void send(const CanFrame& frame, CanBus& bus);
  void fail(const ArmFault& fault);

  std::vector<Node> nodes_;
  std::vector<SettingTask> announce_;
  std::vector<SettingTask> configure_;
  std::vector<SettingNote> known_;  ///< before any node is asked
  canopen::HeartbeatWatch watch_;
  SettingRunner runner_;

  const OtherMaster other_master_;
  const std::int64_t listen_ns_;

  State state_ = State::kListen;
  ArmFault fault_;
  std::optional<std::int64_t> entered_ns_;  ///< unset: kListen has not begun
};

}  // namespace tenon::hw

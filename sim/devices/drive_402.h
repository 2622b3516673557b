#pragma once
// A servo drive's firmware: CiA 402 state machine, cyclic synchronous position (mode 8) or
// interpolated position (mode 7), quick stop, holding brake, following error, loss of the master's
// heartbeat.
//
//   NotReady ─> SwitchOnDisabled <─> ReadyToSwitchOn <─> SwitchedOn <─> OperationEnabled
//                    ^    ^ ^                                              │       ^
//                    │    │ └──────────── QuickStopActive <── quick stop ──┘       │
//                    │    │                      └──────────── enable operation ───┘
//                 reset   └─ disable voltage from anywhere above
//                  Fault <── FaultReaction <── error in any state
//
// A ramp down (quick stop, disabling, fault reaction, lost master) starts from the demand's own
// velocity. The brake holds whenever no demand is followed. What turns the axis, and how far it
// really got, is the plant's: it reads demand() and writes measured(). One thread; time is an
// argument.

#include <cstdint>
#include <optional>
#include <string>

#include "sim/canopen/slave_node.h"

namespace tenon::sim {

class Drive402 final : private NodeApplication {
 public:
  enum class State : std::uint8_t {
    kNotReady,
    kSwitchOnDisabled,
    kReadyToSwitchOn,
    kSwitchedOn,
    kOperationEnabled,
    kQuickStopActive,
    kFaultReaction,
    kFault,
  };

  struct Parameters {
    std::uint8_t node = 1;
    std::string name = "tenon virtual drive";
    std::int8_t mode = canopen::kModeCyclicSynchronousPosition;  ///< the one that it supports
    std::uint32_t quick_stop_counts_ps2 = 5'000'000;             ///< default of 6085h
  };

  /// What the servo is to do, in counts.
  struct Demand {
    bool brake = true;  ///< engaged; the rest means nothing
    double position_counts = 0.0;
    double velocity_countsps = 0.0;
  };

  struct Measurement {
    double position_counts = 0.0;
    double velocity_countsps = 0.0;
    double torque_permille = 0.0;  ///< of rated
  };

  explicit Drive402(const Parameters& parameters);

  [[nodiscard]] SlaveNode& node() { return node_; }
  [[nodiscard]] const SlaveNode& node() const { return node_; }

  /// Timers of node and drive.
  void advance(std::int64_t now_ns);

  /// The demand at the end of the next `step_ns`, in which the plant then moves.
  [[nodiscard]] Demand demand(std::int64_t step_ns);
  /// The plant after that step.
  void measured(const Measurement& measurement, std::int64_t step_ns);

  [[nodiscard]] State state() const { return state_; }
  [[nodiscard]] bool brake_engaged() const { return motion_ == Motion::kBraked; }
  [[nodiscard]] std::uint16_t error_code() const;

 private:
  enum class Motion : std::uint8_t { kBraked, kFollowing, kRamping, kHolding };
  enum class Command : std::uint8_t {
    kDisableVoltage,
    kQuickStop,
    kShutdown,
    kSwitchOn,
    kEnableOperation,
  };

  void on_reset(std::int64_t now_ns) override;
  void on_sample() override;
  void on_sync() override;
  void on_connection_lost() override;

  void add_control_objects();
  void add_motion_objects(const Parameters& parameters);
  void on_controlword(std::uint16_t word);
  void process_command(Command command);
  [[nodiscard]] static Command decode(std::uint16_t word);
  void enter_state(State next);
  void fault(std::uint16_t code);
  void quick_stop();
  /// Ramps down and enters `next` at standstill, or holds there where nothing is next.
  void ramp_down(std::uint16_t deceleration_object, std::optional<State> next);
  void follow_from_standstill();
  void watch_following_error(std::int64_t step_ns);
  void update_statusword();
  [[nodiscard]] bool interpolating() const;
  [[nodiscard]] std::int64_t option(std::uint16_t index) const;
  [[nodiscard]] std::int64_t interpolation_period_ns() const;

  std::int8_t supported_mode_;
  SlaveNode node_;
  State state_ = State::kNotReady;
  Motion motion_ = Motion::kBraked;
  std::int64_t ready_ns_ = 0;
  std::uint16_t last_controlword_ = 0;
  std::optional<State> after_standstill_;
  double deceleration_countsps2_ = 0.0;
  Measurement measurement_;
  // The demand runs along a segment from one target to the next, one SYNC period long.
  double position_counts_ = 0.0;
  double velocity_countsps_ = 0.0;
  double segment_start_counts_ = 0.0;
  double segment_end_counts_ = 0.0;
  std::int64_t segment_elapsed_ns_ = 0;
  std::int64_t segment_period_ns_ = 0;
  std::int64_t outside_window_ns_ = 0;
};

[[nodiscard]] const char* to_string(Drive402::State state);

}  // namespace tenon::sim

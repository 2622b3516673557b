#pragma once
// One table of all that ends a run: who notices it, within how many cycles, how the arm then comes
// to rest, and in which state it is left. The executor takes names and reactions from here;
// README.md's table is compared with it, and tests hold the bounds against what happens. Plain
// data, any thread, real-time.

#include <bitset>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>

#include "executor/faults/end_reason.h"
#include "shared/cell/robot.h"
#include "shared/ports/arm.h"

namespace tenon::executor {

/// How long a fault may last before it is noticed, counted from where `since` of its row says.
struct FaultBound {
  int cycles = 0;             ///< 0, and nothing else: it is no fault, or not bounded by time
  int samples = 0;            ///< periods of the force/torque sensor, besides
  double time_s = 0.0;        ///< besides
  int heartbeat_periods = 0;  ///< of the robot file, besides
  int heartbeat_timeouts = 0;
};

/// What the arm is left in once the run is over.
enum class EndState : std::uint8_t {
  kOff = 0,          ///< brakes on, power off
  kOffByDrives = 1,  ///< the same, but by the drives themselves, once the heartbeat is missed
  kBrakeSlips = 2,  ///< a brake that is on does not hold; power as the cell's on_brake_failure says
  kUnknown = 3,     ///< a drive has not said that it is off
};

struct FaultRow {
  EndReason reason = EndReason::kNone;
  ArmFaultKind arm_fault = ArmFaultKind::kNone;  ///< of EndReason::kArmFault, one row each
  const char* name = "";                         ///< of the reason
  const char* arm_fault_name = "";               ///< of the arm's fault
  const char* detector = "";                     ///< what notices it
  FaultBound bound{};
  const char* since = "";  ///< what the bound counts from; empty: it has none
  EndManner reaction = EndManner::kHold;
  EndState end_state = EndState::kOff;
};

/// All rows, by reason and arm fault.
[[nodiscard]] std::span<const FaultRow> fault_table();
/// Null for EndReason::kNone, and what the table does not know.
[[nodiscard]] const FaultRow* fault_row(EndReason reason,
                                        ArmFaultKind arm_fault = ArmFaultKind::kNone);

/// In control cycles of a robot, rounded up; unset: not bounded.
[[nodiscard]] std::optional<std::int64_t> bound_cycles(const FaultRow& row, const Robot& robot);

// For people. Allocate.
/// "force_fault", "arm_fault: bus_off"
[[nodiscard]] std::string full_name(const FaultRow& row);
/// "2 cycles", "0.05 s and 2 cycles"; empty: not bounded
[[nodiscard]] std::string to_string(const FaultBound& bound);
[[nodiscard]] const char* to_string(EndManner manner);
[[nodiscard]] const char* to_string(EndState state);

/// Rows that are not acted on. For tests alone: they show that a fault loses its name when its
/// detector is gone.
class FaultMask {
 public:
  /// @throws nothing; a row that the table does not know changes nothing
  void mask(EndReason reason, ArmFaultKind arm_fault = ArmFaultKind::kNone);
  [[nodiscard]] bool masks(EndReason reason, ArmFaultKind arm_fault) const;

 private:
  static constexpr std::size_t kRowsMost = 64;
  std::bitset<kRowsMost> rows_;
};

}  // namespace tenon::executor

#pragma once
// Why a run ended, as plain data for the real-time code and as a line for people.

#include <cstdint>
#include <string>

#include "shared/cell/cell.h"
#include "shared/plan/plan.h"
#include "shared/plan/transition.h"
#include "shared/ports/arm.h"

namespace tenon::executor {

/// The numbers stand in telemetry.
enum class EndReason : std::uint8_t {
  kNone = 0,
  kPlanDone = 1,
  kPlanFailed = 2,         ///< index: step; transition says why
  kStopRequested = 3,      ///< by the user
  kNotAtStart = 4,         ///< value: distance in m, bound
  kTareUnsteady = 5,       ///< index: wrench axis; value: deviation, bound
  kTareMoving = 6,         ///< index: joint; value: motion while taring, bound
  kContactOnApproach = 7,  ///< index: wrench axis; value: N or Nm, bound
  kUnreachable = 8,        ///< the command has no joint positions; value: error left in m or rad
  kJointLimit = 9,         ///< index: joint; value: position asked for, bound
  kJointSpeed = 10,        ///< index: joint; value: speed asked for, bound
  kForceFault = 11,        ///< value: N, bound
  kTorqueFault = 12,       ///< value: Nm, bound
  kSensorSaturated = 13,   ///< index: sensor axis; value: reading, bound
  kSensorNotFinite = 14,
  kArmFault = 15,         ///< arm_fault
  kArmNotEnabled = 16,    ///< the arm left the enabled state unasked; index: ArmState
  kEnableTimeout = 17,    ///< value: s waited
  kFeedbackMissing = 18,  ///< index: joint; value: cycles in a row, bound
  kWrenchMissing = 19,    ///< value: s without a sample, bound
  kOverruns = 20,         ///< value: late cycles; the control loop cannot keep its period
};
[[nodiscard]] const char* to_string(EndReason reason);

struct Ending {
  EndReason reason = EndReason::kNone;
  int index = -1;
  double value = 0.0;
  double bound = 0.0;
  Transition transition{};
  ArmFault arm_fault{};
  bool disable_confirmed = true;  ///< false: the arm never said that it is disabled
};

/// Whether the drives are told to stop by themselves at once, instead of the command ramping down.
[[nodiscard]] bool wants_quick_stop(EndReason reason);

/// One line with the numbers. @param arm_fault_text what hw says about arm_fault, may be empty.
/// Allocates; not for real time.
[[nodiscard]] std::string describe(const Ending& ending, const Plan& plan, const Cell& cell,
                                   const std::string& arm_fault_text = {});

/// "step 3: contact where validation never saw it", the deviation of a transition.
[[nodiscard]] std::string describe(const Transition& transition);

}  // namespace tenon::executor

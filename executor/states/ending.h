#pragma once
// Why a run ended, as plain data for the real-time code and as a line for people.

#include <cstdint>
#include <string>

#include "executor/faults/end_reason.h"
#include "executor/states/brake_slip.h"
#include "shared/cell/cell.h"
#include "shared/plan/plan.h"
#include "shared/plan/transition.h"
#include "shared/ports/arm.h"

namespace tenon::executor {

struct Ending {
  EndReason reason = EndReason::kNone;
  int index = -1;
  double value = 0.0;
  double bound = 0.0;
  double wanted = 0.0;
  int laggard = -1;  ///< a joint that stays behind, of too large a wrench
  double lag = 0.0;  ///< by that, m or rad
  int step = -1;     ///< that was running, for the reasons about joints
  Transition transition{};
  ArmFault arm_fault{};
  bool disable_confirmed = true;  ///< false: the arm never said that it is disabled
  BrakeSlip slip{};               ///< seen after the drives went off, whatever ended the run
  Hold hold = Hold::kNone;        ///< of an arm whose brake slips; arm_fault says what ended it
  std::uint32_t brakes_unwatched = 0;  ///< bit i: nobody could see whether joint i's brake holds
};

/// One line with the numbers. @param arm_fault_text what hw says about arm_fault, may be empty.
/// Allocates; not for real time.
[[nodiscard]] std::string describe(const Ending& ending, const Plan& plan, const Cell& cell,
                                   const std::string& arm_fault_text = {});

/// "joint z moved by 0.0062 m with the drives off, at most 0.0005: its brake does not hold"
[[nodiscard]] std::string describe(const BrakeSlip& slip, const Cell& cell);

/// What came of holding it: "held under power until it was told to stop"; empty where nothing did.
[[nodiscard]] std::string describe(Hold hold, const ArmFault& fault,
                                   const std::string& arm_fault_text);

/// "step 3: contact where validation never saw it", the deviation of a transition.
[[nodiscard]] std::string describe(const Transition& transition);

}  // namespace tenon::executor

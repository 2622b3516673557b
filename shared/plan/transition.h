#pragma once
// From a finished move to the next step: the same decision in certification and in execution.

#include <cstdint>

#include "shared/motion/guarded_move.h"
#include "shared/plan/plan.h"

namespace tenon {

enum class Deviation : std::uint8_t {
  kNone = 0,
  kUnexpectedOutcome = 1,  ///< the plan has no way on from this outcome
  kTravelOutside = 2,      ///< the displacement is outside the envelope
  kContactMissing = 3,     ///< the settled signature lacks a bit that validation always saw
  kContactUnforeseen = 4,  ///< it has one that validation never saw
  kPlaceOutside = 5,       ///< the tool ended where validation never saw it
};

struct Transition {
  Successor successor = kSuccessorFail;
  Deviation deviation = Deviation::kNone;
  /// For kTravelOutside and kPlaceOutside: the axis, 0..5. For the contact deviations: the bit,
  /// 0..11.
  int index = -1;
  /// For these two: how far it went along the axis, in the step or since the plan's start, and from
  /// where to where it may, m or rad; all 0 where it is read from a message, which does not say.
  double travelled = 0.0;
  double travelled_min = 0.0;
  double travelled_max = 0.0;
};

/// Real-time. A deviation always leads to kSuccessorFail.
/// @param start where the tool stood as the plan began
[[nodiscard]] Transition transition(const Plan& plan, std::size_t step, const Pose& start,
                                    const GuardedMove::Result& result);

}  // namespace tenon

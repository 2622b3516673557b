#include "shared/plan/transition.h"

#include <bit>

namespace tenon {

Transition transition(const Plan& plan, std::size_t step, const GuardedMove::Result& result) {
  const OutcomeRule& rule = plan.steps[step].rule(result.outcome);
  if (rule.successor == kSuccessorFail) {
    return {kSuccessorFail, Deviation::kUnexpectedOutcome, -1};
  }
  if (!plan.check_envelopes) return {rule.successor, Deviation::kNone, -1};

  const Envelope& envelope = rule.envelope;
  for (int axis = 0; axis < 6; ++axis) {
    if (!has(plan.coordinates, axis)) continue;
    const double travelled = result.travelled[axis];
    if (!(travelled >= envelope.travelled_min[axis] && travelled <= envelope.travelled_max[axis])) {
      return {kSuccessorFail, Deviation::kTravelOutside, axis};
    }
  }
  const auto missing = static_cast<std::uint16_t>(envelope.always.bits & ~result.signature.bits);
  if (missing != 0) {
    return {kSuccessorFail, Deviation::kContactMissing, std::countr_zero(missing)};
  }
  const auto unforeseen =
      static_cast<std::uint16_t>(result.signature.bits & ~envelope.possible.bits);
  if (unforeseen != 0) {
    return {kSuccessorFail, Deviation::kContactUnforeseen, std::countr_zero(unforeseen)};
  }
  return {rule.successor, Deviation::kNone, -1};
}

}  // namespace tenon

#include "shared/plan/transition.h"

#include <bit>

namespace tenon {

Transition transition(const Plan& plan, std::size_t step, const GuardedMove::Result& result) {
  const OutcomeRule& rule = plan.steps[step].rule(result.outcome);
  if (rule.successor == kSuccessorFail) return {kSuccessorFail, Deviation::kUnexpectedOutcome};
  if (!plan.check_envelopes) return {rule.successor};

  const Envelope& envelope = rule.envelope;
  for (int axis = 0; axis < 6; ++axis) {
    if (!has(plan.coordinates, axis)) continue;
    const double travelled = result.travelled[axis];
    const double low = envelope.travelled_min[axis];
    const double high = envelope.travelled_max[axis];
    if (!(travelled >= low && travelled <= high)) {
      return {kSuccessorFail, Deviation::kTravelOutside, axis, travelled, low, high};
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
  return {rule.successor};
}

}  // namespace tenon

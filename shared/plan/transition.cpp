#include "shared/plan/transition.h"

#include <bit>

namespace tenon {
namespace {

/// Of the coordinates the first that is outside.
Transition within(const Vector6& value, const Vector6& low, const Vector6& high,
                  CoordinateMask coordinates, Deviation deviation) {
  for (int axis = 0; axis < 6; ++axis) {
    if (!has(coordinates, axis)) continue;
    if (value[axis] >= low[axis] && value[axis] <= high[axis]) continue;
    return {kSuccessorFail, deviation, axis, value[axis], low[axis], high[axis]};
  }
  return {};
}

}  // namespace

Transition transition(const Plan& plan, std::size_t step, const Pose& start,
                      const GuardedMove::Result& result) {
  const OutcomeRule& rule = plan.steps[step].rule(result.outcome);
  if (rule.successor == kSuccessorFail) return {kSuccessorFail, Deviation::kUnexpectedOutcome};
  if (!plan.check_envelopes) return {rule.successor};

  const Envelope& envelope = rule.envelope;
  const Transition travel = within(result.travelled, envelope.travelled_min, envelope.travelled_max,
                                   plan.coordinates, Deviation::kTravelOutside);
  if (travel.deviation != Deviation::kNone) return travel;
  if (plan.check_places) {
    const Transition place = within(displacement_between(start, result.pose), envelope.place_min,
                                    envelope.place_max, plan.coordinates, Deviation::kPlaceOutside);
    if (place.deviation != Deviation::kNone) return place;
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

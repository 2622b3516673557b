#include "planner/judge/chain.h"

#include "shared/base/shown.h"
#include "shared/base/text.h"

namespace tenon::planner {
namespace {

std::string bit_name(int index) {
  return to_string(ContactSignature{static_cast<std::uint16_t>(1U << index)});
}

/// "travelled 3.10 mm along x, its envelope is 0.00 to 3.00"
std::string outside(const char* what, const Transition& t) {
  return std::string(what) + format(" %.2f %s along %s, its envelope is %.2f to %.2f",
                                    shown(t.travelled, t.index), t.index < 3 ? "mm" : "deg",
                                    axis_name(t.index), shown(t.travelled_min, t.index),
                                    shown(t.travelled_max, t.index));
}

}  // namespace

std::string describe(const Transition& transition, const GuardedMove::Result& move) {
  std::string outcome = std::string("outcome ") + to_string(move.outcome);
  switch (transition.deviation) {
    case Deviation::kNone:
      return outcome;
    case Deviation::kUnexpectedOutcome:
      return outcome + " has no successor";
    case Deviation::kTravelOutside:
      return outcome + outside(", travelled", transition);
    case Deviation::kPlaceOutside:
      return outcome + outside(", ended, from the start,", transition);
    case Deviation::kContactMissing:
      return outcome + ", contact " + bit_name(transition.index) + " is missing";
    case Deviation::kContactUnforeseen:
      return outcome + ", contact " + bit_name(transition.index) + " was not foreseen";
  }
  return outcome;
}

Chain run_chain(Rollout& rollout, const Plan& plan, const Particle& start, std::int64_t step_us) {
  Chain chain;
  chain.start = start;
  if (plan.steps.empty()) chain.done = true;
  Particle particle = start;
  for (std::size_t step = 0; step < plan.steps.size();) {
    const RolloutResult result = rollout.simulate(particle, move_parameters(plan, step), step_us);
    chain.steps.push_back(step);
    if (!result.valid) {
      chain.failure = "the simulation failed: " + result.failure;
      return chain;
    }
    chain.moves.push_back(result.move);
    chain.touching.push_back(result.touching);
    const Transition next = transition(plan, step, start.pose, result.move);
    if (next.successor == kSuccessorFail) {
      chain.failure = describe(next, result.move);
      return chain;
    }
    particle.pose = result.move.pose;
    particle.signature = result.move.signature;
    chain.done = next.successor == kSuccessorDone;
    if (chain.done) return chain;
    step = next.successor;
  }
  return chain;
}

std::size_t first_deviation(const Plan& plan, const Chain& chain) {
  for (std::size_t i = 0; i < chain.moves.size(); ++i) {
    const Transition next = transition(plan, chain.steps[i], chain.start.pose, chain.moves[i]);
    if (next.successor == kSuccessorFail) return i;
  }
  return chain.moves.size();
}

}  // namespace tenon::planner

#include "executor/dry_run/plan_reach.h"

namespace tenon::executor {
namespace {

void begin_from(std::optional<StepReach>& step, const StepReach::End& end,
                ContactSignature contacts) {
  if (step) {
    step->begin.include(end.box);
  } else {
    step.emplace();
    step->begin = end.box;
  }
  step->before.bits |= contacts.bits;
}

}  // namespace

// Successors only grow, so one pass meets every step after all of its predecessors.
std::vector<std::optional<StepReach>> reach_of(const Plan& plan) {
  std::vector<std::optional<StepReach>> reach(plan.steps.size());
  if (!reach.empty()) reach[0].emplace();
  for (std::size_t i = 0; i < reach.size(); ++i) {
    if (!reach[i]) continue;
    StepReach& here = *reach[i];
    const Step& step = plan.steps[i];
    here.swept = here.begin;
    for (const OutcomeRule& rule : step.outcomes) {
      if (rule.successor == kSuccessorFail) continue;
      const Envelope& seen = rule.envelope;
      StepReach::End end{rule.successor, {}};
      end.box = plan.check_envelopes ? here.begin.moved(seen.travelled_min, seen.travelled_max)
                                     : here.begin.moved(step.displacement.cwiseMin(0.0),
                                                        step.displacement.cwiseMax(0.0));
      here.swept.include(end.box);
      if (rule.successor < reach.size()) {
        begin_from(reach[rule.successor], end, plan.check_envelopes ? seen.possible : kAllContacts);
      }
      here.ends.push_back(end);
    }
  }
  return reach;
}

}  // namespace tenon::executor

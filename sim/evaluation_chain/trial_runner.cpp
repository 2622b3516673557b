#include "sim/evaluation_chain/trial_runner.h"

#include <optional>
#include <utility>
#include <vector>

#include "executor/dry_run/plan_check.h"
#include "shared/base/error.h"
#include "sim/evaluation_chain/trial_chain.h"

namespace tenon::sim {
namespace {

/// What is kept of the cycles of a run that is told.
constexpr double kToldCycles_s = 60.0;

/// @param recording null: none is made  @param look called with the chain once its run has ended
template <typename Look>
TrialResult execute(const PreparedPlan& prepared, const Trial& trial,
                    const executor::CycleRunner::Parameters& loop, Recording* recording,
                    const Look& look) {
  std::optional<TrialChain> chain;
  try {
    chain.emplace(prepared, trial, loop);
  } catch (const InputError& error) {
    TrialResult result;
    result.ending = kNoWorld;
    result.reason = error.what();
    return result;
  }
  chain->run(recording);
  look(*chain);
  return chain->result();
}

}  // namespace

TrialRunner::TrialRunner(const Cell& cell, const Task& task, const Candidate& candidate) {
  std::vector<std::string> refusals = executor::check_plan(candidate.plan, cell);
  executor::DryRun dry_run = executor::dry_run(candidate.plan, cell);
  refusals.insert(refusals.end(), dry_run.refusals.begin(), dry_run.refusals.end());
  if (!refusals.empty()) {
    throw InputError(candidate.file + ": cell '" + cell.name +
                     "' cannot execute this plan: " + refusals.front());
  }
  // Of all ways in which the tool can be there, the one that the whole plan has room from.
  const JointVector joints = dry_run.start.value();
  prepared_ = std::make_shared<const PreparedPlan>(
      PreparedPlan{cell, task, candidate, std::move(dry_run), joints});
}

TrialResult TrialRunner::run(const Trial& trial) const {
  return execute(*prepared_, trial, {}, nullptr, [](const TrialChain&) {});
}

TrialResult TrialRunner::record(const Trial& trial, Recording& recording) const {
  return execute(*prepared_, trial, {}, &recording, [](const TrialChain&) {});
}

TrialResult TrialRunner::tell(const Trial& trial, const std::string& black_box,
                              RecordReport& written) const {
  executor::CycleRunner::Parameters loop;
  loop.black_box_s = kToldCycles_s;
  return execute(*prepared_, trial, loop, nullptr, [&](const TrialChain& chain) {
    chain.print();
    if (!black_box.empty()) written = chain.black_box().write_csv(black_box);
  });
}

}  // namespace tenon::sim

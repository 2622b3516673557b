#include "tests/faults/matrix/fault_cell.h"

#include <algorithm>
#include <limits>

#include "shared/base/text.h"

namespace tenon::tests {
namespace {

using executor::EndReason;
using executor::FaultRow;
using sim::FaultPhase;

std::string promise_of(const FaultKind& kind) {
  std::string all;
  for (const FaultRow* row : kind.names) all += (all.empty() ? "" : " or ") + full_name(*row);
  return all.empty() ? "ridden out" : all;
}

// A contact is decided within its debounce, and at rest within half a second.
constexpr double kTouchJudged_s = 0.6;

/// In cycles from when the fault can be seen; what no time bounds is bounded by the run's end.
std::int64_t most_cycles(const FaultRow& row, const Robot& robot) {
  if (row.reason == EndReason::kPlanFailed) {
    return static_cast<std::int64_t>(kTouchJudged_s / (1e-6 * robot.cycle_us));
  }
  return executor::bound_cycles(row, robot).value_or(std::numeric_limits<std::int64_t>::max());
}

/// Named with the way to rest still before it.
bool is_foreseen(const FaultRow& row) { return row.reason == EndReason::kJointLimit; }

void judge_named(Outcome& outcome, const DrivenRun& run, const FaultKind& kind,
                 const Ground& ground) {
  const executor::Ending ending = run.result().ending;
  const FaultRow* row = executor::fault_row(ending.reason, ending.arm_fault.kind);
  outcome.verdict = Outcome::Verdict::kStopped;
  outcome.named = row;
  const auto since = row == nullptr ? std::nullopt : run.watch().since(*row);
  const std::int64_t took = run.watch().named().value_or(0) - since.value_or(0) + 1;
  const std::int64_t most = row == nullptr ? 0 : most_cycles(*row, ground.cell.robot);
  outcome.text = row == nullptr ? "no row" : full_name(*row);
  if (since) outcome.text += format(" %lld", static_cast<long long>(took));
  if (!since && row != nullptr && is_foreseen(*row)) outcome.text += " foreseen";
  if (std::find(kind.names.begin(), kind.names.end(), row) == kind.names.end()) {
    outcome.complaint = "promised: " + promise_of(kind) + "; " + run.result().reason;
  } else if (since && (took > most || (took < 1 && !is_foreseen(*row)))) {
    outcome.complaint = format("took %lld cycles, at most %lld", static_cast<long long>(took),
                               static_cast<long long>(most));
  }
}

/// Without a name: right where there was none to give, or the run was over before it was due.
void judge_unnamed(Outcome& outcome, const DrivenRun& run, const FaultKind& kind,
                   const Ground& ground, FaultPhase phase) {
  const WholeRun::Result result = run.result();
  const EndReason wanted =
      phase == FaultPhase::kStopping ? EndReason::kStopRequested : EndReason::kPlanDone;
  const sim::Truth held = run.watch().truth_held();
  outcome.text = "ridden out";
  if (result.ending.reason != wanted) {
    outcome.complaint = "ended otherwise: " + result.reason;
  } else if (wanted == EndReason::kPlanDone && !held.within_tolerance) {
    outcome.complaint = format("done but wrong by %.2f mm", 1e3 * held.error_norm_m);
  }
  const std::int64_t over = run.watch().over().value_or(run.watch().cycles());
  for (const FaultRow* row : kind.names) {
    const auto since = run.watch().since(*row);
    const bool due = since && over - *since > most_cycles(*row, ground.cell.robot);
    // What only the executor can tell is promised wherever it can be.
    if (due || kind.while_moving_only) outcome.complaint = "promised: " + promise_of(kind);
  }
}

/// The end state, by the truth.
void judge_end_state(Outcome& outcome, const DrivenRun& run, const FaultKind& kind,
                     const Ground& ground) {
  const bool slips =
      outcome.named != nullptr && outcome.named->end_state == executor::EndState::kBrakeSlips;
  // The servo goes where its encoder sends it until its brake holds.
  const double misread = kind.drive_moves_by_itself ? jump_of(ground.cell.robot) : 0.0;
  const std::string left = run.rest().complaints(misread);
  const bool on_their_own = kind.master_is_lost && has_drives_without_reaction(ground.cell.robot);
  outcome.stays_powered = on_their_own && !left.empty();
  if (outcome.stays_powered) {
    outcome.text += ", stands under power";
    if (!run.rest().stands()) outcome.complaint += "; under power and in motion: " + left;
  } else if (slips ? !run.rest().off() : !left.empty()) {
    outcome.complaint += "; left as: " + left;
  }
  const double force_N = run.watch().truth_held().contact_force_N_max;
  // An arm that falls presses as it falls, and one that its encoder deceives before anyone knows.
  if (!slips && !kind.drive_moves_by_itself && force_N > ground.force_most_N()) {
    outcome.complaint += format("; pressed with %.0f N", force_N);
  }
}

/// Why there is no such fault; empty: there is.
std::string why_impossible(const FaultKind& kind, FaultPhase phase, const Ground& ground) {
  if (!kind.impossible.empty()) return kind.impossible;
  const bool moves = phase == FaultPhase::kFree || phase == FaultPhase::kSliding;
  if (kind.while_moving_only && !moves) return "nothing moves towards it";
  if (kind.act == Act::kJointLimit && !ground.way_on(phase)) {
    return "no joint comes to where it was not before";
  }
  return "";
}

}  // namespace

Outcome run_cell(const Ground& ground, const FaultKind& kind, FaultPhase phase,
                 const executor::FaultMask& mask) {
  Outcome outcome;
  if (const std::string why = why_impossible(kind, phase, ground); !why.empty()) {
    outcome.verdict = Outcome::Verdict::kImpossible;
    outcome.text = "impossible: " + why;
    return outcome;
  }
  DrivenRun run(ground, kind, {.phase = phase, .mask = mask});
  run.drive();
  const EndReason reason = run.result().ending.reason;
  const bool orderly = reason == EndReason::kPlanDone || reason == EndReason::kStopRequested;
  if (!run.watch().has_struck()) {
    outcome.text = "?";
    outcome.complaint = "the phase never came: " + run.result().reason;
  } else if (kind.act == Act::kKill) {
    outcome.verdict = Outcome::Verdict::kKilled;
    outcome.text = "stopped by the drives";
  } else if (orderly || reason == EndReason::kNone) {
    judge_unnamed(outcome, run, kind, ground, phase);
  } else {
    judge_named(outcome, run, kind, ground);
  }
  judge_end_state(outcome, run, kind, ground);
  if (run.watch().fastest() > 1.0 + 1e-6) {
    outcome.complaint += format("; a joint was commanded %.3f of its speed", run.watch().fastest());
  }
  if (run.watch().beyond_limit() > 0.0) {
    outcome.complaint +=
        format("; commanded %g beyond a joint's limit", run.watch().beyond_limit());
  }
  if (kind.act != Act::kKill && !run.black_box_is_whole()) {
    outcome.complaint += "; the black box is not whole";
  }
  return outcome;
}

}  // namespace tenon::tests

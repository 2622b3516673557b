#pragma once
// One cell of the fault matrix: a whole run in which a fault of a kind strikes in a phase, on a
// robot, and what came of it by the executor's word and the virtual arm's truth.

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "executor/dry_run/dry_run.h"
#include "executor/faults/fault_table.h"
#include "sim/cell/faults/fault_phases.h"
#include "tests/chain/fault_matrix/fault_kind.h"
#include "tests/support/planned.h"

namespace tenon::tests {

/// A robot, its plan, and where a run without faults is when a phase begins and a little later.
struct Ground {
  explicit Ground(const std::string& cell_name);

  /// What a stop on force may come to: the bound, and what the stiffest contact adds at the plan's
  /// greatest speed until it is noticed and acted on.
  [[nodiscard]] double force_most_N() const;

  struct Moment {
    JointVector joints{};
    Vector3 tool_m = Vector3::Zero();  ///< task frame, of the environment as it stands
  };
  Cell cell;
  Planned planned;
  executor::DryRun dry_run;
  JointVector start{};
  std::array<Moment, sim::kFaultPhases> begins{};
  std::array<Moment, sim::kFaultPhases> later{};  ///< 0.4 s after that
};

struct Outcome {
  enum class Verdict { kRiddenOut, kStopped, kKilled, kImpossible };
  Verdict verdict = Verdict::kRiddenOut;
  std::string text;       ///< for the printed matrix
  std::string complaint;  ///< what breaks the matrix's promise; empty: nothing
  const executor::FaultRow* named = nullptr;
};

/// @param mask of detectors that are off
[[nodiscard]] Outcome run_cell(const Ground& ground, const FaultKind& kind, sim::FaultPhase phase,
                               const executor::FaultMask& mask = {});

}  // namespace tenon::tests

#pragma once
// One cell of the fault matrix: a whole run in which a fault of a kind strikes in a phase, on a
// robot, and what came of it by the executor's word and the virtual arm's truth.

#include <cstddef>
#include <cstdint>
#include <string>

#include "executor/faults/fault_table.h"
#include "sim/cell/faults/fault_phases.h"
#include "tests/faults/matrix/driven_run.h"
#include "tests/faults/matrix/fault_kind.h"

namespace tenon::tests {

struct Outcome {
  enum class Verdict { kRiddenOut, kStopped, kKilled, kImpossible };
  static constexpr std::size_t kVerdicts = 4;
  Verdict verdict = Verdict::kRiddenOut;
  std::string text;       ///< for the printed matrix
  std::string complaint;  ///< what breaks the matrix's promise; empty: nothing
  const executor::FaultRow* named = nullptr;
  bool stays_powered = false;  ///< at rest: its drives have no reaction to a lost master
};

/// @param mask of detectors that are off
[[nodiscard]] Outcome run_cell(const Ground& ground, const FaultKind& kind, sim::FaultPhase phase,
                               const executor::FaultMask& mask = {});

}  // namespace tenon::tests

// Every kind of fault in every phase of a run, on two robots: it is ridden out, or stopped by a
// name of the executor's table within that table's bound, and the arm is left in its brakes and
// without power. What is promised follows from the table; this prints what came.

#include <gtest/gtest.h>

#include <cstdio>
#include <map>
#include <string>
#include <utility>

#include "tests/faults/matrix/fault_cell.h"
#include "tests/faults/matrix/fault_kind.h"

namespace tenon::tests {
namespace {

using executor::EndReason;
using executor::FaultMask;
using executor::FaultRow;
using sim::FaultPhase;

constexpr FaultPhase kPhases[] = {FaultPhase::kEnabling, FaultPhase::kFree, FaultPhase::kSliding,
                                  FaultPhase::kContact, FaultPhase::kStopping};

/// A cell of a robot's matrix, run once for all tests.
const Outcome& outcome_of(const Ground& ground, const std::string& robot, const FaultKind& kind,
                          FaultPhase phase) {
  static std::map<std::pair<std::string, FaultPhase>, Outcome> all;
  const std::pair cell{robot + ", " + kind.name, phase};
  const auto known = all.find(cell);
  return known != all.end() ? known->second
                            : all.emplace(cell, run_cell(ground, kind, phase)).first->second;
}

/// Only the detectors that the cell may be named by.
FaultMask mask_of(const FaultKind& kind) {
  FaultMask mask;
  for (const FaultRow* row : kind.names) mask.mask(row->reason, row->arm_fault);
  return mask;
}

/// All of them.
FaultMask mask_of_all() {
  FaultMask mask;
  for (const FaultRow& row : executor::fault_table()) {
    const bool orderly =
        row.reason == EndReason::kPlanDone || row.reason == EndReason::kStopRequested;
    if (!orderly) mask.mask(row.reason, row.arm_fault);
  }
  return mask;
}

std::string name_of(const FaultKind& kind, FaultPhase phase) {
  return std::string(kind.name) + ", " + std::to_string(static_cast<int>(phase));
}

class FaultMatrix : public ::testing::TestWithParam<const char*> {
 protected:
  /// Without its detector a cell that has a name loses it. @return it has one
  bool loses_its_name(const FaultKind& kind, FaultPhase phase) {
    const Outcome& outcome = outcome_of(ground, GetParam(), kind, phase);
    if (outcome.named == nullptr) return false;
    const Outcome blind = run_cell(ground, kind, phase, mask_of(kind));
    EXPECT_NE(blind.named, outcome.named) << name_of(kind, phase);
    // A stop may be over before the fault is due.
    if (phase != FaultPhase::kStopping) {
      EXPECT_NE(blind.complaint, "") << name_of(kind, phase) << ": the matrix must miss it";
    }
    return true;
  }

  /// Without any detector such a cell fails. @return it has a name, and time for its fault
  bool is_missed(const FaultKind& kind, FaultPhase phase) {
    const Outcome& outcome = outcome_of(ground, GetParam(), kind, phase);
    if (outcome.named == nullptr || phase == FaultPhase::kStopping) return false;
    const Outcome blind = run_cell(ground, kind, phase, mask_of_all());
    EXPECT_NE(blind.complaint, "") << kind.name << ": nobody looks, and all seems well";
    return true;
  }

  Ground ground{GetParam()};
};

TEST_P(FaultMatrix, EveryFaultInEveryPhaseIsRiddenOutOrStoppedByName) {
  std::map<Outcome::Verdict, int> count;
  std::printf("%s, cycles from when a fault can be seen to its name\n", GetParam());
  for (const FaultKind& kind : fault_kinds()) {
    std::string line;
    for (const FaultPhase phase : kPhases) {
      const Outcome& outcome = outcome_of(ground, GetParam(), kind, phase);
      ++count[outcome.verdict];
      line += " | " + outcome.text;
      EXPECT_EQ(outcome.complaint, "") << kind.name << ", " << static_cast<int>(phase);
    }
    std::printf("%s%s\n", kind.name, line.c_str());
  }
  std::printf(
      "%s: %d ridden out, %d stopped by name, %d stopped by the drives, %d impossible "
      "(nothing moves towards it)\n",
      GetParam(), count[Outcome::Verdict::kRiddenOut], count[Outcome::Verdict::kStopped],
      count[Outcome::Verdict::kKilled], count[Outcome::Verdict::kImpossible]);
  EXPECT_LE(count[Outcome::Verdict::kImpossible], 15);
}

TEST_P(FaultMatrix, WithItsDetectorMaskedACellLosesItsName) {
  int masked = 0;
  for (const FaultKind& kind : fault_kinds()) {
    for (const FaultPhase phase : kPhases) masked += loses_its_name(kind, phase) ? 1 : 0;
  }
  std::printf("%s: %d cells lose their name\n", GetParam(), masked);
  EXPECT_GT(masked, 80);
}

// Without any detector every fault is missed.
TEST_P(FaultMatrix, WithAllDetectorsMaskedEveryFaultIsMissed) {
  std::size_t next = 0;
  int missed = 0;
  for (const FaultKind& kind : fault_kinds()) {
    missed += is_missed(kind, kPhases[next++ % std::size(kPhases)]) ? 1 : 0;
  }
  std::printf("%s: %d faults are missed\n", GetParam(), missed);
  EXPECT_GT(missed, 15);
}

// What the two before show for all, for some: every kind in one phase, and every third of them
// without any detector.
TEST_P(FaultMatrix, SomeCellsLoseTheirNamesWithTheirDetectorsAndAreMissedWithoutAny) {
  std::size_t next = 0;
  int masked = 0;
  int missed = 0;
  for (const FaultKind& kind : fault_kinds()) {
    const FaultPhase phase = kPhases[next % std::size(kPhases)];
    masked += loses_its_name(kind, phase) ? 1 : 0;
    if (next++ % 3 == 0) missed += is_missed(kind, phase) ? 1 : 0;
  }
  std::printf("%s: %d cells lose their name, %d faults are missed\n", GetParam(), masked, missed);
  EXPECT_GT(masked, 15);
  EXPECT_GT(missed, 4);
}

INSTANTIATE_TEST_SUITE_P(Tree, FaultMatrix, ::testing::Values("gantry3"));
INSTANTIATE_TEST_SUITE_P(SixAxes, FaultMatrix, ::testing::Values("csp6"));

}  // namespace
}  // namespace tenon::tests

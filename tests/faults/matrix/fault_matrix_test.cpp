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

using Outcomes = std::map<std::pair<std::string, FaultPhase>, Outcome>;

/// Every cell of a robot's matrix, run once for all tests.
const Outcomes& outcomes_of(const Ground& ground, const std::string& robot) {
  static std::map<std::string, Outcomes> all;
  Outcomes& outcomes = all[robot];
  if (!outcomes.empty()) return outcomes;
  for (const FaultKind& kind : fault_kinds()) {
    for (const FaultPhase phase : kPhases) {
      outcomes[{kind.name, phase}] = run_cell(ground, kind, phase);
    }
  }
  return outcomes;
}

class FaultMatrix : public ::testing::TestWithParam<const char*> {};

TEST_P(FaultMatrix, EveryFaultInEveryPhaseIsRiddenOutOrStoppedByName) {
  const Ground ground(GetParam());
  const Outcomes& outcomes = outcomes_of(ground, GetParam());
  std::map<Outcome::Verdict, int> count;
  std::printf("%s, cycles from when a fault can be seen to its name\n", GetParam());
  for (const FaultKind& kind : fault_kinds()) {
    std::string line;
    for (const FaultPhase phase : kPhases) {
      const Outcome& outcome = outcomes.at({kind.name, phase});
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
  const Ground ground(GetParam());
  const Outcomes& outcomes = outcomes_of(ground, GetParam());
  int masked = 0;
  for (const FaultKind& kind : fault_kinds()) {
    FaultMask mask;
    for (const FaultRow* row : kind.names) mask.mask(row->reason, row->arm_fault);
    for (const FaultPhase phase : kPhases) {
      const Outcome& outcome = outcomes.at({kind.name, phase});
      if (outcome.named == nullptr) continue;
      const Outcome blind = run_cell(ground, kind, phase, mask);
      const std::string cell = std::string(kind.name) + ", " + std::to_string(int(phase));
      EXPECT_NE(blind.named, outcome.named) << cell;
      // A stop may be over before the fault is due.
      if (phase != FaultPhase::kStopping) {
        EXPECT_NE(blind.complaint, "") << cell << ": the matrix must miss it";
      }
      ++masked;
    }
  }
  std::printf("%s: %d cells lose their name\n", GetParam(), masked);
  EXPECT_GT(masked, 80);
}

// Without any detector every fault is missed.
TEST_P(FaultMatrix, WithAllDetectorsMaskedEveryFaultIsMissed) {
  const Ground ground(GetParam());
  const Outcomes& outcomes = outcomes_of(ground, GetParam());
  FaultMask mask;
  for (const FaultRow& row : executor::fault_table()) {
    const bool orderly =
        row.reason == EndReason::kPlanDone || row.reason == EndReason::kStopRequested;
    if (!orderly) mask.mask(row.reason, row.arm_fault);
  }
  std::size_t next = 0;
  int missed = 0;
  for (const FaultKind& kind : fault_kinds()) {
    const FaultPhase phase = kPhases[next++ % std::size(kPhases)];
    const Outcome& outcome = outcomes.at({kind.name, phase});
    if (outcome.named == nullptr || phase == FaultPhase::kStopping) continue;
    const Outcome blind = run_cell(ground, kind, phase, mask);
    EXPECT_NE(blind.complaint, "") << kind.name << ": nobody looks, and all seems well";
    ++missed;
  }
  EXPECT_GT(missed, 15);
}

INSTANTIATE_TEST_SUITE_P(Tree, FaultMatrix, ::testing::Values("gantry3"));
INSTANTIATE_TEST_SUITE_P(SixAxes, FaultMatrix, ::testing::Values("csp6"));

}  // namespace
}  // namespace tenon::tests

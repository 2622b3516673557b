// Every kind of fault in every phase of a run, on two robots: it is ridden out, or stopped by a
// name of the executor's table within that table's bound, and the arm is left in its brakes and
// without power. What is promised follows from the table; this prints what came.

#include <gtest/gtest.h>

#include <cstdio>
#include <map>
#include <string>

#include "tests/chain/fault_matrix/fault_cell.h"
#include "tests/chain/fault_matrix/fault_kind.h"

namespace tenon::tests {
namespace {

using executor::FaultMask;
using executor::FaultRow;
using sim::FaultPhase;

constexpr FaultPhase kPhases[] = {FaultPhase::kEnabling, FaultPhase::kFree, FaultPhase::kSliding,
                                  FaultPhase::kContact, FaultPhase::kStopping};

class FaultMatrix : public ::testing::TestWithParam<const char*> {};

TEST_P(FaultMatrix, EveryFaultInEveryPhaseIsRiddenOutOrStoppedByName) {
  const Ground ground(GetParam());
  std::map<Outcome::Verdict, int> count;
  std::printf("%s, cycles from when a fault can be seen to its name\n", GetParam());
  for (const FaultKind& kind : fault_kinds()) {
    std::string line;
    for (const FaultPhase phase : kPhases) {
      const Outcome outcome = run_cell(ground, kind, phase);
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
  int masked = 0;
  for (const FaultKind& kind : fault_kinds()) {
    const Outcome outcome = run_cell(ground, kind, FaultPhase::kFree);
    if (outcome.named == nullptr) continue;
    FaultMask mask;
    for (const FaultRow* row : kind.names) mask.mask(row->reason, row->arm_fault);
    const Outcome blind = run_cell(ground, kind, FaultPhase::kFree, mask);
    EXPECT_NE(blind.named, outcome.named) << kind.name;
    EXPECT_NE(blind.complaint, "") << kind.name << ": the matrix must miss it";
    ++masked;
  }
  EXPECT_GT(masked, 15);
}

INSTANTIATE_TEST_SUITE_P(Tree, FaultMatrix, ::testing::Values("gantry3"));
INSTANTIATE_TEST_SUITE_P(SixAxes, FaultMatrix, ::testing::Values("csp6"));

}  // namespace
}  // namespace tenon::tests

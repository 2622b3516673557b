// Every kind of fault in every phase of a run, on every shipped robot, some with drives in the
// likeness of those that they name: it is ridden out, or stopped by a name of the executor's table
// within that table's bound, and the arm is left in its brakes and without power, or as is said at
// its start. What is promised follows from the table; this prints what came.

#include <gtest/gtest.h>

#include <array>
#include <cstddef>
#include <cstdio>
#include <map>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

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

/// What a matrix is made for.
struct Subject {
  const char* cell = "";
  const char* twin = "";  ///< what its drives answer like, a file of tests/twins; empty: the book
  const char* plan_of = "";  ///< the cell that its plan was made for; empty: its own
  std::size_t first = 0;     ///< kind of its sample
  /// Without any detector, too, each fault strikes in every phase, not in one.
  bool blind_in_all = false;
};

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

/// What a matrix comes to.
struct Count {
  std::array<int, Outcome::kVerdicts> verdicts{};
  int powered = 0;  ///< of them

  void add(const Outcome& outcome) {
    ++verdicts[static_cast<std::size_t>(outcome.verdict)];
    powered += outcome.stays_powered ? 1 : 0;
  }
  [[nodiscard]] int of(Outcome::Verdict verdict) const {
    return verdicts[static_cast<std::size_t>(verdict)];
  }
  void print(const char* robot) const {
    std::printf(
        "%s: %d ridden out, %d stopped by name, %d stopped by the drives, %d impossible; %d of "
        "them left under power, as is said at the start\n",
        robot, of(Outcome::Verdict::kRiddenOut), of(Outcome::Verdict::kStopped),
        of(Outcome::Verdict::kKilled), of(Outcome::Verdict::kImpossible), powered);
  }
};

class FaultMatrix : public ::testing::TestWithParam<Subject> {
 protected:
  const Outcome& outcome_in(const FaultKind& kind, FaultPhase phase) {
    const Outcome& outcome = outcome_of(ground, robot(), kind, phase);
    EXPECT_EQ(outcome.complaint, "") << name_of(kind, phase);
    return outcome;
  }
  [[nodiscard]] static const char* robot() { return GetParam().cell; }

  /// Every phase of these kinds, printed, a line each.
  Count walked(const std::vector<FaultKind>& of) {
    Count count;
    std::printf("%s, cycles from when a fault can be seen to its name\n", robot());
    for (const FaultKind& kind : of) {
      std::string line;
      for (const FaultPhase phase : kPhases) {
        const Outcome& outcome = outcome_in(kind, phase);
        count.add(outcome);
        line += " | " + outcome.text;
      }
      std::printf("%s%s\n", kind.name, line.c_str());
    }
    count.print(robot());
    return count;
  }

  /// Without its detector a cell that has a name loses it. @return it has one
  bool loses_its_name(const FaultKind& kind, FaultPhase phase) {
    const Outcome& outcome = outcome_of(ground, robot(), kind, phase);
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
    const Outcome& outcome = outcome_of(ground, robot(), kind, phase);
    if (outcome.named == nullptr || phase == FaultPhase::kStopping) return false;
    const Outcome blind = run_cell(ground, kind, phase, mask_of_all());
    EXPECT_NE(blind.complaint, "") << kind.name << ": nobody looks, and all seems well";
    return true;
  }

  Ground ground{GetParam().cell, GetParam().twin, GetParam().plan_of};
  std::vector<FaultKind> kinds{fault_kinds(ground.cell.robot)};
  /// How many cells may be impossible: 30 of every two robots.
  static constexpr int kImpossibleMost = 15;
};

TEST_P(FaultMatrix, EveryFaultInEveryPhaseIsRiddenOutOrStoppedByName) {
  const Count count = walked(kinds);
  EXPECT_LE(count.of(Outcome::Verdict::kImpossible), kImpossibleMost);
  EXPECT_EQ(count.powered > 0, has_drives_without_reaction(ground.cell.robot));
}

TEST_P(FaultMatrix, WithItsDetectorMaskedACellLosesItsName) {
  int masked = 0;
  for (const FaultKind& kind : kinds) {
    for (const FaultPhase phase : kPhases) masked += loses_its_name(kind, phase) ? 1 : 0;
  }
  std::printf("%s: %d cells lose their name\n", robot(), masked);
  EXPECT_GT(masked, 80);
}

// Without any detector every fault is missed.
TEST_P(FaultMatrix, WithAllDetectorsMaskedEveryFaultIsMissed) {
  std::size_t next = 0;
  int missed = 0;
  for (const FaultKind& kind : kinds) {
    if (!GetParam().blind_in_all) {
      missed += is_missed(kind, kPhases[next++ % std::size(kPhases)]) ? 1 : 0;
      continue;
    }
    for (const FaultPhase phase : kPhases) missed += is_missed(kind, phase) ? 1 : 0;
  }
  std::printf("%s: %d faults are missed\n", robot(), missed);
  EXPECT_GT(missed, GetParam().blind_in_all ? 60 : 15);
}

// What the two before show for all, for some: every kind in one phase, and every third of them
// without any detector.
TEST_P(FaultMatrix, SomeCellsLoseTheirNamesWithTheirDetectorsAndAreMissedWithoutAny) {
  std::size_t next = 0;
  int masked = 0;
  int missed = 0;
  for (const FaultKind& kind : kinds) {
    const FaultPhase phase = kPhases[next % std::size(kPhases)];
    masked += loses_its_name(kind, phase) ? 1 : 0;
    if (next++ % 3 == 0) missed += is_missed(kind, phase) ? 1 : 0;
  }
  std::printf("%s: %d cells lose their name, %d faults are missed\n", robot(), masked, missed);
  EXPECT_GT(masked, 15);
  EXPECT_GT(missed, 4);
}

// Every third kind in one phase, of three robots another third each: what a commit sees of those
// whose whole matrix a release sees.
class FaultSample : public FaultMatrix {};

TEST_P(FaultSample, FaultsInSomePhaseAreRiddenOutOrStoppedByName) {
  Count count;
  for (std::size_t i = GetParam().first; i < kinds.size(); i += 3) {
    count.add(outcome_in(kinds[i], kPhases[i % std::size(kPhases)]));
  }
  count.print(robot());
  EXPECT_GE(count.of(Outcome::Verdict::kStopped), 7);
}

// All that can happen to a sensor's samples, in every phase, with each of the sensors that are
// named by a profile; the shipped robots have CANopen nodes.
class SensorFaults : public FaultMatrix {};

TEST_P(SensorFaults, EachInEveryPhaseIsRiddenOutOrStoppedByName) {
  std::erase_if(kinds, [](const FaultKind& kind) {
    return !std::string_view(kind.name).starts_with("force ");
  });
  const Count count = walked(kinds);
  EXPECT_GE(count.of(Outcome::Verdict::kStopped), 20);
}

// A drive whose effort stands still, where that is all that tells the force.
class EffortFaults : public FaultMatrix {
 protected:
  void SetUp() override {
    std::erase_if(kinds, [](const FaultKind& kind) {
      return !std::string_view(kind.name).starts_with("effort ");
    });
    ASSERT_EQ(kinds.size(), 1U);
  }
};

TEST_P(EffortFaults, EachInEveryPhaseIsRiddenOutOrStoppedByName) {
  const Count count = walked(kinds);
  EXPECT_GE(count.of(Outcome::Verdict::kStopped), 4);
}

TEST_P(EffortFaults, WithItsDetectorMaskedACellLosesItsName) {
  for (const FaultPhase phase : kPhases) (void)loses_its_name(kinds.front(), phase);
}

std::string subject_name(const ::testing::TestParamInfo<Subject>& info) { return info.param.cell; }

constexpr Subject kOtherArms[] = {
    {.cell = "mit6"},
    {.cell = "lwa4p", .twin = "lwa4p", .first = 1},
    {.cell = "epos4", .twin = "epos4", .plan_of = "gantry3", .first = 2}};

INSTANTIATE_TEST_SUITE_P(Tree, FaultMatrix,
                         ::testing::Values(Subject{.cell = "gantry3", .blind_in_all = true}),
                         subject_name);
INSTANTIATE_TEST_SUITE_P(SixAxes, FaultMatrix,
                         ::testing::Values(Subject{.cell = "csp6", .blind_in_all = true}),
                         subject_name);
INSTANTIATE_TEST_SUITE_P(Full, FaultMatrix, ::testing::ValuesIn(kOtherArms), subject_name);
INSTANTIATE_TEST_SUITE_P(Tree, FaultSample, ::testing::ValuesIn(kOtherArms), subject_name);
INSTANTIATE_TEST_SUITE_P(Tree, SensorFaults,
                         ::testing::Values(Subject{.cell = "rft_gantry3"},
                                           Subject{.cell = "ati_gantry3"}),
                         subject_name);
INSTANTIATE_TEST_SUITE_P(Tree, EffortFaults,
                         ::testing::Values(Subject{.cell = "torque_gantry3", .plan_of = "gantry3"}),
                         subject_name);

}  // namespace
}  // namespace tenon::tests

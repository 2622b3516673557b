// The dump in FORMAT.md against the codec. The dump was made by a program of its own, from the
// tables.

#include <gtest/gtest.h>

#include <cctype>
#include <fstream>
#include <string>
#include <vector>

#include "shared/plan/codec.h"
#include "tests/shared/example_plans.h"
#include "tests/support/places.h"

namespace tenon {
namespace {

// The bytes of the fenced block "dump": lines of an offset, two blanks, bytes, two blanks, a note.
std::vector<std::uint8_t> documented_bytes() {
  std::ifstream document(tests::in_tree("shared/plan/FORMAT.md"));
  std::vector<std::uint8_t> bytes;
  bool inside = false;
  for (std::string line; std::getline(document, line);) {
    if (line.starts_with("```")) inside = line == "```dump";
    if (!inside || line.empty() || std::isxdigit(static_cast<unsigned char>(line[0])) == 0)
      continue;
    EXPECT_EQ(std::stoul(line.substr(0, 4), nullptr, 16), bytes.size()) << line;
    for (std::size_t at = 6; at + 1 < line.size() && line[at] != ' '; at += 3) {
      bytes.push_back(static_cast<std::uint8_t>(std::stoul(line.substr(at, 2), nullptr, 16)));
    }
  }
  return bytes;
}

TEST(PlanFormat, TheDocumentedBytesAreWhatTheCodecWrites) {
  const std::vector<std::uint8_t> bytes = documented_bytes();
  ASSERT_EQ(bytes.size(), 396U);
  EXPECT_EQ(encode_plan(tests::documented_plan()), bytes);
}

TEST(PlanFormat, TheDocumentedBytesDecodeToTheirNotes) {
  const DecodedPlan result = decode_plan(documented_bytes());
  ASSERT_TRUE(result.plan) << to_string(result.error) << ": " << result.field;
  const Plan& plan = *result.plan;
  EXPECT_EQ(plan.task_name, "box_on_table_2d");
  EXPECT_EQ(plan.start_name, "1");
  EXPECT_EQ(plan.goal.position_m, Vector3(0.25, -0.15, 0.002));
  EXPECT_EQ(plan.compliance.damping_Nspm, 1500.0);
  EXPECT_EQ(plan.parameter_sets.at(0).thresholds.force_on_N, 6.0);
  ASSERT_EQ(plan.steps.size(), 3U);
  EXPECT_EQ(plan.steps[1].displacement[1], -0.25);
  EXPECT_EQ(plan.steps[1].rule(Outcome::kContact).successor, 2);
  EXPECT_EQ(to_string(plan.steps[1].rule(Outcome::kContact).envelope.always), "+x +y");
  EXPECT_EQ(plan.steps[1].rule(Outcome::kReached).successor, kSuccessorFail);
  EXPECT_EQ(plan.steps[2].rule(Outcome::kReached).successor, kSuccessorDone);
}

}  // namespace
}  // namespace tenon

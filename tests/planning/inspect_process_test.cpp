// tenon-inspect --recertify and --report, as a user runs them.

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <string>
#include <vector>

#include "shared/config/files.h"
#include "shared/config/load.h"
#include "shared/plan/codec.h"
#include "tests/support/commands.h"
#include "tests/support/places.h"
#include "tests/support/sim_process.h"

namespace tenon::tests {
namespace {

class Recertify : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    folder = new ScratchFolder;
    file = shared_plan("toy_1d");
  }
  static void TearDownTestSuite() {
    delete folder;
    folder = nullptr;
  }

  static Ended recertify(const std::string& plan, const std::vector<std::string>& more = {}) {
    std::vector<std::string> command = {executable("tenon-inspect"), plan, "--recertify",
                                        toy_file()};
    command.insert(command.end(), more.begin(), more.end());
    return run(*folder, command);
  }

  /// The plan with a change that its checksum covers.
  template <typename Change>
  static std::string changed(const Change& change) {
    Plan plan = load_plan(file);
    change(plan);
    const std::vector<std::uint8_t> bytes = encode_plan(plan);
    return folder->put("changed.tnp", {bytes.begin(), bytes.end()});
  }

  static std::string toy_file() { return in_tree("planner/tasks/toy_1d.yaml"); }
  inline static ScratchFolder* folder = nullptr;
  inline static std::string file;
};

TEST_F(Recertify, SaysYesToEveryPhysicsAndToTheDrawsThatTheFileCounts) {
  const Ended ended = recertify(file);
  EXPECT_EQ(ended.status, 0) << ended.err;
  for (const char* said : {"yes, as planned", "yes, half the integration step",
                           "yes, lowest friction", "yes, highest friction", "validated: yes, "}) {
    EXPECT_NE(ended.out.find(said), std::string::npos) << said << "\n" << ended.out;
  }
  EXPECT_EQ(ended.out.find("NO"), std::string::npos) << ended.out;
}

TEST_F(Recertify, WantsTheCellThatThePlanWasMadeFor) {
  const Ended ended = recertify(file, {"--cell", gantry_cell_file()});
  EXPECT_EQ(ended.status, 2);
  EXPECT_EQ(std::count(ended.err.begin(), ended.err.end(), '\n'), 1) << ended.err;
  EXPECT_NE(ended.err.find("give the --cell that it was made for"), std::string::npos) << ended.err;
}

TEST_F(Recertify, RefusesWhatNobodyChecked) {
  const Ended unchecked = recertify(changed([](Plan& plan) { plan.check_envelopes = false; }));
  EXPECT_EQ(unchecked.status, 1);
  EXPECT_NE(unchecked.out.find("NO, the plan checks no envelopes"), std::string::npos);
  const Ended miscounted = recertify(changed([](Plan& plan) { plan.draws_at_goal = 7; }));
  EXPECT_EQ(miscounted.status, 1);
  EXPECT_NE(miscounted.out.find("validated: NO"), std::string::npos);
  const Ended undrawn = recertify(changed([](Plan& plan) { plan.draws = plan.draws_at_goal = 0; }));
  EXPECT_EQ(undrawn.status, 1);
  EXPECT_NE(undrawn.out.find("validated: NO, the plan is judged by 0 draws, at least 200"),
            std::string::npos);
  EXPECT_EQ(recertify(changed([](Plan& plan) { plan.latency_max_s = 1.0; })).status, 2);
  EXPECT_EQ(recertify(changed([](Plan& plan) { plan.contact_stiffness_Npm *= 10.0; })).status, 2);
}

/// Without what it says of how it was made.
std::string without_badges(const std::string& page) {
  const std::string end = "</ul>";
  const std::size_t from = page.find("<ul class='badges'>");
  const std::size_t to = page.find(end, from);
  if (from == std::string::npos || to == std::string::npos) return "a page without badges";
  return page.substr(0, from) + page.substr(to + end.size());
}

// Planning writes the page of what it has; inspection simulates all of it again.
TEST(PlansPage, OfPlanningIsTheOneOfASimulationMadeAgain) {
  const ScratchFolder folder;
  const auto path = [&](const char* file) { return (folder.path() / file).string(); };
  // How certain the goal has to be follows from the room that it leaves.
  std::string text = config::read_file(in_tree("planner/tasks/box_on_table_2d.yaml"));
  const std::size_t key = text.find("  uncertainty_m2:");
  ASSERT_NE(key, std::string::npos);
  text.erase(key, text.find('\n', key) + 1 - key);
  const std::string task = folder.put("box.yaml", text);
  const Ended planned =
      run(folder, {executable("tenon-plan"), task, "--start", "4", "--cell", gantry_cell_file(),
                   "--draws", "300", "-o", path("plan.tnp"), "--json", path("plan.json"),
                   "--report", path("planned.html")});
  ASSERT_EQ(planned.status, 0) << planned.err;
  const Ended inspected = run(folder, {executable("tenon-inspect"), path("plan.tnp"), "--task",
                                       task, "--cell", gantry_cell_file(), "--statistics",
                                       path("plan.json"), "--report", path("inspected.html")});
  ASSERT_EQ(inspected.status, 0) << inspected.err;
  const std::string by_planning = folder.get("planned.html");
  const std::string again = folder.get("inspected.html");
  EXPECT_GT(by_planning.size(), 100'000U);
  EXPECT_TRUE(without_badges(by_planning) == without_badges(again));
  EXPECT_EQ(by_planning.find("nan'"), std::string::npos);
  EXPECT_NE(again.find("Certified again for this page: the chain holds"), std::string::npos);
  EXPECT_NE(by_planning.find("Certified: the chain holds"), std::string::npos);
  EXPECT_NE(by_planning.find("300 of 300 random starts"), std::string::npos);
}

// The input was good: no usage to mend, but a run that failed.
TEST(InspectProcess, AFullDiskIsAFailureAndNoBadInput) {
  const ScratchFolder folder;
  const std::string json = folder.path() / "plan.json";
  const Ended ended = run(folder, {"prlimit", "--fsize=3000:3000", executable("tenon-inspect"),
                                   shared_plan("box_1_gantry3"), "--json", json});
  EXPECT_EQ(ended.status, 1) << ended.err;
  EXPECT_EQ(ended.err, "tenon-inspect: " + json + ": cannot be written: File too large\n");
  EXPECT_FALSE(std::filesystem::exists(json));
}

}  // namespace
}  // namespace tenon::tests

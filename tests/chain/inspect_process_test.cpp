// tenon-inspect --recertify, as a user runs it.

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

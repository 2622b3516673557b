// Plans for arms whose joints tell the force: refused where they ask for more than the joints
// resolve, and made with thresholds that these allow.

#include <gtest/gtest.h>

#include <chrono>
#include <cstdio>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <utility>
#include <vector>

#include "executor/dry_run/dry_run.h"
#include "executor/dry_run/plan_check.h"
#include "hw/bus_load/bus_load.h"
#include "planner/cell_fit/cell_fit.h"
#include "shared/base/error.h"
#include "tests/support/commands.h"
#include "tests/support/places.h"
#include "tests/support/planned.h"
#include "tests/support/rough_arm.h"
#include "tests/support/scratch_folder.h"

namespace tenon::tests {
namespace {

Cell known_gantry(double residual_N) {
  Cell cell = torque_cell("gantry3");
  cell.joint_torque->joints.assign(3, {.coulomb = 5.0, .viscous = 3.0, .residual = residual_N});
  return cell;
}

TEST(JointTorquePlans, OneThatAsksForMoreThanTheJointsResolveIsRefusedWithTheNumbers) {
  const Plan& plan = box_plan("1");  // force_off 1.5 N
  EXPECT_TRUE(executor::dry_run(plan, known_gantry(1.4)).refusals.empty());
  const executor::DryRun refused = executor::dry_run(plan, known_gantry(2.0));
  ASSERT_EQ(refused.refusals.size(), 1U);
  EXPECT_EQ(refused.refusals[0],
            "step 0: force_off = 1.5 N along x, the joints' efforts resolve 2 N there: must be at "
            "least that; plan with --cell");
  const std::vector<std::string> unknown = executor::check_plan(plan, torque_cell("gantry3"));
  ASSERT_FALSE(unknown.empty());
  EXPECT_NE(unknown[0].find("--identify-friction"), std::string::npos) << unknown[0];
}

// 1.2 * 2 N off, so 9.6 N on: four times as much, as the task has it.
TEST(JointTorquePlans, APlanForTheCellHasThresholdsThatItAllows) {
  const planner::CellFit fit = planner::fit_to_cell(box_task(), known_gantry(2.0));
  const ContactThresholds& t = fit.task.motion.thresholds;
  EXPECT_NEAR(t.force_off_N, 2.4, 1e-3);
  EXPECT_NEAR(t.force_keep_N, 4.8, 2e-3);
  EXPECT_NEAR(t.force_on_N, 9.6, 4e-3);
  const double before_mps =
      planner::fit_to_cell(box_task(), known_gantry(0.5)).task.motion.speeds.contact_mps;
  EXPECT_LE(fit.task.motion.speeds.contact_mps, before_mps);
  try {
    (void)planner::fit_to_cell(box_task(), known_gantry(12.0));
    ADD_FAILURE() << "not refused";
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what())
                  .find("force_limit = 86.3997 N, must be at most the cell's "
                        "faults.force_N = 60 N"),
              std::string::npos)
        << error.what();
  }
}

// Two force frames of at most 8 bytes fewer in every cycle.
TEST(JointTorquePlans, TheBusCarriesNoForceFrames) {
  const hw::BusLoad with = hw::bus_load(gantry_cell().robot);
  const hw::BusLoad without = hw::bus_load(torque_cell("gantry3").robot);
  EXPECT_EQ(with.frames_per_cycle - without.frames_per_cycle, 2U);
  EXPECT_NEAR(with.nominal_bits - without.nominal_bits, 2 * (47 + 64), 1e-9);
}

// From a cell without a sensor to a plan that is executed, by what a user types; only the
// identification is made in virtual time.
class BoxByTorque : public ::testing::TestWithParam<int> {
 protected:
  Ended plan_at(double share) {
    const auto friction = identified(torque_cell("gantry3"), rough_world(share, share, kArm));
    EXPECT_EQ(friction.status, executor::FrictionIdentification::Status::kIdentified);
    (void)folder.put("friction.yaml", executor::friction_file(gantry_cell().robot, friction));
    cell = folder.put("cell.yaml", torque_cell_text("gantry3", "friction.yaml"));
    const std::string of_one_arm = std::to_string(share);
    experiment = folder.put("rough.yaml", "name: rough\ndrive_friction: {share: [" + of_one_arm +
                                              ", " + of_one_arm + "], seed: 7}\n");
    return run(folder, {executable("tenon-plan"), task, "--start", "1", "--cell", cell, "-o",
                        folder.path() / "box.tnp"});
  }
  nlohmann::json evaluate() {
    const std::string json = folder.path() / "evaluated.json";
    std::filesystem::remove(folder.path() / "evaluated.jsonl");
    const Ended ended = run(folder,
                            {executable("tenon-evaluate"), "--cell", cell, "--task", task, "--plan",
                             folder.path() / "box.tnp", "-n", std::to_string(runs), "--seed", "1",
                             "--experiment", experiment, "--json", json},
                            std::chrono::hours(1));
    EXPECT_EQ(ended.status, 0) << ended.err;
    std::printf("%s", ended.out.c_str());
    return nlohmann::json::parse(folder.get("evaluated.json"));
  }

  static constexpr std::uint64_t kArm = 7;
  const int runs = GetParam();
  const ScratchFolder folder;
  const std::string task = in_tree("planner/tasks/box_on_table_2d.yaml");
  std::string cell;
  std::string experiment;
};

// The rougher drives are, the more of the runs stop by name; none is wrong.
TEST_P(BoxByTorque, IsPlannedSlowerAndDone) {
  const std::pair<double, int> cases[] = {{0.02, runs * 98 / 100}, {0.10, runs * 3 / 4}};
  for (const auto& [share, at_least] : cases) {
    const Ended planned = plan_at(share);
    ASSERT_EQ(planned.status, 0) << planned.err;
    EXPECT_NE(planned.out.find("the joints' efforts resolve"), std::string::npos) << planned.out;
    EXPECT_NE(planned.out.find("contact speed 0.05 -> 0.0"), std::string::npos) << planned.out;
    const nlohmann::json result = evaluate();
    const nlohmann::json& summary = result.at("plans")[0].at("summary");
    EXPECT_GE(summary.at("success").at("succeeded").get<int>(), at_least) << share;
    EXPECT_EQ(summary.at("done_but_wrong").get<int>(), 0);
  }
}

INSTANTIATE_TEST_SUITE_P(Tree, BoxByTorque, ::testing::Values(8),
                         ::testing::PrintToStringParamName());
INSTANTIATE_TEST_SUITE_P(Full, BoxByTorque, ::testing::Values(200),
                         ::testing::PrintToStringParamName());

}  // namespace
}  // namespace tenon::tests

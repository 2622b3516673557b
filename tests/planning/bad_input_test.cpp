// Whatever is wrong with the input: exit status 2, one line, and the line names what is wrong.

#include "tests/support/bad_input.h"

#include <gtest/gtest.h>
#include <sys/stat.h>

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "shared/base/crc32c.h"
#include "tests/support/commands.h"
#include "tests/support/places.h"

namespace tenon::tests {
namespace {

std::string with_another_version(const ScratchFolder& folder, std::string plan) {
  plan[4] = 7;
  const std::vector<std::uint8_t> body(plan.begin(), plan.end() - 4);
  const std::uint32_t checksum = crc32c(body);
  for (std::size_t i = 0; i < 4; ++i) {
    plan[body.size() + i] = static_cast<char>(checksum >> 8 * i & 0xFFU);
  }
  return folder.put("version.tnp", plan);
}

TEST(BadInput, OfThePlannerIsOneLineAndStatusTwo) {
  const ScratchFolder folder;
  const auto task = [&](const std::string& name, const std::string& piece,
                        const std::string& instead) {
    return edited(folder, name, box_task_file(), piece, instead);
  };
  const std::string output = folder.path() / "never.tnp";
  const std::string planner = executable("tenon-plan");
  const auto plan = [&](const std::string& file) {
    return std::vector<std::string>{planner, file, "--start", "4", "-o", output};
  };
  const std::vector<BadInput> table = {
      {plan(task("key.yaml", "\ngoal:", "\ngaol: 1\ngoal:")), {"key.yaml:", "gaol", "unknown key"}},
      {plan(task("nan.yaml", "tolerance_m: 2e-3", "tolerance_m: .nan")),
       {"nan.yaml:", "goal.tolerance_m", ".nan", "(0, 1]"}},
      {plan(task("wall.yaml", "[0.30, -0.20, 0.002]", "[0.48, -0.20, 0.002]")),
       {"start '4'", "in collision", "0.4800"}},
      {plan(task("goal.yaml", "[0.25, -0.15, 0.002]", "[0.48, -0.15, 0.002]")),
       {"the goal of task", "in collision", "0.4800"}},
      {plan(task("friction.yaml", "force_keep_N: 3.0", "force_keep_N: 5.0")),
       {"friction.yaml:", "force_on = 6 N", "9.75 N", "force_keep = 5 N"}},
      {plan(folder.path() / "none.yaml"), {"none.yaml", "cannot be read"}},
      {{planner, box_task_file(), "--cell", "none.yaml", "-o", output},
       {"none.yaml", "cannot be read"}},
      {{planner, box_task_file(), "--start", "13", "-o", output}, {"--start 13", "1, 2, 3"}},
      {{planner, box_task_file()}, {"--output", "--help"}},
      {{planner, box_task_file(), "--time-limit", "nan", "-o", output},
       {"--time-limit", "nan", "(0, 86400]"}},
      {{planner, box_task_file(), "--move-limit", "0", "-o", output}, {"--move-limit", "0"}},
      {{planner, "--check", box_task_file(), "--json", "-"}, {"--json", "--check", "leave it out"}},
      {{planner, "--check", box_task_file(), "-o", output}, {"--output", "--check"}},
      {{planner, "--check", box_task_file(), "--cell", box_task_file()},
       {"is a task file, not a cell file"}},
      {{planner, "--new-task", "a.stl", "b.stl", "--cell", gantry_cell_file(), "-o", output},
       {"--cell", "--new-task", "leave it out"}},
      {{planner, box_task_file(), "-o", "nowhere/x.tnp"}, {"nowhere/x.tnp", "written"}},
      {{executable("tenon-sim"), "--cell", gantry_cell_file(), "--task", box_task_file(), "--can",
        "slcan-listen://127.0.0.1:0", "--seed", "-1"},
       {"--seed", "-1"}},
      {{executable("tenon-sim"), "--cell", gantry_cell_file(), "--task", box_task_file(), "--can",
        "slcan-listen://127.0.0.1:0", "--json", "nowhere/truth.json"},
       {"nowhere/truth.json", "written"}},
      {{planner, box_task_file(), "--hurry", "-o", output}, {"--hurry", "--help"}},
  };
  for (const BadInput& bad : table) expect_refused(folder, bad);
  EXPECT_FALSE(std::filesystem::exists(output));
}

// The plan of start 4, whole and spoilt.
struct PlanFiles {
  explicit PlanFiles(const ScratchFolder& folder)
      : whole(put_box_plan(folder, "4")),
        other_version(with_another_version(folder, folder.get("start_4.tnp"))) {
    const std::string bytes = folder.get("start_4.tnp");
    truncated = folder.put("short.tnp", bytes.substr(0, bytes.size() - 20));
  }
  std::string whole;
  std::string other_version;
  std::string truncated;
};

constexpr const char* kNobody = "slcan://127.0.0.1:1";

std::vector<std::string> execute(const std::string& cell, const std::string& plan,
                                 const std::string& can) {
  return {executable("tenon-exec"),
          "--cell",
          cell,
          "--plan",
          plan,
          "--can",
          can,
          "--rt",
          "off",
          "--lcm-url",
          "none"};
}

TEST(BadInput, OfTheExecutorIsOneLineAndStatusTwo) {
  const ScratchFolder folder;
  const std::string cell = gantry_cell_file();
  const PlanFiles plans(folder);
  const std::string& plan = plans.whole;
  const std::string exec = executable("tenon-exec");
  const std::vector<BadInput> table = {
      {execute(cell, folder.path() / "none.tnp", kNobody), {"none.tnp", "cannot be read"}},
      {execute("none.yaml", plan, kNobody), {"none.yaml", "cannot be read"}},
      {execute(cell, plans.other_version, kNobody), {"version.tnp", "version", "plan again"}},
      {execute(cell, plans.truncated, kNobody), {"short.tnp", "length", "cut off"}},
      {execute(cell, cell, kNobody),
       {"gantry3.yaml", "is a cell file, not a plan file", "goes with --cell"}},
      {execute(cell, plan, kNobody), {kNobody, "cannot connect", "tenon-sim"}},
      {execute(cell, plan, "socketcan:nosuch0"), {"socketcan:nosuch0"}},
      {execute(cell, plan, "slcan-listen://127.0.0.1:0"), {"slcan-listen", "slcan://HOST:PORT"}},
      {execute(cell, plan, "nonsense:uri"), {"nonsense:uri", "socketcan:", "slcan:"}},
      {{exec, "--cell", cell, "--plan", plan}, {"--can", "--dry-run"}},
      {{exec, "--cell", cell, "--plan", plan, "--can", kNobody, "--lcm-url",
        "upd://239.255.76.67:7667"},
       {"--lcm-url upd://239.255.76.67:7667", "udpm://"}},
      {{exec, "--cell", cell, "--plan", plan, "--can", kNobody, "--lcm-url",
        "udpm://10.1.2.3:7667"},
       {"10.1.2.3:7667", "multicast group"}},
  };
  for (const BadInput& bad : table) expect_refused(folder, bad);
}

// What is written would destroy what is read, or what another option writes.
TEST(BadInput, OneFileForTwoOptionsIsRefusedBeforeAnythingMoves) {
  const ScratchFolder folder;
  const std::string plan = put_box_plan(folder, "4");
  const std::string same = folder.path() / "run.x";
  const std::string link = folder.path() / "link";
  std::filesystem::create_symlink("run.x", link);
  const std::string planner = executable("tenon-plan");
  const auto with = [](std::vector<std::string> command, const std::vector<std::string>& more) {
    command.insert(command.end(), more.begin(), more.end());
    return command;
  };
  const std::vector<std::string> exec = execute(gantry_cell_file(), plan, kNobody);
  const std::vector<std::string> sim = {
      executable("tenon-sim"), "--cell", gantry_cell_file(),          "--task",
      box_task_file(),         "--can",  "slcan-listen://127.0.0.1:0"};
  const std::vector<BadInput> table = {
      {with(exec, {"--log", same, "--json", same}), {"--log", "--json", same}},
      {with(exec, {"--can-log", same, "--trace", link}), {"--can-log", "--trace", "run.x"}},
      {with(exec, {"--json", folder.path() / "start_4.tnp"}), {"--plan", "--json"}},
      {with(exec, {"--dry-run", "--json", plan}), {"--plan", "--json"}},
      {with(sim, {"--json", same, "--ready-file", same}), {"--json", "--ready-file"}},
      {{planner, box_task_file(), "-o", same, "--json", link}, {"--output", "--json"}},
      {{executable("tenon-inspect"), plan, "--json", plan}, {"--json", "plan"}},
  };
  for (const BadInput& bad : table) expect_refused(folder, bad);
  EXPECT_FALSE(std::filesystem::exists(same));
}

// Opening a pipe would wait for whoever writes into it.
TEST(BadInput, APipeADeviceOrAFolderWhereAFileIsReadIsRefusedWithoutWaiting) {
  const ScratchFolder folder;
  const std::string plan = put_box_plan(folder, "4");
  const std::string pipe = folder.path() / "pipe";
  ASSERT_EQ(::mkfifo(pipe.c_str(), 0600), 0);
  const std::string cell = gantry_cell_file();
  for (const std::string& other : {pipe, std::string("/dev/zero"), folder.path().string()}) {
    const std::vector<BadInput> table = {
        {execute(other, plan, kNobody), {other, "not a regular file"}},
        {execute(cell, other, kNobody), {other, "not a regular file"}},
        {{executable("tenon-plan"), other, "-o", folder.path() / "never.tnp"},
         {other, "not a regular file"}},
        {{executable("tenon-inspect"), other}, {other, "not a regular file"}},
        {{executable("tenon-evaluate"), "--cell", cell, "--task", box_task_file(), "--plan", plan,
          "--seed", "1", "-n", "1", "--runs", other},
         {other, "not a regular file"}},
        {{executable("tenon-evaluate"), "--cell", cell, "--task", box_task_file(), "--plan", plan,
          "--seed", "1", "-n", "1", "--experiment", other},
         {other, "not a regular file"}},
    };
    for (const BadInput& bad : table) expect_refused(folder, bad);
  }
}

TEST(BadInput, ACellThatThePlanDoesNotFitIsNamedWithBothNumbers) {
  const ScratchFolder folder;
  const std::string plan = put_box_plan(folder, "4");
  const std::string robot = robot_file();
  const auto cell_with = [&](const char* name, const char* piece, const char* instead) {
    return edited(folder, name, cell_around(folder, "plain.yaml", robot), piece, instead);
  };
  const std::string stiff =
      cell_with("stiff.yaml", "contact_stiffness_Npm: 5e4", "contact_stiffness_Npm: 5e5");
  const std::string far =
      cell_with("far.yaml", "position_m: [0.10, 0.05, 0.0]", "position_m: [0.90, 0.05, 0.0]");
  const std::string slow = cell_around(
      folder, "slow.yaml",
      edited(folder, "lag.yaml", robot, "response_lag_s: 0.004", "response_lag_s: 0.010"));
  const std::vector<BadInput> table = {
      // D = 1500 Ns/m against 1.5 * 5e5 N/m * 7 ms.
      {execute(stiff, plan, kNobody), {"damping", "1500", "5250"}},
      // (1 + 1/2) * 2 ms + 10 ms against 7 ms.
      {execute(slow, plan, kNobody), {"latency", "0.013 s", "0.007 s"}},
      // 0.3 m from a task that stands 0.9 m away, for a joint that ends at 0.8 m.
      {{executable("tenon-exec"), "--cell", far, "--plan", plan, "--dry-run"},
       {"start '4'", "joint x", "1.2000 m", "[-0.8, 0.8]"}},
  };
  for (const BadInput& bad : table) expect_refused(folder, bad);
}

TEST(BadInput, OfInspectorMonitorAndBusToolIsOneLineAndStatusTwo) {
  const ScratchFolder folder;
  const PlanFiles plans(folder);
  const std::string inspect = executable("tenon-inspect");
  const std::string can = executable("tenon-can");
  const std::string robot = in_tree("hw/robots/epos4/robot.yaml");
  const std::string twin = in_tree("tests/twins/epos4.eds");
  const std::vector<BadInput> table = {
      {{executable("tenon-monitor"), "--lcm-url", "udpm:/239.255.76.67"},
       {"udpm:/239.255.76.67", "udpm://"}},
      {{inspect, folder.path() / "none.tnp"}, {"none.tnp", "cannot be read"}},
      {{inspect, plans.other_version}, {"version.tnp", "version"}},
      {{inspect, plans.whole, "--cell", gantry_cell_file()}, {"--cell", "--recertify"}},
      {{inspect}, {"plan", "--help"}},
      {{can, "--can", kNobody, "scan"}, {kNobody, "cannot connect"}},
      {{can, "--can", "socketcan:nosuch0", "scan"}, {"socketcan:nosuch0"}},
      {{can, "--can", "nonsense:uri", "scan"}, {"nonsense:uri"}},
      {{can, "scan"}, {"--can", "--help"}},
      {{can, "check", robot, "--eds", robot}, {"robot.yaml:1", "no object"}},
      {{can, "check", robot, "--eds", "9=" + twin}, {"9=", "no joint"}},
      {{can, "check", robot, "--eds", twin, "--eds", twin}, {"epos4.eds", "its node"}},
  };
  for (const BadInput& bad : table) expect_refused(folder, bad);
}

// Each was typed by somebody who had it nearly right.
TEST(BadInput, WhatIsGivenInAnothersPlaceIsToldWhereItGoes) {
  const ScratchFolder folder;
  const std::string cell = gantry_cell_file();
  const std::string shortened = cell.substr(0, cell.size() - std::string(".yaml").size());
  const std::string log = folder.put("run.lcmlog", std::string("\xED\xA1\xDA\x01") + "\x01\x02");
  const std::string words = folder.put("words.txt", "no plan\n");
  const std::string exec = executable("tenon-exec");
  const std::string inspect = executable("tenon-inspect");
  const std::string planner = executable("tenon-plan");
  const std::string out = folder.path() / "out.tnp";
  const std::vector<BadInput> table = {
      {{inspect, box_task_file()},
       {"box_on_table_2d.yaml", "is a task file, not a plan file", "first with tenon-plan"}},
      {{inspect, log}, {"run.lcmlog", "is a log of messages", "--log"}},
      {{inspect, words}, {"words.txt", "is not a plan file", "tenon-plan -o"}},
      {{planner, log, "-o", out}, {"run.lcmlog", "is a log of messages", "a YAML file"}},
      {{planner, box_task_file(), "--cell", shortened, "-o", out},
       {"gantry3: cannot be read", "did you mean gantry3.yaml?"}},
      {{exec, "--cell", cell, "run.tnp"}, {"run.tnp", "a plan goes with --plan"}},
      {{executable("tenon-monitor"), "exprt", log}, {"exprt", "did you mean export?"}},
      {{executable("tenon-monitor"), "run.lcmlog"}, {"--lcm-url file://run.lcmlog"}},
      {{executable("tenon-monitor"), "export", "--lcm-url", "x"}, {"--lcm-url", "not here"}},
      {{executable("tenon-can"), "--can", kNobody, "scna"}, {"scna", "did you mean scan?"}},
  };
  for (const BadInput& bad : table) expect_refused(folder, bad);
}

}  // namespace
}  // namespace tenon::tests

// Whatever is wrong with the input: exit status 2, one line, and the line names what is wrong.

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <stdexcept>
#include <string>
#include <vector>

#include "shared/base/crc32c.h"
#include "tests/chain/commands.h"
#include "tests/support/sim_process.h"

namespace tenon::tests {
namespace {

struct BadInput {
  std::vector<std::string> command;
  std::vector<std::string> named;  ///< all of it stands in the line
};

void expect_refused(const ScratchFolder& folder, const BadInput& bad) {
  SCOPED_TRACE(::testing::PrintToString(bad.command));
  const Ended ended = run(folder, bad.command);
  EXPECT_EQ(ended.status, 2);
  EXPECT_EQ(std::count(ended.err.begin(), ended.err.end(), '\n'), 1) << ended.err;
  EXPECT_TRUE(ended.err.ends_with('\n'));
  const std::string program = bad.command[0].substr(bad.command[0].rfind('/') + 1);
  EXPECT_EQ(ended.err.rfind(program + ": ", 0), 0U) << ended.err;
  for (const std::string& name : bad.named) {
    EXPECT_NE(ended.err.find(name), std::string::npos) << "no '" << name << "' in: " << ended.err;
  }
}

// A copy of a file of the tree in which one piece of text is another.
std::string edited(const ScratchFolder& folder, const std::string& name, const std::string& source,
                   const std::string& piece, const std::string& instead) {
  std::ostringstream all;
  all << std::ifstream(source).rdbuf();
  std::string text = all.str();
  const std::size_t at = text.find(piece);
  if (at == std::string::npos) throw std::runtime_error(source + " holds no " + piece);
  text.replace(at, piece.size(), instead);
  return folder.put(name, text);
}

// The gantry's cell around another robot file, which finds the gantry's URDF beside itself.
std::string cell_around(const ScratchFolder& folder, const std::string& name,
                        const std::string& robot_file) {
  (void)edited(folder, "gantry3.urdf", TENON_SOURCE_DIR "/hw/robots/gantry3/gantry3.urdf", "", "");
  return edited(folder, name, gantry_cell_file(), "../robots/gantry3/robot.yaml", robot_file);
}

std::string robot_file() { return TENON_SOURCE_DIR "/hw/robots/gantry3/robot.yaml"; }

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
  const auto plan = [&](const std::string& file) {
    return std::vector<std::string>{TENON_PLAN_EXE, file, "--start", "4", "-o", output};
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
      {{TENON_PLAN_EXE, box_task_file(), "--cell", "none.yaml", "-o", output},
       {"none.yaml", "cannot be read"}},
      {{TENON_PLAN_EXE, box_task_file(), "--start", "13", "-o", output}, {"--start 13", "1, 2, 3"}},
      {{TENON_PLAN_EXE, box_task_file()}, {"--output", "--help"}},
      {{TENON_PLAN_EXE, box_task_file(), "--time-limit", "nan", "-o", output},
       {"--time-limit", "nan", "(0, 86400]"}},
      {{TENON_PLAN_EXE, box_task_file(), "-o", "nowhere/x.tnp"}, {"nowhere/x.tnp", "written"}},
      {{TENON_SIM_EXE, "--cell", gantry_cell_file(), "--task", box_task_file(), "--can",
        "slcan-listen://127.0.0.1:0", "--seed", "-1"},
       {"--seed", "-1"}},
      {{TENON_SIM_EXE, "--cell", gantry_cell_file(), "--task", box_task_file(), "--can",
        "slcan-listen://127.0.0.1:0", "--json", "nowhere/truth.json"},
       {"nowhere/truth.json", "written"}},
      {{TENON_PLAN_EXE, box_task_file(), "--hurry", "-o", output}, {"--hurry", "--help"}},
  };
  for (const BadInput& bad : table) expect_refused(folder, bad);
  EXPECT_FALSE(std::filesystem::exists(output));
}

TEST(BadInput, OfExecutorInspectorAndBusToolIsOneLineAndStatusTwo) {
  const ScratchFolder folder;
  const std::string cell = gantry_cell_file();
  const std::string plan = plan_by_command(folder, "4");
  const std::string bytes = folder.get("start_4.tnp");
  const std::string other_version = with_another_version(folder, bytes);
  const std::string truncated = folder.put("short.tnp", bytes.substr(0, bytes.size() - 20));
  const std::string nobody = "slcan://127.0.0.1:1";
  const auto execute = [](const std::string& in_cell, const std::string& file,
                          const std::string& can) {
    return std::vector<std::string>{TENON_EXEC_EXE, "--cell",    in_cell, "--plan",
                                    file,           "--can",     can,     "--rt",
                                    "off",          "--lcm-url", "none"};
  };

  const std::string robot = robot_file();
  const std::string stiff = edited(folder, "stiff.yaml", cell_around(folder, "plain.yaml", robot),
                                   "contact_stiffness_Npm: 5e4", "contact_stiffness_Npm: 5e5");
  const std::string far = edited(folder, "far.yaml", cell_around(folder, "plain.yaml", robot),
                                 "position_m: [0.10, 0.05, 0.0]", "position_m: [0.90, 0.05, 0.0]");
  const std::string slow = cell_around(
      folder, "slow.yaml",
      edited(folder, "lag.yaml", robot, "response_lag_s: 0.004", "response_lag_s: 0.010"));

  const std::vector<BadInput> table = {
      {execute(cell, folder.path() / "none.tnp", nobody), {"none.tnp", "cannot be read"}},
      {execute("none.yaml", plan, nobody), {"none.yaml", "cannot be read"}},
      {execute(cell, other_version, nobody), {"version.tnp", "version", "plan again"}},
      {execute(cell, truncated, nobody), {"short.tnp", "length", "cut off"}},
      {execute(cell, cell, nobody), {"gantry3.yaml", "not a plan file"}},
      // D = 1500 Ns/m against 1.5 * 5e5 N/m * 7 ms.
      {execute(stiff, plan, nobody), {"damping", "1500", "5250"}},
      // (1 + 1/2) * 2 ms + 10 ms against 7 ms.
      {execute(slow, plan, nobody), {"latency", "0.013 s", "0.007 s"}},
      {execute(cell, plan, nobody), {nobody, "cannot connect", "tenon-sim"}},
      {execute(cell, plan, "socketcan:nosuch0"), {"socketcan:nosuch0"}},
      {execute(cell, plan, "slcan-listen://127.0.0.1:0"), {"slcan-listen", "slcan://HOST:PORT"}},
      {execute(cell, plan, "nonsense:uri"), {"nonsense:uri", "socketcan:", "slcan:"}},
      {{TENON_EXEC_EXE, "--cell", cell, "--plan", plan}, {"--can", "--dry-run"}},
      {{TENON_EXEC_EXE, "--cell", cell, "--plan", plan, "--can", nobody, "--lcm-url",
        "upd://239.255.76.67:7667"},
       {"--lcm-url upd://239.255.76.67:7667", "udpm://"}},
      {{TENON_EXEC_EXE, "--cell", cell, "--plan", plan, "--can", nobody, "--lcm-url",
        "udpm://10.1.2.3:7667"},
       {"10.1.2.3:7667", "multicast group"}},
      {{TENON_MONITOR_EXE, "--lcm-url", "udpm:/239.255.76.67"}, {"udpm:/239.255.76.67", "udpm://"}},
      // 0.3 m from a task that stands 0.9 m away, for a joint that ends at 0.8 m.
      {{TENON_EXEC_EXE, "--cell", far, "--plan", plan, "--dry-run"},
       {"start '4'", "joint x", "1.2000 m", "[-0.8, 0.8]"}},
      {{TENON_INSPECT_EXE, folder.path() / "none.tnp"}, {"none.tnp", "cannot be read"}},
      {{TENON_INSPECT_EXE, other_version}, {"version.tnp", "version"}},
      {{TENON_INSPECT_EXE}, {"plan", "--help"}},
      {{TENON_CAN_EXE, "--can", nobody, "scan"}, {nobody, "cannot connect"}},
      {{TENON_CAN_EXE, "--can", "socketcan:nosuch0", "scan"}, {"socketcan:nosuch0"}},
      {{TENON_CAN_EXE, "--can", "nonsense:uri", "scan"}, {"nonsense:uri"}},
  };
  for (const BadInput& bad : table) expect_refused(folder, bad);
}

TEST(BadInput, ADriveThatDoesNotAnswerIsNamedWithWhatWasExpected) {
  const ScratchFolder folder;
  const std::string elsewhere =
      cell_around(folder, "elsewhere.yaml",
                  edited(folder, "robot.yaml", robot_file(), "    node: 3\n", "    node: 30\n"));
  SimProcess sim(folder.path(), "4", {}, elsewhere);
  expect_refused(folder, {{TENON_EXEC_EXE, "--cell", gantry_cell_file(), "--plan",
                           plan_by_command(folder, "4"), "--can", sim.uri(), "--rt", "off",
                           "--lcm-url", "none"},
                          {"node 3 (z)", "expected 0x703"}});
}

}  // namespace
}  // namespace tenon::tests

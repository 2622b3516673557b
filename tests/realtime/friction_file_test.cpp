// What becomes of an identification whose file cannot be written in the end: minutes of motion that
// are told all the same. Repeated where the machine was too busy for real time.

#include <gtest/gtest.h>

#include <chrono>
#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>

#include "tests/support/bad_input.h"
#include "tests/support/busy_machine.h"
#include "tests/support/child_process.h"
#include "tests/support/places.h"
#include "tests/support/scratch_folder.h"

namespace tenon::tests {
namespace {

/// The gantry above its table, with room around it, and the force from its drives.
struct Measured {
  ScratchFolder folder;
  int status = 0;
  std::string out;
  std::string err;
  nlohmann::json result;

  Measured() {
    const std::string cell =
        edited(folder, "cell.yaml", cell_around(folder, "gantry.yaml", robot_file()),
               "payload:", "joint_torque: {}\npayload:");
    const std::string task = edited(folder, "task.yaml", box_task_file(), "[-0.30, -0.20, 0.002]",
                                    "[-0.30, -0.20, 0.09]");
    const std::filesystem::path place = folder.path() / "place";
    std::filesystem::create_directory(place);
    ChildProcess sim(folder.path(), {executable("tenon-sim"), "--cell", cell, "--task", task,
                                     "--can", "slcan-listen://127.0.0.1:0", "--once"});
    if (!sim.wait_until([&] { return sim.out().ends_with('\n'); })) return;
    const std::string said = sim.out();
    const int port = std::stoi(said.substr(said.rfind(':') + 1));
    ChildProcess exec(folder.path(),
                      {executable("tenon-exec"), "--cell", cell, "--can",
                       "slcan://127.0.0.1:" + std::to_string(port), "--lcm-url", "none", "--json",
                       folder.path() / "result.json", "--black-box", folder.path() / "box.csv",
                       "--identify-friction", place / "friction.yaml"});
    if (!exec.wait_until([&] { return exec.out().find("identifying") != std::string::npos; }))
      return;
    std::filesystem::rename(place, folder.path() / "elsewhere");
    status = exec.wait(std::chrono::minutes(5));
    out = exec.out();
    err = exec.err();
    result = nlohmann::json::parse(folder.get("result.json"), nullptr, false);
  }
};

TEST(FrictionFile, ThatCannotBeWrittenTakesNothingOfTheRunWithIt) {
  Attempts attempts;
  std::unique_ptr<Measured> run;
  do {
    run = std::make_unique<Measured>();
  } while (run->status == 1 && run->result.is_object() && attempts.again(run->result));
  EXPECT_EQ(run->status, 1);
  EXPECT_NE(run->out.find("done: "), std::string::npos) << run->out;
  EXPECT_NE(run->err.find("tenon-exec: lost: --identify-friction "), std::string::npos) << run->err;
  EXPECT_NE(run->err.find("No such file or directory"), std::string::npos) << run->err;
  ASSERT_TRUE(run->result.is_object()) << run->err;
  EXPECT_EQ(run->result.at("reason"), "measured");
  EXPECT_EQ(run->result.at("exit_code"), 1);
  EXPECT_EQ(run->result.at("finding").at("status"), "identified");
  const nlohmann::json& record = run->result.at("records").back();
  EXPECT_EQ(record.at("name"), "identify_friction");
  EXPECT_EQ(record.at("lost"), 1);
}

}  // namespace
}  // namespace tenon::tests

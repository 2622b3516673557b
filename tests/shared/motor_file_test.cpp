// Motors in MIT mode as robot files give them, and every way to write one wrongly.

#include <gtest/gtest.h>

#include <filesystem>
#include <string>

#include "shared/config/files.h"
#include "shared/config/load.h"
#include "shared/mit/robot_motors.h"
#include "tests/support/places.h"
#include "tests/support/refusal.h"
#include "tests/support/scratch_folder.h"

namespace tenon {
namespace {

/// mit6's robot or cell file with the first `piece` another.
Cell altered(const std::string& which, const std::string& piece, const std::string& instead) {
  const tests::ScratchFolder folder;
  namespace fs = std::filesystem;
  fs::create_directories(folder.path() / "robots");
  fs::create_directories(folder.path() / "cells");
  fs::copy(tests::in_tree("hw/robots/mit6"), folder.path() / "robots/mit6");
  fs::copy(tests::in_tree("hw/cells/mit6.yaml"), folder.path() / "cells/mit6.yaml");
  std::string text = config::read_file(folder.path() / which);
  const std::size_t at = text.find(piece);
  EXPECT_NE(at, std::string::npos) << piece;
  text.replace(at, piece.size(), instead);
  write_file(folder.path() / which, text);
  return load_cell(folder.path() / "cells/mit6.yaml");
}

/// How that is refused, without the folder.
std::string refused(const std::string& which, const std::string& piece,
                    const std::string& instead) {
  return tests::refusal([&] { (void)altered(which, piece, instead); });
}

std::string of_robot(const std::string& piece, const std::string& instead) {
  return refused("robots/mit6/robot.yaml", piece, instead);
}

void expect_told(const std::string& line, const std::string& what) {
  EXPECT_NE(line.find(what), std::string::npos) << line;
  EXPECT_EQ(line.find('\n'), std::string::npos) << line;
}

TEST(MotorFile, SaysWhatTheMotorIsAndThatNothingHoldsIt) {
  const Robot robot = load_robot(tests::in_tree("hw/robots/mit6/robot.yaml"));
  EXPECT_TRUE(speaks_mit(robot));
  EXPECT_FALSE(robot.brakes);
  ASSERT_EQ(robot.joints.size(), 6U);
  const MitMotor& motor = mit_motor(robot.joints[3]);
  EXPECT_EQ(robot.joints[3].node, 4);
  EXPECT_EQ(motor.feedback_id, 0x14U);
  EXPECT_EQ(motor.position_max_rad, 3.2);
  EXPECT_EQ(motor.stiffness_Nmprad, 300.0);
  EXPECT_EQ(motor.watchdog_ms, 20U);
  // 65535 counts over 6.4 rad, its middle at 0.
  EXPECT_NEAR(robot.joints[3].counts_per_unit, 10239.84375, 1e-9);
  EXPECT_NEAR(robot.joints[3].zero_counts, 32767.5, 1e-9);
  EXPECT_FALSE(speaks_mit(load_robot(tests::in_tree("hw/robots/csp6/robot.yaml"))));
}

// The URDF allows 1.26 rad/s and 40 Nm.
TEST(MotorFile, AMotorsRangesBoundWhatTheJointIsAllowed) {
  const auto first_with = [](const std::string& piece, const std::string& instead) {
    return altered("robots/mit6/robot.yaml", piece, instead).robot.joints.front();
  };
  EXPECT_EQ(first_with("velocity_max_radps: 5.0", "velocity_max_radps: 5.0").speed_max, 1.26);
  EXPECT_EQ(first_with("velocity_max_radps: 5.0", "velocity_max_radps: 0.5").speed_max, 0.5);
  EXPECT_EQ(first_with("torque_max_Nm: 40.0", "torque_max_Nm: 30").effort_max, 30.0);
}

TEST(MotorFile, AnIdentifierMayStandInHexadecimalAsTheMakersToolHasIt) {
  EXPECT_EQ(of_robot("feedback_id: 19", "feedback_id: 0x13"), "accepted");
  expect_told(of_robot("feedback_id: 19", "feedback_id: 0x7FF"), "[1, 2046]");
  expect_told(of_robot("feedback_id: 19", "feedback_id: 0x"), "an integer");
  expect_told(of_robot("feedback_id: 19", "feedback_id: 0x1G"), "an integer");
}

TEST(MotorFile, EveryValueOutOfItsRangeIsRefusedByFileAndKey) {
  expect_told(of_robot("protocol: mit", "protocol: mitt"), "protocol");
  expect_told(of_robot("node: 3", "node: 16"), "[1, 15]");
  expect_told(of_robot("node: 3", "node: 2"), "a number that nothing else uses");
  expect_told(of_robot("feedback_id: 19", "feedback_id: 2047"), "[1, 2046]");
  expect_told(of_robot("kp_Nmprad: 500.0", "kp_Nmprad: 501"), "kp_Nmprad");
  expect_told(of_robot("kd_Nmsprad: 5.0", "kd_Nmsprad: 5.1"), "kd_Nmsprad");
  expect_told(of_robot("torque_max_Nm: 40.0", "torque_max_Nm: -1"), "torque_max_Nm");
  expect_told(of_robot("rated_effort_Nm: 20.0", "rated_effort_Nm: 41"), "rated_effort_Nm");
  expect_told(of_robot("watchdog_ms: 20", "watchdog_ms: 0"), "watchdog_ms");
  expect_told(of_robot("position_max_rad: 3.2", "position_max_rad: 2.9"), "the joint goes to");
  expect_told(of_robot("kp_Nmprad: 500.0", "mode: 8"), "mode");
  expect_told(of_robot("master_node: 127", "master_node: 127\n  targets_per_frame: 2"), "[1, 1]");
}

TEST(MotorFile, ACellHasToSayThatItBearsTheFall) {
  const std::string cell = "cells/mit6.yaml";
  expect_told(refused(cell, "falls_without_power: true\n", ""), "has no brakes and falls");
  expect_told(refused(cell, "falls_without_power: true", "falls_without_power: false"),
              "has no brakes and falls");
  expect_told(refused(cell, "falls_without_power: true",
                      "falls_without_power: true\non_brake_failure: hold"),
              "has no brakes");
  expect_told(of_robot("protocol: mit", "protocol: canopen"), "robot.yaml");
}

}  // namespace
}  // namespace tenon

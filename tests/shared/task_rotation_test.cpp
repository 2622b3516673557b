// What a task says of rotation, and what follows from it.

#include <gtest/gtest.h>

#include <numbers>
#include <string>

#include "shared/config/load.h"
#include "shared/task/inserted.h"
#include "tests/shared/slide_robot.h"
#include "tests/support/refusal.h"
#include "tests/support/scratch_folder.h"

namespace tenon {
namespace {

using tests::ScratchFolder;

constexpr const char* kTask = R"(name: turning
coordinates: [COORDINATES]
held:
  - {name: part, box_m: [0.1, 0.1, 0.1], pose: {position_m: [0, 0, 0.05]}}
environment:
  - {name: wall, box_m: [0.1, 1.0, 0.1], pose: {position_m: [0.5, 0, 0.05]}}
starts:
  - {name: "1", pose: {position_m: [0, 0, 0]}, sigma_m: [0.01, 0.01]SIGMA}
goal: {pose: {position_m: [0.2, 0, 0]}, tolerance_m: 2e-3}
speeds: {approach_mps: 0.10, contact_mps: 0.05}
contact: {force_on_N: 6, force_keep_N: 3, force_off_N: 1.5, debounce_s: 0.006, force_limit_N: 20MORE}
compliance: {axes: [AXES], mass_kg: 2, damping_Nspm: 1500, stiffness_Npm: 1000}
physics: {friction: {low: 0.1, nominal: 0.3, high: 0.6}, contact_stiffness_Npm: 5e4}
)";

std::string with(const std::string& coordinates, const std::string& axes,
                 const std::string& contact = "", const std::string& more = "") {
  const bool turns = coordinates.find("rz") != std::string::npos;
  std::string text = tests::replaced(kTask, "COORDINATES", coordinates);
  text = tests::replaced(text, "SIGMA", turns ? ", sigma_rad: [0.03]" : "");
  text = tests::replaced(text, "MORE", contact);
  return tests::replaced(text, "AXES", axes) + more;
}

Task loaded(const std::string& text) {
  const ScratchFolder folder;
  return load_task(folder.put("task.yaml", text));
}

TEST(TaskRotation, ATorqueIsSensedWhereItHasAThreshold) {
  EXPECT_EQ(loaded(with("x, y", "x, y")).motion.sensed_axes, 0x3F);
  EXPECT_EQ(loaded(with("x, y", "x, y, rz")).motion.sensed_axes, 0b011111);
  EXPECT_EQ(loaded(with("x, y", "x, y, rz", ", torque_on_Nm: 0.7")).motion.sensed_axes, 0x3F);
}

TEST(TaskRotation, TheToolCarriesTheAxesOfATaskThatTurns) {
  EXPECT_FALSE(loaded(with("x, y", "x, y, rz")).motion.carried_axes);
  EXPECT_TRUE(loaded(with("x, y, rz", "x, y, rz")).motion.carried_axes);
}

TEST(TaskRotation, AnErrorTurnsAboutTheOriginUnlessAPointIsNamed) {
  EXPECT_EQ(loaded(with("x, y, rz", "x, y, rz")).error_about_m, Vector3::Zero());
  const Task task = loaded(with("x, y, rz", "x, y, rz", "", "error_about_m: [0.5, 0, -0.1]\n"));
  EXPECT_EQ(task.error_about_m, Vector3(0.5, 0.0, -0.1));
  const ScratchFolder folder;
  const auto file =
      folder.put("far.yaml", with("x, y, rz", "x, y, rz", "", "error_about_m: [500, 0, 0]\n"));
  EXPECT_EQ(
      tests::refusal([&] { (void)load_task(file); }),
      file.string() +
          ":14: error_about_m[0] = 500, must be in [-100, 100]; is it in mm? then write 0.5 m");
}

// An angle weighs 0.1 m a rad unless the task says otherwise: 2 mm are 20 mrad.
TEST(TaskRotation, TheGoalIsJudgedByTheFullPose) {
  const auto stands = [](const Task& task, double x_m, double turned_rad) {
    return within_tolerance(
        task, displaced(task.goal, (Vector6() << x_m, 0.0, 0.0, 0.0, 0.0, turned_rad).finished()));
  };
  const Task turning = loaded(with("x, y, rz", "x, y, rz"));
  EXPECT_TRUE(stands(turning, 0.0, 0.0199));
  EXPECT_FALSE(stands(turning, 0.0, 0.0201));
  EXPECT_TRUE(stands(turning, 0.9e-3, 0.0109));
  EXPECT_FALSE(stands(turning, 1.1e-3, 0.0109));
  // An axis of its own counts by itself, and one that is free not at all.
  Task own = turning;
  own.goal_axes.tolerance[5] = 0.05;
  EXPECT_TRUE(stands(own, 1.9e-3, 0.049));
  EXPECT_FALSE(stands(own, 0.0, 0.051));
  EXPECT_FALSE(stands(own, 2.1e-3, 0.0));
  Task free = turning;
  free.goal_axes.free = 0b100000;
  EXPECT_TRUE(stands(free, 1.9e-3, 1.0));
  EXPECT_FALSE(stands(free, 2.1e-3, 1.0));
  // Where no coordinate turns, a tilt is the cell's, not the plan's.
  EXPECT_TRUE(stands(loaded(with("x, y", "x, y")), 1.9e-3, 0.1));
}

}  // namespace
}  // namespace tenon

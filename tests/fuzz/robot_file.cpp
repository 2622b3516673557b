// A cell, the robot that it names and the robot's URDF, of which the input is one: its first byte
// picks which, the others are as they should be.

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

#include "shared/config/load.h"
#include "shared/ports/arm.h"
#include "tests/fuzz/support/refused.h"

namespace {

using namespace tenon;
using fuzz::must;

constexpr std::string_view kUrdf = R"(<robot name="slide"><link name="base"/>
<link name="carriage"><inertial><mass value="2"/>
<inertia ixx="0.01" ixy="0" ixz="0" iyy="0.01" iyz="0" izz="0.01"/></inertial></link>
<joint name="x" type="prismatic"><parent link="base"/><child link="carriage"/><axis xyz="1 0 0"/>
<limit lower="-0.5" upper="0.5" velocity="1" effort="200"/></joint></robot>)";

constexpr std::string_view kRobot = R"(name: slide
urdf: robot.urdf
bus: {bitrate_bps: 1000000, cycle_us: 2000, heartbeat_ms: 50, heartbeat_timeout_ms: 150, master_node: 127}
arm: {response_lag_s: 0.004, stiffness_Npm: 1e5, measurement_delay_cycles: 1}
joints:
  - {name: x, node: 1, mode: 8, counts_per_m: 1e6, acceleration_max_mps2: 5, rated_effort_N: 100,
     following_error_max_m: 0.01, stiffness_Npm: 1e6}
sensor: {node: 4, force_per_count_N: 0.01, torque_per_count_Nm: 0.0005, force_range_N: 300,
         torque_range_Nm: 15, force_noise_N: 0.1, torque_noise_Nm: 0.001}
)";

constexpr std::string_view kCell = R"(name: slide
robot: robot.yaml
task_in_base: {position_m: [0, 0, 0]}
tool_in_flange: {position_m: [0, 0, 0]}
sensor_in_flange: {position_m: [0, 0, 0]}
payload: {mass_kg: 0.1, com_m: [0, 0, 0]}
contact_stiffness_Npm: 5e4
faults: {force_N: 60, torque_Nm: 5}
)";

void check(const Robot& robot) {
  must(!robot.joints.empty() && robot.joints.size() <= kMaxJoints, "a robot has joints");
  must(robot.cycle_us >= 1000 && robot.heartbeat_timeout_ms > robot.heartbeat_ms, "it has a clock");
  for (const Joint& joint : robot.joints) {
    must(joint.lower < joint.upper && joint.speed_max > 0.0 && joint.acceleration_max > 0.0 &&
             joint.counts_per_unit != 0.0 && joint.link.mass_kg > 0.0,
         "a joint has limits, a scale and a mass");
    must(joint.axis.allFinite() && joint.origin.position_m.allFinite() &&
             joint.origin.orientation.coeffs().allFinite() && joint.link.com_m.allFinite() &&
             joint.link.inertia_kgm2.allFinite(),
         "a joint is made of numbers");
  }
}

}  // namespace

// A parser that refuses links in a circle leaves them holding each other.
// NOLINTNEXTLINE(readability-identifier-naming,bugprone-reserved-identifier): the sanitizer's name
extern "C" const char* __lsan_default_suppressions() { return "leak:urdf::parseURDF"; }

// NOLINTNEXTLINE(readability-identifier-naming): libFuzzer's name
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size == 0) return 0;
  static const fuzz::InputFolder folder;
  static const std::array<const char*, 3> kNames = {"robot.urdf", "robot.yaml", "cell.yaml"};
  static const std::array<std::string_view, 3> kGood = {kUrdf, kRobot, kCell};
  static const bool all_good = [] {
    for (std::size_t i = 0; i < kNames.size(); ++i) (void)folder.put(kNames[i], kGood[i]);
    must(fuzz::accepted([] { check(load_cell(folder.put("cell.yaml", kCell)).robot); }),
         "the files are as they should be");
    return true;
  }();
  (void)all_good;
  const std::size_t which = data[0] % kNames.size();
  (void)folder.put(kNames.at(which), fuzz::text_of(data, size).substr(1));
  const auto cell_file =
      folder.put("cell.yaml", which == 2 ? fuzz::text_of(data, size).substr(1) : kCell);
  Cell cell;
  if (fuzz::accepted([&] { cell = load_cell(cell_file); })) {
    check(cell.robot);
    must(cell.force_fault_N > 0.0 && cell.up_B.allFinite() && cell.X_BT.position_m.allFinite(),
         "a cell is made of numbers");
  }
  fuzz::accepted([&] { (void)cell_files(cell_file); });
  (void)folder.put(kNames.at(which), kGood.at(which));
  return 0;
}

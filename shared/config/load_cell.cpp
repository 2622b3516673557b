#include <algorithm>
#include <cmath>
#include <filesystem>
#include <optional>
#include <system_error>
#include <vector>

#include "shared/config/drive_file.h"
#include "shared/config/file_kind.h"
#include "shared/config/files.h"
#include "shared/config/friction_file.h"
#include "shared/config/load.h"
#include "shared/config/sensor_file.h"
#include "shared/config/yaml_value.h"
#include "shared/ports/arm.h"

namespace tenon {
namespace {

using config::Map;
using config::positive_to;
using config::Value;

SensorBias read_bias(const Value& value, const ForceTorqueSensor& sensor) {
  const Map map(value, {"force_N", "torque_Nm", "force_tolerance_N", "torque_tolerance_Nm"});
  SensorBias bias;
  bias.wrench << map.at("force_N").vector(config::within(sensor.force_range_N)),
      map.at("torque_Nm").vector(config::within(sensor.torque_range_Nm));
  bias.force_tolerance_N = map.number("force_tolerance_N", positive_to(sensor.force_range_N));
  bias.torque_tolerance_Nm = map.number("torque_tolerance_Nm", positive_to(sensor.torque_range_Nm));
  return bias;
}

/// A cell has to say that it bears the fall of an arm without brakes.
void check_fall(const Map& map, const Robot& robot) {
  const auto falls = map.find("falls_without_power");
  const bool says = falls && falls->choice({"false", "true"}) == 1;
  if (says && robot.brakes) falls->refuse("the brakes of robot " + robot.name + " hold it");
  if (says || robot.brakes) return;
  const std::string why = "robot " + robot.name +
                          " has no brakes and falls without power; say falls_without_power: true "
                          "where the cell bears that";
  falls ? falls->refuse(why) : map.at("robot").refuse(why);
}

/// Of a robot that cannot be read there are none; load_cell() says why.
void append_profiles(const std::filesystem::path& robot_file,
                     std::vector<std::filesystem::path>& files) {
  std::error_code error;
  if (!std::filesystem::is_regular_file(robot_file, error)) return;
  const auto robot = Value::parse(robot_file, config::read_file(robot_file));
  const auto sensor = robot.peek("sensor");
  const auto profile = sensor ? sensor->peek("profile") : std::nullopt;
  if (profile) files.push_back(config::sensor_file(robot_file, profile->text()));
  const auto joints = robot.peek("joints");
  if (!joints) return;
  for (const Value& joint : joints->list(1, kMaxJoints)) {
    const auto drive = joint.peek("drive");
    if (!drive) continue;
    const std::filesystem::path file = drive_file(robot_file, drive->text());
    if (std::find(files.begin(), files.end(), file) == files.end()) files.push_back(file);
  }
}

/// The force comes from the joints: the robot's sensor, where it has one, is not there.
void leave_out_sensor(Robot& robot) {
  constexpr double kLever_m = 0.3;
  constexpr double kPermille = 1e-3;
  ForceTorqueSensor none;
  none.protocol = SensorProtocol::kNone;
  none.profile = "joint_torque";
  // What rounding leaves of an effort, about.
  for (const Joint& joint : robot.joints) {
    const bool turns = joint.kind == Joint::Kind::kRevolute;
    const double count = kPermille * joint.rated_effort;
    none.force_per_count_N = std::max(none.force_per_count_N, turns ? count / kLever_m : count);
    none.torque_per_count_Nm = std::max(none.torque_per_count_Nm, turns ? count : count * kLever_m);
  }
  robot.sensor = none;
  robot.measurement_delay_cycles += kEffortDelayCycles;
}

void read_joint_torque(const Map& map, const std::filesystem::path& file, Cell& cell) {
  const auto value = map.find("joint_torque");
  if (!value) {
    if (!cell.robot.sensor.absent()) return;
    map.at("robot").refuse("robot " + cell.robot.name +
                           " has no force/torque sensor; say joint_torque: {} to take the force "
                           "from its joints' efforts");
  }
  const Map keys(*value, {"friction"});
  cell.joint_torque.emplace();
  if (const auto friction = keys.find("friction")) {
    const auto path = (file.parent_path() / friction->text()).lexically_normal();
    cell.joint_torque->joints = config::read_friction(path, cell.robot);
  }
  if (const auto bias = map.find("sensor_bias")) {
    bias->refuse("means nothing where joint_torque stands: there is no sensor");
  }
  leave_out_sensor(cell.robot);
}

/// Beyond its range a sensor would never show a fault.
void read_faults(const Value& value, Cell& cell) {
  constexpr double kMost = 1e5;  // of joints
  const ForceTorqueSensor& sensor = cell.robot.sensor;
  const Map map(value, {"force_N", "torque_Nm"});
  const bool none = sensor.absent();
  cell.force_fault_N = map.number("force_N", positive_to(none ? kMost : sensor.force_range_N));
  cell.torque_fault_Nm =
      map.number("torque_Nm", positive_to(none ? kMost : sensor.torque_range_Nm));
}

}  // namespace

Cell load_cell(const std::filesystem::path& file) {
  const Value document = Value::parse(file, config::read_file(file));
  config::expect_kind(file, document, config::FileKind::kCell);
  const Map map(document, {"name", "robot", "up_in_base", "task_in_base", "tool_in_flange",
                           "sensor_in_flange", "payload", "contact_stiffness_Npm",
                           "contact_stiffness_Nmpr", "sensor_bias", "joint_torque", "faults",
                           "on_brake_failure", "falls_without_power"});
  Cell cell;
  cell.name = map.at("name").name();
  if (const auto up = map.find("up_in_base")) {
    cell.up_B = up->vector(config::within(1.0));
    if (std::abs(cell.up_B.norm() - 1.0) > 1e-6) up->refuse("must have length 1");
    cell.up_B.normalize();
  }
  cell.X_BT = map.at("task_in_base").pose();
  cell.X_FP = map.at("tool_in_flange").pose();
  cell.X_FS = map.at("sensor_in_flange").pose();

  const Map payload(map.at("payload"), {"mass_kg", "com_m"});
  cell.payload_mass_kg = payload.number("mass_kg", {0.0, 100.0});
  cell.payload_com_m = payload.at("com_m").vector(config::within(1.0));

  cell.robot = load_robot((file.parent_path() / map.at("robot").text()).lexically_normal());

  read_joint_torque(map, file, cell);

  // The arm is one part of the series, which is softer than each of its parts.
  cell.contact_stiffness_Npm =
      map.number("contact_stiffness_Npm", {1e2, std::min(1e8, cell.robot.stiffness_Npm)});
  map.optional_number("contact_stiffness_Nmpr", positive_to(1e8), cell.contact_stiffness_Nmpr);
  if (const auto bias = map.find("sensor_bias")) {
    cell.sensor_bias = read_bias(*bias, cell.robot.sensor);
  }

  read_faults(map.at("faults"), cell);
  if (const auto reaction = map.find("on_brake_failure")) {
    if (!cell.robot.brakes) reaction->refuse("robot " + cell.robot.name + " has no brakes");
    cell.hold_if_brake_fails = reaction->choice({"power_off", "hold"}) == 1;
  }
  check_fall(map, cell.robot);
  return cell;
}

std::vector<std::filesystem::path> cell_files(const std::filesystem::path& file) {
  std::vector<std::filesystem::path> files;
  const auto cell = config::Value::parse(file, config::read_file(file));
  if (const auto robot = cell.peek("robot")) {
    const auto folder = (file.parent_path() / robot->text()).parent_path();
    std::error_code error;
    const std::filesystem::directory_iterator entries(folder, error);
    if (error) robot->refuse_value("a file in a folder that can be read");
    for (const auto& entry : entries) {
      if (entry.is_regular_file()) files.push_back(entry.path());
    }
  }
  std::sort(files.begin(), files.end());
  const auto torque = cell.peek("joint_torque");
  if (const auto friction = torque ? torque->peek("friction") : std::nullopt) {
    files.push_back((file.parent_path() / friction->text()).lexically_normal());
  }
  files.insert(files.begin(), file);
  if (const auto robot = cell.peek("robot")) {
    append_profiles((file.parent_path() / robot->text()).lexically_normal(), files);
  }
  return files;
}

}  // namespace tenon

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <set>
#include <string>
#include <system_error>
#include <utility>
#include <vector>

#include "shared/base/text.h"
#include "shared/canopen/drive_profile.h"
#include "shared/canopen/robot_drives.h"
#include "shared/config/bitrate.h"
#include "shared/config/drive_file.h"
#include "shared/config/file_kind.h"
#include "shared/config/files.h"
#include "shared/config/load.h"
#include "shared/config/load_motor.h"
#include "shared/config/sensor_file.h"
#include "shared/config/urdf_chain.h"
#include "shared/config/yaml_value.h"
#include "shared/ports/arm.h"

namespace tenon {
namespace {

using config::Map;
using config::positive_to;
using config::Value;
using config::within;

constexpr std::int64_t kNodeMax = 127;
constexpr double kCountsMax = 2147483647.0;  // the drives' positions are signed 32-bit

/// The names of a joint's keys carry the unit of its kind.
struct JointKeys {
  const char* counts_per_unit;
  const char* acceleration_max;
  const char* rated_effort;
  const char* following_error_max;
  const char* stiffness;
};
constexpr JointKeys kPrismaticKeys = {"counts_per_m", "acceleration_max_mps2", "rated_effort_N",
                                      "following_error_max_m", "stiffness_Npm"};
constexpr JointKeys kRevoluteKeys = {"counts_per_rad", "acceleration_max_radps2", "rated_effort_Nm",
                                     "following_error_max_rad", "stiffness_Nmpr"};

std::uint8_t read_node(const Value& value, std::set<std::int64_t>& taken) {
  const std::int64_t node = value.integer(1, kNodeMax);
  if (!taken.insert(node).second) value.refuse_value("a node that nothing else uses");
  return static_cast<std::uint8_t>(node);
}

void read_counts(const Map& map, const JointKeys& keys, Joint& joint) {
  const Value counts = map.at(keys.counts_per_unit);
  joint.counts_per_unit = counts.number(within(1e9));
  if (joint.counts_per_unit == 0.0) counts.refuse_value("other than 0");
  map.optional_number("zero_counts", within(kCountsMax), joint.zero_counts);
  for (const double end : {joint.lower, joint.upper}) {
    if (std::abs(end * joint.counts_per_unit + joint.zero_counts) > kCountsMax) {
      counts.refuse("the joint's range does not fit the drive's 32-bit counts");
    }
  }
}

/// The profiles that a robot's joints name, each read once.
class Drives {
 public:
  explicit Drives(const std::filesystem::path& robot_file) : robot_file_(robot_file) {}

  [[nodiscard]] const DriveProfile& read(const Value& name) {
    const auto file = drive_file(robot_file_, name.text());
    const auto [found, fresh] = read_.try_emplace(file);
    if (fresh) {
      std::error_code error;
      if (!std::filesystem::exists(file, error)) {
        name.refuse_value("a drive profile: " + file.string() + " does not exist");
      }
      found->second = load_drive(file);
    }
    return found->second;
  }

 private:
  std::filesystem::path robot_file_;
  std::map<std::filesystem::path, DriveProfile> read_;
};

DriveMode read_mode(const Value& value, const DriveProfile& drive) {
  const std::uint8_t mode = value.choice({"7", "8"}) == 0 ? 7 : 8;
  if (std::find(drive.modes.begin(), drive.modes.end(), mode) == drive.modes.end()) {
    value.refuse_value(format("%u, as drive ", static_cast<unsigned>(drive.modes.front())) +
                       drive.name + " offers");
  }
  return static_cast<DriveMode>(mode);
}

/// What drive and bus add to a joint of the URDF.
void read_drive(const Value& value, std::set<std::int64_t>& nodes, Drives& drives, Joint& joint) {
  const JointKeys& keys = joint.kind == Joint::Kind::kPrismatic ? kPrismaticKeys : kRevoluteKeys;
  const Map map(
      value, {"name", "node", "drive", "mode", "zero_counts", keys.counts_per_unit,
              keys.acceleration_max, keys.rated_effort, keys.following_error_max, keys.stiffness});
  joint.node = read_node(map.at("node"), nodes);
  if (const auto drive = map.find("drive")) canopen_drive(joint).profile = drives.read(*drive);
  canopen_drive(joint).mode = read_mode(map.at("mode"), canopen_drive(joint).profile);
  read_counts(map, keys, joint);
  joint.acceleration_max = map.number(keys.acceleration_max, positive_to(1e4));
  joint.rated_effort = map.number(keys.rated_effort, positive_to(1e5));
  joint.following_error_max = map.number(keys.following_error_max, positive_to(1.0));
  joint.stiffness = map.number(keys.stiffness, positive_to(1e9));
}

/// Every joint of the URDF once, in any order; the URDF's order is the chain's.
/// @param drives null: they are motors in MIT mode
void read_joints(const Value& value, const std::string& urdf, std::set<std::int64_t>& nodes,
                 Drives* drives, std::vector<Joint>& joints) {
  std::set<std::string> read;
  for (const Value& entry : value.list(1, kMaxJoints)) {
    // The other keys depend on the joint that it names.
    const auto name = entry.peek("name");
    if (!name) entry.refuse("the required key name is missing");
    const auto joint = std::find_if(joints.begin(), joints.end(),
                                    [&](const Joint& each) { return each.name == name->text(); });
    if (joint == joints.end()) name->refuse_value("a revolute or prismatic joint of " + urdf);
    if (!read.insert(joint->name).second) name->refuse_value("listed once");
    if (drives != nullptr) {
      read_drive(entry, nodes, *drives, *joint);
    } else {
      config::read_motor(entry, nodes, *joint);
    }
  }
  for (const Joint& joint : joints) {
    if (!read.contains(joint.name)) value.refuse("lacks joint " + joint.name + " of " + urdf);
  }
}

void read_bus(const Value& value, std::set<std::int64_t>& nodes, Robot& robot) {
  const Map map(value, {"bitrate_bps", "cycle_us", "heartbeat_ms", "heartbeat_timeout_ms",
                        "master_node", "targets_per_frame"});
  robot.bitrate_bps = config::read_bitrate_bps(map.at("bitrate_bps"));
  const Value cycle = map.at("cycle_us");
  robot.cycle_us = static_cast<std::uint32_t>(cycle.integer(1000, 20'000));
  // The drives' interpolation period (60C2h) is written in milliseconds.
  if (robot.cycle_us % 1000 != 0) cycle.refuse_value("a multiple of 1000");
  robot.heartbeat_ms = static_cast<std::uint32_t>(map.at("heartbeat_ms").integer(10, 10'000));
  robot.heartbeat_timeout_ms = static_cast<std::uint32_t>(
      map.at("heartbeat_timeout_ms").integer(std::int64_t{robot.heartbeat_ms} + 1, 65'535));
  robot.master_node = read_node(map.at("master_node"), nodes);
  if (const auto targets = map.find("targets_per_frame")) {
    robot.targets_per_frame = static_cast<int>(targets->integer(1, robot.brakes ? 2 : 1));
  }
}

/// No arm answers sooner than its protocol; a file that says so promises less force than touches
/// have.
double read_response_lag_s(const Value& value, const Robot& robot) {
  const double lag_s = value.number({0.0, 1.0});
  const double least_s = protocol_lag_s(1e-6 * robot.cycle_us);
  constexpr double kRounding = 1.0 - 1e-9;
  if (lag_s < least_s * kRounding) {
    value.refuse_value(format("at least %g s, the two cycles that the protocol takes", least_s));
  }
  return lag_s;
}

}  // namespace

Robot load_robot(const std::filesystem::path& file) {
  const Value document = Value::parse(file, config::read_file(file));
  config::expect_kind(file, document, config::FileKind::kRobot);
  const Map map(document, {"name", "urdf", "protocol", "bus", "arm", "joints", "sensor"});
  Robot robot;
  robot.name = map.at("name").name();
  const std::string urdf = map.at("urdf").text();
  config::UrdfChain chain = config::read_urdf((file.parent_path() / urdf).lexically_normal());
  robot.joints = std::move(chain.joints);
  robot.flange = chain.flange;
  std::set<std::int64_t> nodes;
  Drives drives(file);
  const auto protocol = map.find("protocol");
  const bool mit = protocol && protocol->choice({"canopen", "mit"}) == 1;
  robot.brakes = !mit;
  read_joints(map.at("joints"), urdf, nodes, mit ? nullptr : &drives, robot.joints);
  const auto sensor = map.find("sensor");
  robot.sensor.protocol = SensorProtocol::kNone;
  if (sensor) robot.sensor = config::read_sensor(*sensor, file, nodes);
  read_bus(map.at("bus"), nodes, robot);
  if (sensor) config::read_sample_period(*sensor, robot.cycle_us, robot.sensor);

  const Map arm(map.at("arm"), {"response_lag_s", "stiffness_Npm", "measurement_delay_cycles"});
  robot.response_lag_s = read_response_lag_s(arm.at("response_lag_s"), robot);
  robot.stiffness_Npm = arm.number("stiffness_Npm", {1e3, 1e9});
  robot.measurement_delay_cycles =
      static_cast<int>(arm.at("measurement_delay_cycles").integer(0, 20));
  return robot;
}

}  // namespace tenon

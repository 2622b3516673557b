#include <array>
#include <cmath>
#include <set>

#include "shared/config/files.h"
#include "shared/config/load.h"
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
  const char* lower;
  const char* upper;
  const char* speed_max;
  const char* acceleration_max;
  const char* effort_max;
  const char* rated_effort;
  const char* following_error_max;
};
constexpr JointKeys kPrismaticKeys = {
    "counts_per_m",          "lower_m",      "upper_m",        "speed_max_mps",
    "acceleration_max_mps2", "effort_max_N", "rated_effort_N", "following_error_max_m"};
constexpr JointKeys kRevoluteKeys = {
    "counts_per_rad",          "lower_rad",     "upper_rad",       "speed_max_radps",
    "acceleration_max_radps2", "effort_max_Nm", "rated_effort_Nm", "following_error_max_rad"};

// The names of the other keys depend on it.
Joint::Kind read_kind(const Value& joint) {
  const auto kind = joint.peek("kind");
  if (!kind) joint.refuse("the required key kind is missing");
  return kind->choice({"prismatic", "revolute"}) == 0 ? Joint::Kind::kPrismatic
                                                      : Joint::Kind::kRevolute;
}

std::uint8_t read_node(const Value& value, std::set<std::int64_t>& taken) {
  const std::int64_t node = value.integer(1, kNodeMax);
  if (!taken.insert(node).second) value.refuse_value("a node that nothing else uses");
  return static_cast<std::uint8_t>(node);
}

Vector3 read_axis(const Value& value) {
  const Vector3 axis = value.vector(within(1.0));
  if (std::abs(axis.norm() - 1.0) > 1e-6) value.refuse("must have length 1");
  return axis.normalized();
}

void read_range(const Map& map, const JointKeys& keys, Joint& joint) {
  constexpr double kTravelMax = 100.0;
  joint.lower = map.number(keys.lower, within(kTravelMax));
  joint.upper = map.number(keys.upper, {joint.lower, kTravelMax, true});
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

Joint read_joint(const Value& value, std::set<std::int64_t>& nodes) {
  Joint joint;
  joint.kind = read_kind(value);
  const JointKeys& keys = joint.kind == Joint::Kind::kPrismatic ? kPrismaticKeys : kRevoluteKeys;
  const Map map(
      value, {"name", "kind", "origin", "axis", "node", "mode", "zero_counts", "moving_mass_kg",
              keys.counts_per_unit, keys.lower, keys.upper, keys.speed_max, keys.acceleration_max,
              keys.effort_max, keys.rated_effort, keys.following_error_max});
  joint.name = map.at("name").name();
  if (const auto origin = map.find("origin")) joint.origin = origin->pose();
  joint.axis = read_axis(map.at("axis"));
  joint.node = read_node(map.at("node"), nodes);
  joint.mode = map.at("mode").choice({"7", "8"}) == 0 ? Joint::Mode::kInterpolatedPosition
                                                      : Joint::Mode::kCyclicSynchronousPosition;
  read_range(map, keys, joint);
  joint.speed_max = map.number(keys.speed_max, positive_to(100.0));
  joint.acceleration_max = map.number(keys.acceleration_max, positive_to(1e4));
  joint.effort_max = map.number(keys.effort_max, positive_to(1e5));
  joint.rated_effort = map.number(keys.rated_effort, positive_to(1e5));
  joint.following_error_max = map.number(keys.following_error_max, positive_to(1.0));
  joint.link.mass_kg = map.number("moving_mass_kg", positive_to(1e3));
  return joint;
}

ForceTorqueSensor read_sensor(const Value& value, std::set<std::int64_t>& nodes) {
  const Map map(value, {"node", "force_per_count_N", "torque_per_count_Nm", "force_range_N",
                        "torque_range_Nm", "force_noise_N", "torque_noise_Nm"});
  ForceTorqueSensor sensor;
  sensor.node = read_node(map.at("node"), nodes);
  sensor.force_per_count_N = map.number("force_per_count_N", positive_to(100.0));
  sensor.torque_per_count_Nm = map.number("torque_per_count_Nm", positive_to(100.0));
  // A reading is a signed 16-bit count.
  sensor.force_range_N =
      map.number("force_range_N", positive_to(32767.0 * sensor.force_per_count_N));
  sensor.torque_range_Nm =
      map.number("torque_range_Nm", positive_to(32767.0 * sensor.torque_per_count_Nm));
  sensor.force_noise_N = map.number("force_noise_N", {0.0, sensor.force_range_N});
  sensor.torque_noise_Nm = map.number("torque_noise_Nm", {0.0, sensor.torque_range_Nm});
  return sensor;
}

void read_bus(const Value& value, std::set<std::int64_t>& nodes, Robot& robot) {
  const Map map(value,
                {"bitrate_bps", "cycle_us", "heartbeat_ms", "heartbeat_timeout_ms", "master_node"});
  // The bit rates of CiA 301.
  constexpr std::array<std::uint32_t, 7> kBitrates_bps = {20'000,  50'000,  125'000,  250'000,
                                                          500'000, 800'000, 1'000'000};
  robot.bitrate_bps = kBitrates_bps[map.at("bitrate_bps")
                                        .choice({"20000", "50000", "125000", "250000", "500000",
                                                 "800000", "1000000"})];
  const Value cycle = map.at("cycle_us");
  robot.cycle_us = static_cast<std::uint32_t>(cycle.integer(1000, 20'000));
  // The drives' interpolation period (60C2h) is written in milliseconds.
  if (robot.cycle_us % 1000 != 0) cycle.refuse_value("a multiple of 1000");
  robot.heartbeat_ms = static_cast<std::uint32_t>(map.at("heartbeat_ms").integer(10, 10'000));
  robot.heartbeat_timeout_ms = static_cast<std::uint32_t>(
      map.at("heartbeat_timeout_ms").integer(std::int64_t{robot.heartbeat_ms} + 1, 65'535));
  robot.master_node = read_node(map.at("master_node"), nodes);
}

}  // namespace

Robot load_robot(const std::filesystem::path& file) {
  const Map map(Value::parse(file, config::read_file(file)),
                {"name", "bus", "arm", "joints", "flange", "sensor"});
  Robot robot;
  robot.name = map.at("name").name();
  std::set<std::int64_t> nodes;
  for (const Value& joint : map.at("joints").list(1, kMaxJoints)) {
    robot.joints.push_back(read_joint(joint, nodes));
  }
  if (const auto flange = map.find("flange")) robot.flange = flange->pose();
  robot.sensor = read_sensor(map.at("sensor"), nodes);
  read_bus(map.at("bus"), nodes, robot);

  const Map arm(map.at("arm"), {"response_lag_s", "stiffness_Npm", "measurement_delay_cycles"});
  robot.response_lag_s = arm.number("response_lag_s", {0.0, 1.0});
  robot.stiffness_Npm = arm.number("stiffness_Npm", {1e3, 1e9});
  robot.measurement_delay_cycles =
      static_cast<int>(arm.at("measurement_delay_cycles").integer(0, 20));
  return robot;
}

}  // namespace tenon

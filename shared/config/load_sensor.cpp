#include <algorithm>
#include <array>
#include <initializer_list>
#include <optional>
#include <string_view>
#include <system_error>
#include <vector>

#include "shared/base/text.h"
#include "shared/config/bitrate.h"
#include "shared/config/file_kind.h"
#include "shared/config/files.h"
#include "shared/config/sensor_file.h"
#include "shared/sensors/ati_netcanoem.h"
#include "shared/sensors/robotous_rft.h"

namespace tenon::config {
namespace {

constexpr std::int64_t kNodeMax = 127;
constexpr double kRawMax = 32767.0;  // a reading is a signed 16-bit count
constexpr std::size_t kUnverifiedMax = 20;
constexpr std::int64_t kMicrosecondsPerSecond = 1'000'000;

Value named_profile(const Value& name, const std::filesystem::path& robot_file) {
  const auto file = sensor_file(robot_file, name.text());
  std::error_code error;
  if (!std::filesystem::exists(file, error)) {
    name.refuse_value("a sensor profile: " + file.string() + " does not exist");
  }
  return read_sensor_profile(file);
}

/// Profile and file in one; the file's word goes first.
Map merged(const Value& value, const std::filesystem::path& robot_file) {
  // Here what the profile alone says is unknown.
  (void)Map(value, {"profile", "bus", "node", "identifiers", "rate_hz", "period_us",
                    "force_per_count_N", "torque_per_count_Nm", "force_range_N", "torque_range_Nm",
                    "force_noise_N", "torque_noise_Nm"});
  const auto profile = value.peek("profile");
  const Value all = profile ? named_profile(*profile, robot_file).overlaid_with(value) : value;
  return {all,
          {"name", "protocol", "unverified", "profile", "bus", "node", "identifiers", "rate_hz",
           "period_us", "force_per_count_N", "torque_per_count_Nm", "force_range_N",
           "torque_range_Nm", "force_noise_N", "torque_noise_Nm"}};
}

void refuse_keys(const Map& map, const std::string& profile,
                 std::initializer_list<std::string_view> keys) {
  for (const std::string_view key : keys) {
    if (const auto found = map.find(key)) found->refuse("means nothing to a sensor " + profile);
  }
}

void read_scale(const Map& map, ForceTorqueSensor& sensor) {
  sensor.force_per_count_N = map.number("force_per_count_N", positive_to(100.0));
  sensor.torque_per_count_Nm = map.number("torque_per_count_Nm", positive_to(100.0));
  sensor.force_range_N =
      map.number("force_range_N", positive_to(kRawMax * sensor.force_per_count_N));
  sensor.torque_range_Nm =
      map.number("torque_range_Nm", positive_to(kRawMax * sensor.torque_per_count_Nm));
}

SensorProtocol read_protocol(const Value& value) {
  return static_cast<SensorProtocol>(
      value.choice({"canopen_node", "robotous_rft", "ati_netcanoem"}));
}

Map identifiers_of(const Value& value) { return {value, {"command", "first", "second", "base"}}; }

std::uint32_t read_identifier(const Map& map, std::string_view key) {
  return static_cast<std::uint32_t>(
      map.at(key).integer(1, std::int64_t{ForceTorqueSensor::kIdentifierMax}));
}

void read_rft(const Map& map, ForceTorqueSensor& sensor) {
  refuse_keys(map, sensor.profile, {"node", "period_us"});
  read_scale(map, sensor);
  const Map identifiers = identifiers_of(map.at("identifiers"));
  refuse_keys(identifiers, sensor.profile, {"base"});
  sensor.request_id = read_identifier(identifiers, "command");
  sensor.sample_ids = {read_identifier(identifiers, "first"),
                       read_identifier(identifiers, "second")};
  if (sensor.sample_ids[0] == sensor.request_id) {
    identifiers.at("first").refuse_value("another identifier than command");
  }
  if (sensor.sample_ids[1] == sensor.request_id || sensor.sample_ids[1] == sensor.sample_ids[0]) {
    identifiers.at("second").refuse_value("another identifier than command and first");
  }
  const Value rate = map.at("rate_hz");
  sensor.rate_hz = static_cast<int>(rate.integer(1, 1000));
  if (!rft::rate_code(sensor.rate_hz)) {
    rate.refuse_value("10, 20, 50, 100, 200, 300, 500 or 1000");
  }
}

/// It tells its scale itself; what rounding leaves is about a gauge's count.
void read_ati(const Map& map, ForceTorqueSensor& sensor) {
  refuse_keys(map, sensor.profile, {"node", "rate_hz", "force_per_count_N", "torque_per_count_Nm"});
  sensor.force_range_N = map.number("force_range_N", positive_to(1e6));
  sensor.torque_range_Nm = map.number("torque_range_Nm", positive_to(1e6));
  sensor.force_per_count_N = sensor.force_range_N / kRawMax;
  sensor.torque_per_count_Nm = sensor.torque_range_Nm / kRawMax;
  const Map identifiers = identifiers_of(map.at("identifiers"));
  refuse_keys(identifiers, sensor.profile, {"command", "first", "second"});
  const auto base =
      static_cast<std::uint32_t>(identifiers.at("base").integer(1, std::int64_t{ati::kBaseMax}));
  sensor.request_id = base * ati::kOperations;
  sensor.sample_ids = {sensor.request_id | ati::kReadGauges,
                       sensor.request_id | ati::kGaugesSecond};
}

void read_canopen(const Map& map, std::set<std::int64_t>& nodes, ForceTorqueSensor& sensor) {
  refuse_keys(map, sensor.profile, {"identifiers", "rate_hz"});
  const Value node = map.at("node");
  sensor.node = static_cast<std::uint8_t>(node.integer(1, kNodeMax));
  if (!nodes.insert(sensor.node).second) node.refuse_value("a node that nothing else uses");
  read_scale(map, sensor);
}

/// Its clock is not the bus's: within so many cycles, rounded up, one is there at the least.
void round_up_period(const Value& value, std::uint32_t cycle_us, ForceTorqueSensor& sensor) {
  const std::int64_t span = std::int64_t{sensor.rate_hz} * cycle_us;
  const std::int64_t cycles = (kMicrosecondsPerSecond + span - 1) / span;
  if (cycles > ForceTorqueSensor::kMostCyclesPerSample) {
    value.refuse(format("rate_hz = %d brings no sample within %d cycles of %u us", sensor.rate_hz,
                        ForceTorqueSensor::kMostCyclesPerSample, cycle_us));
  }
  sensor.cycles_per_sample = static_cast<int>(cycles);
}

}  // namespace

Value read_sensor_profile(const std::filesystem::path& file) {
  Value document = Value::parse(file, read_file(file));
  expect_kind(file, document, FileKind::kSensor);
  const Map map(document, {"name", "protocol", "unverified", "identifiers", "rate_hz",
                           "force_per_count_N", "torque_per_count_Nm", "force_range_N",
                           "torque_range_Nm", "force_noise_N", "torque_noise_Nm"});
  (void)map.at("name").name();
  (void)read_protocol(map.at("protocol"));
  if (const auto identifiers = map.find("identifiers")) (void)identifiers_of(*identifiers);
  return document;
}

ForceTorqueSensor read_sensor(const Value& value, const std::filesystem::path& robot_file,
                              std::set<std::int64_t>& nodes) {
  const Map map = merged(value, robot_file);
  ForceTorqueSensor sensor;
  sensor.profile = "canopen_node";
  if (const auto name = map.find("name")) sensor.profile = name->name();
  if (const auto unverified = map.find("unverified")) {
    for (const Value& line : unverified->list(0, kUnverifiedMax)) {
      sensor.unverified.push_back(line.text());
    }
  }
  if (const auto bus = map.find("bus")) {
    sensor.own_bitrate_bps = read_bitrate_bps(Map(*bus, {"bitrate_bps"}).at("bitrate_bps"));
  }
  if (const auto protocol = map.find("protocol")) sensor.protocol = read_protocol(*protocol);
  switch (sensor.protocol) {
    case SensorProtocol::kNode:
      read_canopen(map, nodes, sensor);
      break;
    case SensorProtocol::kRobotousRft:
      read_rft(map, sensor);
      break;
    case SensorProtocol::kAtiNetcanoem:
      read_ati(map, sensor);
      break;
    case SensorProtocol::kNone:
      break;
  }
  sensor.force_noise_N = map.number("force_noise_N", {0.0, sensor.force_range_N});
  sensor.torque_noise_Nm = map.number("torque_noise_Nm", {0.0, sensor.torque_range_Nm});
  return sensor;
}

void read_sample_period(const Value& value, std::uint32_t cycle_us, ForceTorqueSensor& sensor) {
  if (sensor.streams()) return round_up_period(value, cycle_us, sensor);
  const auto period = value.peek("period_us");
  if (!period) return;
  const std::int64_t period_us =
      period->integer(cycle_us, std::int64_t{ForceTorqueSensor::kMostCyclesPerSample} * cycle_us);
  if (period_us % cycle_us != 0) {
    period->refuse_value(format("a multiple of the cycle of %u us", cycle_us));
  }
  sensor.cycles_per_sample = static_cast<int>(period_us / cycle_us);
}

}  // namespace tenon::config

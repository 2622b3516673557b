#include "shared/config/file_kind.h"
#include "shared/config/files.h"
#include "shared/config/load.h"
#include "shared/config/yaml_value.h"

namespace tenon {
namespace {

using config::Bounds;
using config::Map;
using config::Value;
using config::within;

/// [low, high]
Spread read_range(const Value& value, const Bounds& bounds) {
  const std::vector<Value> ends = value.list(2, 2);
  Spread spread;
  spread.low = ends[0].number(bounds);
  spread.high = ends[1].number({spread.low, bounds.high});
  return spread;
}

/// [low, high] or {sigma: value}, of something that is 0 in the planner's world.
Spread read_error(const Value& value, double magnitude) {
  if (!value.peek("sigma")) return read_range(value, within(magnitude));
  Spread spread;
  spread.sigma = Map(value, {"sigma"}).number("sigma", {0.0, magnitude / 3.0});
  return spread;
}

DriveFrictionRange read_drive_friction(const Value& value) {
  const Map map(value, {"share", "seed"});
  DriveFrictionRange range;
  range.share = read_range(map.at("share"), {0.0, 0.5});
  if (const auto seed = map.find("seed")) {
    range.seed = static_cast<std::uint64_t>(seed->integer(0, std::int64_t{1} << 53));
  }
  return range;
}

}  // namespace

WorldRanges load_experiment(const std::filesystem::path& file) {
  const Value document = Value::parse(file, config::read_file(file));
  config::expect_kind(file, document, config::FileKind::kExperiment);
  const Map map(document, {"name",
                           "friction",
                           "contact_stiffness_Npm",
                           "clearance_m",
                           "size_error_m",
                           "task_in_base_error_m",
                           "task_in_base_error_rad",
                           "tool_in_flange_error_m",
                           "tool_in_flange_error_rad",
                           "sensor_in_flange_error_m",
                           "sensor_in_flange_error_rad",
                           "payload_mass_error_kg",
                           "payload_com_error_m",
                           "servo_stiffness_factor",
                           "extra_delay_s",
                           "backlash_m",
                           "backlash_rad",
                           "drive_friction",
                           "sensor_noise_factor",
                           "force_drift_N_sqrts",
                           "torque_drift_Nm_sqrts"});
  const auto range = [&map](std::string_view key, const Bounds& bounds, auto& spread) {
    if (const auto value = map.find(key)) spread = read_range(*value, bounds);
  };
  const auto error = [&map](std::string_view key, double magnitude, Spread& spread) {
    if (const auto value = map.find(key)) spread = read_error(*value, magnitude);
  };

  WorldRanges ranges;
  ranges.name = map.at("name").name();
  range("friction", {0.0, 2.0}, ranges.friction);
  range("contact_stiffness_Npm", {1e2, 1e8}, ranges.contact_stiffness_Npm);
  error("clearance_m", 0.01, ranges.clearance_m);
  error("size_error_m", 0.01, ranges.size_error_m);
  error("task_in_base_error_m", 0.1, ranges.task_in_base_error_m);
  error("task_in_base_error_rad", 0.1, ranges.task_in_base_error_rad);
  error("tool_in_flange_error_m", 0.1, ranges.tool_in_flange_error_m);
  error("tool_in_flange_error_rad", 0.1, ranges.tool_in_flange_error_rad);
  error("sensor_in_flange_error_m", 0.1, ranges.sensor_in_flange_error_m);
  error("sensor_in_flange_error_rad", 0.1, ranges.sensor_in_flange_error_rad);
  error("payload_mass_error_kg", 10.0, ranges.payload_mass_error_kg);
  error("payload_com_error_m", 0.1, ranges.payload_com_error_m);
  range("servo_stiffness_factor", {0.05, 20.0}, ranges.servo_stiffness_factor);
  range("extra_delay_s", {0.0, 0.1}, ranges.extra_delay_s);
  range("backlash_m", {0.0, 0.01}, ranges.backlash_m);
  range("backlash_rad", {0.0, 0.1}, ranges.backlash_rad);
  if (const auto friction = map.find("drive_friction")) {
    ranges.drive_friction = read_drive_friction(*friction);
  }
  range("sensor_noise_factor", {0.0, 100.0}, ranges.sensor_noise_factor);
  range("force_drift_N_sqrts", {0.0, 100.0}, ranges.force_drift_N_sqrts);
  range("torque_drift_Nm_sqrts", {0.0, 100.0}, ranges.torque_drift_Nm_sqrts);
  return ranges;
}

}  // namespace tenon

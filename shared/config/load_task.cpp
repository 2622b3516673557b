#include <algorithm>
#include <cmath>
#include <numbers>

#include "shared/base/error.h"
#include "shared/base/fnv.h"
#include "shared/base/text.h"
#include "shared/config/file_kind.h"
#include "shared/config/files.h"
#include "shared/config/load.h"
#include "shared/config/load_shapes.h"
#include "shared/config/load_starts.h"
#include "shared/config/variant.h"
#include "shared/config/yaml_value.h"
#include "shared/motion/move_parameters.h"
#include "shared/motion/rules.h"
#include "shared/task/inserted.h"
#include "shared/task/own_moves.h"

namespace tenon {
namespace {

using config::Bounds;
using config::kSizeMax_m;
using config::Map;
using config::positive_to;
using config::read_axes;
using config::Value;

constexpr std::uint8_t kRotations = 0b111000;
constexpr std::uint8_t kAllAxes = 0b111111;

std::uint32_t microseconds(double time_s) {
  return static_cast<std::uint32_t>(std::llround(1e6 * time_s));
}

/// `tolerances: {z_m: 0.005, ry_rad: 0.02}` and `free: [rz]`.
GoalAxes read_goal_axes(const Map& goal, CoordinateMask coordinates) {
  GoalAxes axes;
  const auto demand_coordinate = [&](const Value& value, int axis) {
    if (has(coordinates, axis)) return;
    value.refuse(std::string("names ") + axis_name(axis) + ", which is not a search coordinate");
  };
  if (const auto own = goal.find("tolerances")) {
    const Map map(*own, {"x_m", "y_m", "z_m", "rx_rad", "ry_rad", "rz_rad"});
    for (int axis = 0; axis < 6; ++axis) {
      const auto given = map.find(axis_key(axis));
      if (!given) continue;
      demand_coordinate(*given, axis);
      axes.tolerance[axis] = given->number(positive_to(axis < 3 ? 1.0 : std::numbers::pi));
    }
  }
  if (const auto free = goal.find("free")) {
    axes.free = read_axes(*free);
    for (int axis = 0; axis < 6; ++axis) {
      if (!has(axes.free, axis)) continue;
      demand_coordinate(*free, axis);
      if (axes.tolerance[axis] == 0.0) continue;
      free->refuse(std::string("names ") + axis_name(axis) + ", which has a tolerance");
    }
  }
  return axes;
}

void read_goal(const Value& value, Task& task) {
  if (const auto angle = value.peek("tolerance_rad")) {
    angle->refuse("is no key here: angles have tolerances by axis, tolerances: {rz_rad: 0.02}");
  }
  const Map map(value, {"pose", "tolerance_m", "tolerances", "free", "uncertainty_m2", "inserted"});
  task.goal = map.at("pose").pose();
  task.goal_tolerance_m = map.number("tolerance_m", positive_to(1.0));
  task.goal_axes = read_goal_axes(map, task.coordinates);
  task.goal_uncertainty_m2 = 0.0;  // where it is not said
  map.optional_number("uncertainty_m2", positive_to(1.0), task.goal_uncertainty_m2);

  const auto region = map.find("inserted");
  if (!region) return;
  const Map box(*region, {"box_m", "pose"});
  task.inserted = {box.at("box_m").vector(positive_to(kSizeMax_m)), box.at("pose").pose()};
  if (!inserted(task, task.goal)) region->refuse("must contain the goal's position");
}

void read_primitives(const Value& value, Task& task) {
  const Map map(value, {"step_m", "step_rad", "long_step_m", "direct_reach_m"});
  task.step_m = map.number("step_m", positive_to(1.0));
  map.optional_number("step_rad", positive_to(1.0), task.step_rad);
  task.long_step_m = map.number("long_step_m", {task.step_m, 10.0});
  task.direct_reach_m = map.number("direct_reach_m", {0.0, 10.0});
}

/// Of a move in contact, which is no faster than one through free air.
double contact_speed(const Map& map, const char* key, const char* approach_key, double approach,
                     double most) {
  const Value given = map.at(key);
  const double speed = given.number(positive_to(most));
  if (speed > approach) {
    given.refuse_value(format("in (0, %g]: no more than %s", approach, approach_key));
  }
  return speed;
}

SpeedLimits read_speeds(const Value& value) {
  const Map map(value, {"approach_mps", "contact_mps", "acceleration_mps2", "jerk_mps3",
                        "approach_radps", "contact_radps", "acceleration_radps2", "jerk_radps3"});
  SpeedLimits v;
  v.approach_mps = map.number("approach_mps", positive_to(1.0));
  v.contact_mps = contact_speed(map, "contact_mps", "approach_mps", v.approach_mps, 1.0);
  map.optional_number("acceleration_mps2", positive_to(100.0), v.acceleration_mps2);
  map.optional_number("jerk_mps3", positive_to(1e4), v.jerk_mps3);
  map.optional_number("approach_radps", positive_to(3.0), v.approach_radps);
  if (map.find("contact_radps")) {
    v.contact_radps = contact_speed(map, "contact_radps", "approach_radps", v.approach_radps, 3.0);
  }
  map.optional_number("acceleration_radps2", positive_to(1e3), v.acceleration_radps2);
  map.optional_number("jerk_radps3", positive_to(1e5), v.jerk_radps3);
  return v;
}

/// Thresholds, debounce and limits; refused where they break the rules of a guarded move. After
/// read_compliance().
void read_contact(const Value& value, Task& task) {
  const Map map(value,
                {"force_on_N", "force_keep_N", "force_off_N", "torque_on_Nm", "torque_keep_Nm",
                 "torque_off_Nm", "debounce_s", "timeout_s", "force_limit_N", "torque_limit_Nm"});
  ContactThresholds& t = task.motion.thresholds;
  constexpr Bounds kForce = positive_to(1e3);
  constexpr Bounds kTorque = positive_to(1e2);
  t.force_on_N = map.number("force_on_N", kForce);
  t.force_keep_N = map.number("force_keep_N", kForce);
  t.force_off_N = map.number("force_off_N", kForce);
  const unsigned rotations = task.compliance.compliant_axes & kRotations;
  if (rotations != 0) t = with_press_torques(t);
  map.optional_number("torque_on_Nm", kTorque, t.torque_on_Nm);
  map.optional_number("torque_keep_Nm", kTorque, t.torque_keep_Nm);
  map.optional_number("torque_off_Nm", kTorque, t.torque_off_Nm);
  t.debounce_us = microseconds(map.number("debounce_s", positive_to(0.1)));
  if (const auto timeout = map.find("timeout_s")) {
    task.motion.timeout_us = microseconds(timeout->number({0.1, 600.0}));
  }
  task.force_limit_N = map.number("force_limit_N", kForce);
  map.optional_number("torque_limit_Nm", kTorque, task.torque_limit_Nm);

  ContactConditions conditions;
  conditions.friction_max = task.friction.high;
  // A torque that nobody gave a threshold for is not sensed; what does not rotate feels none.
  task.motion.sensed_axes =
      map.find("torque_on_Nm") ? kAllAxes : static_cast<std::uint8_t>(kAllAxes & ~rotations);
  if (const auto rule =
          broken_rule(t, task.force_limit_N, task.motion.speeds.acceleration_mps2, conditions)) {
    value.refuse(*rule + kilonewtons_hint(t.force_on_N));
  }
}

void read_compliance(const Value& value, Task& task) {
  const Map map(value, {"axes", "mass_kg", "damping_Nspm", "stiffness_Npm", "inertia_kgm2",
                        "damping_Nmspr", "stiffness_Nmpr"});
  Compliance& c = task.compliance;
  c.compliant_axes = read_axes(map.at("axes"));
  for (int axis = 0; axis < 6; ++axis) {
    if (!has(task.coordinates, axis) || has(c.compliant_axes, axis)) continue;
    if (axis >= 3 && has(task.goal_axes.free, axis)) continue;
    map.at("axes").refuse("lacks the search coordinate " + std::string(axis_name(axis)) +
                          ": a rigid axis feels no contact");
  }
  task.motion.carried_axes = (task.coordinates & kRotations) != 0;
  c.mass_kg = map.number("mass_kg", positive_to(1e3));
  c.damping_Nspm = map.number("damping_Nspm", positive_to(1e6));
  c.stiffness_Npm = map.number("stiffness_Npm", positive_to(1e6));
  map.optional_number("inertia_kgm2", positive_to(1e2), c.inertia_kgm2);
  map.optional_number("damping_Nmspr", positive_to(1e5), c.damping_Nmspr);
  map.optional_number("stiffness_Nmpr", positive_to(1e5), c.stiffness_Nmpr);
}

void read_search(const Value& value, Task& task) {
  const Map map(value, {"w1", "w2", "distance_weight_per_m", "uncertainty_weight_per_m2",
                        "move_weight", "orientation_weight_m_per_rad", "attractor_ratio",
                        "attractor_samples", "time_limit_s"});
  constexpr Bounds kWeight = positive_to(1e9);
  constexpr Bounds kInflation = {1.0, 1e3};
  map.optional_number("w1", kInflation, task.w1);
  map.optional_number("w2", kInflation, task.w2);
  map.optional_number("distance_weight_per_m", kWeight, task.distance_weight_per_m);
  map.optional_number("uncertainty_weight_per_m2", kWeight, task.uncertainty_weight_per_m2);
  map.optional_number("move_weight", {0.0, kWeight.high}, task.move_weight);
  map.optional_number("orientation_weight_m_per_rad", kWeight, task.orientation_weight);
  map.optional_number("attractor_ratio", positive_to(1.0), task.attractor_ratio);
  if (const auto samples = map.find("attractor_samples")) {
    task.attractor_samples = static_cast<std::size_t>(samples->integer(0, 1000));
  }
  map.optional_number("time_limit_s", positive_to(86'400.0), task.time_limit_s);
}

// 0.17 degrees: three of the standard deviations that the shipped experiments draw
// (sim/experiments). What a cell's calibration is good to, whoever has measured it says in the
// task.
constexpr double kCalibrated_rad = 3e-3;
constexpr Bounds kFriction = {0.0, 2.0};
// A cell's stiffness is identified at one face; an edge or a thin wall yields more. Of 50 N/mm it
// makes 20, the softest that shipped experiments draw.
constexpr double kContactGive_mpN = 3e-5;

void read_friction(const Map& friction, Task& task) {
  task.friction.nominal = friction.number("nominal", kFriction);
  const double nominal = task.friction.nominal;
  task.friction.low = friction.number("low", kFriction);
  if (task.friction.low > nominal) {
    friction.at("low").refuse_value(format("in [0, %g]: low, nominal and high ascend", nominal));
  }
  task.friction.high = friction.number("high", kFriction);
  if (task.friction.high < nominal) {
    friction.at("high").refuse_value(format("in [%g, 2]: low, nominal and high ascend", nominal));
  }
}

void read_physics(const Value& value, Task& task) {
  const Map map(value, {"friction", "contact_stiffness_Npm", "contact_give_mpN", "oversize_m",
                        "tilt_rad", "sensor_error_m", "rollout_step_s"});
  read_friction(Map(map.at("friction"), {"low", "nominal", "high"}), task);
  task.contact_stiffness_Npm = map.number("contact_stiffness_Npm", {1e2, 1e8});
  task.contact_give_mpN = kContactGive_mpN;
  map.optional_number("contact_give_mpN", {0.0, 1e-3}, task.contact_give_mpN);
  map.optional_number("oversize_m", {0.0, 0.01}, task.oversize_m);
  task.tilt_rad = kCalibrated_rad;
  map.optional_number("tilt_rad", {0.0, 0.05}, task.tilt_rad);
  task.sensor_error_m = kPressLever_m;
  map.optional_number("sensor_error_m", {0.0, 0.02}, task.sensor_error_m);

  // A longer way within one step sinks too deep before the contact answers.
  constexpr double kStepTravelMax_m = 0.5e-3;
  const double step_max_s = std::min(0.01, kStepTravelMax_m / task.motion.speeds.approach_mps);
  double step_s = std::min(0.002, step_max_s);
  map.optional_number("rollout_step_s", {1e-4, step_max_s}, step_s);
  task.rollout_step_us = microseconds(step_s);
}

/// Every move may run at contact speed throughout. @param primitives null: its steps are as long as
/// the starts' errors ask for, and errors larger than the part are often in another unit
void check_time_for_a_step(const Value* primitives, const Value& starts, const Value& speeds_of,
                           const Task& task) {
  const SpeedLimits& speeds = task.motion.speeds;
  double step_s = 0.0;
  for (int axis = 0; axis < 6; ++axis) {
    if (!has(task.coordinates, axis)) continue;
    step_s = std::max(
        step_s, axis < 3 ? task.step_m / speeds.contact_mps : task.step_rad / speeds.contact_radps);
  }
  const double timeout_s = 1e-6 * task.motion.timeout_us;
  if (step_s <= timeout_s) return;
  const std::string times =
      format("%g s at contact speed, contact.timeout_s is %g s", step_s, timeout_s);
  if (primitives == nullptr) {
    const bool turns = task.step_m / speeds.contact_mps < step_s;
    const Vector6& sigma = task.starts.front().sigma;
    const double error =
        task.particle_sigmas * (turns ? sigma.tail<3>() : sigma.head<3>()).maxCoeff();
    double part_m = 0.0;
    for (const Shape& shape : task.held) part_m = std::max(part_m, shape.size_m.maxCoeff());
    if (!turns && error < part_m) {
      speeds_of.refuse(
          format("contact_mps = %g: a step of %.3g m takes ", speeds.contact_mps, task.step_m) +
          times + ": more speed, or a longer contact.timeout_s");
    }
    starts.refuse(
        format("errors up to %g %s, of a part that measures %g m, ask for moves that take ", error,
               turns ? "rad" : "m", part_m) +
        times + ": are all lengths in m, all angles in rad?");
  }
  primitives->refuse("a step takes " + times + ": shorter steps, more speed or more time");
}

/// With the variant's name behind it, as long as a plan can hold.
std::string read_name(const Value& value, const std::optional<std::string>& variant) {
  std::string name = value.name();
  if (variant) name += "/" + *variant;
  if (name.size() > config::kNameMax) {
    value.refuse("with its variant, '" + name + "', longer than " +
                 std::to_string(config::kNameMax) + " characters");
  }
  return name;
}

}  // namespace

Task load_task(const std::filesystem::path& name) {
  const auto [file, variant] = config::split_variant(name);
  const std::string text = config::read_file(file);
  const Value document = Value::parse(file, text);
  config::expect_kind(file, document, config::FileKind::kTask);
  const Map map(
      variant ? config::with_variant(document, *variant) : document,
      {"name", "coordinates", "held", "environment", "starts", "error_about_m", "particle_sigmas",
       "goal", "primitives", "speeds", "contact", "compliance", "search", "physics", "variants"});
  Task task;
  task.name = read_name(map.at("name"), variant);
  task.coordinates = read_axes(map.at("coordinates"));

  config::ShapeReader shapes(file.parent_path());
  task.held = shapes.read(map.at("held"));
  task.environment = shapes.read(map.at("environment"));
  task.hash = fnv1a_64((variant ? text + "#" + *variant : text) + shapes.contents());

  read_goal(map.at("goal"), task);
  config::read_starts(map.at("starts"), *map.at("goal").peek("pose"), task);
  if (const auto about = map.find("error_about_m")) {
    task.error_about_m = about->vector({-kSizeMax_m, kSizeMax_m});
  }
  config::read_reach(map, task);

  const auto primitives = map.find("primitives");
  if (primitives) {
    read_primitives(*primitives, task);
  } else {
    derive_moves(task);
  }
  task.motion.speeds = read_speeds(map.at("speeds"));
  read_physics(map.at("physics"), task);
  read_compliance(map.at("compliance"), task);
  read_contact(map.at("contact"), task);
  if (const auto search = map.find("search")) read_search(*search, task);
  check_time_for_a_step(primitives ? &*primitives : nullptr, map.at("starts"), map.at("speeds"),
                        task);
  return task;
}

std::vector<std::string> task_variants(const std::filesystem::path& file) {
  return config::variant_names(Value::parse(file, config::read_file(file)));
}

void check_variants(const std::filesystem::path& name) {
  if (config::split_variant(name).variant) return;
  for (const std::string& variant : task_variants(name)) {
    try {
      static_cast<void>(load_task(format("%s#%s", name.c_str(), variant.c_str())));
    } catch (const InputError& error) {
      throw InputError(format("%s (of variant '%s')", error.what(), variant.c_str()));
    }
  }
}

}  // namespace tenon

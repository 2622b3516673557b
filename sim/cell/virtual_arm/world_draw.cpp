#include "sim/cell/virtual_arm/world_draw.h"

#include <cmath>
#include <string_view>

#include "shared/base/error.h"
#include "shared/base/random.h"
#include "shared/ports/arm.h"

namespace tenon::sim {
namespace {

constexpr double kSigmasMax = 3.0;

/// The draws of one quantity. Of its name, so that its stream depends on nothing else.
class Stream {
 public:
  Stream(std::string_view quantity, const Spread& spread, std::uint64_t seed)
      : spread_(spread), source_(stream_seed(seed, quantity)) {}

  [[nodiscard]] double next() {
    if (spread_.sigma == 0.0) {
      return source_.uniform(spread_.low, spread_.high);
    }
    double value = source_.normal();
    while (std::abs(value) > kSigmasMax) value = source_.normal();
    return spread_.sigma * value;
  }
  [[nodiscard]] Vector3 next_vector() {
    Vector3 vector;
    for (int axis = 0; axis < 3; ++axis) vector[axis] = next();
    return vector;
  }

 private:
  Spread spread_;
  Random source_;
};

/// A round thing stays round, and a solid grows or shrinks on all sides alike.
Vector3 grown(const Shape& shape, double by_m, const Vector3& error_m) {
  Vector3 size_m = shape.size_m + Vector3::Constant(by_m) + error_m;
  if (shape.kind == Shape::Kind::kCylinder) size_m.y() = size_m.x();
  if (shape.kind == Shape::Kind::kSolid) {
    size_m = shape.size_m + Vector3::Constant(by_m + error_m.x());
  }
  if (size_m.minCoeff() <= 0.0) {
    throw InputError("experiment: clearance_m and size_error_m leave nothing of shape " +
                     shape.name + "; choose smaller ones");
  }
  return size_m;
}

void grow(std::vector<Shape>& shapes, double by_m, const std::vector<Vector3>& errors_m) {
  for (std::size_t i = 0; i < shapes.size(); ++i) {
    const Vector3 error_m = i < errors_m.size() ? errors_m[i] : Vector3::Zero();
    shapes[i].size_m = grown(shapes[i], by_m, error_m);
  }
}

/// Of an arm's drives, as many as an arm can have.
std::vector<DriveFriction> drawn_friction(const DriveFrictionRange& range, std::uint64_t seed) {
  constexpr double kCoulombLeast = 0.5;     // of what a drive has
  constexpr double kHysteresisLeast = 0.1;  // the rest is viscous
  constexpr double kPart = 0.1;
  Random source(stream_seed(range.seed.value_or(seed), "drive_friction"));
  std::vector<DriveFriction> drives(kMaxJoints);
  for (DriveFriction& drive : drives) {
    const double share = source.uniform(range.share.low, range.share.high);
    drive.coulomb_share = share * (kCoulombLeast + kPart * source.uniform());
    drive.hysteresis_share = share * (kHysteresisLeast + kPart * source.uniform());
    drive.viscous_share = share - drive.coulomb_share - drive.hysteresis_share;
    drive.way_factor = 0.5 + source.uniform();
    drive.start = 2.0 * source.uniform() - 1.0;
  }
  return drives;
}

}  // namespace

WorldDraw draw_world(const WorldRanges& ranges, const Task& task, std::uint64_t seed) {
  const auto stream = [seed](std::string_view quantity, const Spread& spread) {
    return Stream(quantity, spread, seed);
  };
  const auto one = [&](std::string_view quantity, const Spread& spread) {
    return stream(quantity, spread).next();
  };
  const auto twist = [&](std::string_view linear, const Spread& spread_m, std::string_view angular,
                         const Spread& spread_rad) {
    Vector6 error;
    error << stream(linear, spread_m).next_vector(), stream(angular, spread_rad).next_vector();
    return error;
  };
  const auto sizes = [&](std::string_view quantity, const std::vector<Shape>& shapes) {
    Stream errors = stream(quantity, ranges.size_error_m);
    std::vector<Vector3> sizes_m;
    for (std::size_t i = 0; i < shapes.size(); ++i) sizes_m.push_back(errors.next_vector());
    return sizes_m;
  };

  WorldDraw draw;
  if (ranges.friction) draw.friction = one("friction", *ranges.friction);
  if (ranges.contact_stiffness_Npm) {
    draw.contact_stiffness_Npm = one("contact_stiffness_Npm", *ranges.contact_stiffness_Npm);
  }
  draw.clearance_m = one("clearance_m", ranges.clearance_m);
  draw.held_size_error_m = sizes("held_size_error_m", task.held);
  draw.environment_size_error_m = sizes("environment_size_error_m", task.environment);
  draw.task_in_base_error = twist("task_in_base_error_m", ranges.task_in_base_error_m,
                                  "task_in_base_error_rad", ranges.task_in_base_error_rad);
  draw.tool_in_flange_error = twist("tool_in_flange_error_m", ranges.tool_in_flange_error_m,
                                    "tool_in_flange_error_rad", ranges.tool_in_flange_error_rad);
  draw.sensor_in_flange_error =
      twist("sensor_in_flange_error_m", ranges.sensor_in_flange_error_m,
            "sensor_in_flange_error_rad", ranges.sensor_in_flange_error_rad);
  draw.payload_mass_error_kg = one("payload_mass_error_kg", ranges.payload_mass_error_kg);
  draw.payload_com_error_m =
      stream("payload_com_error_m", ranges.payload_com_error_m).next_vector();
  draw.servo_stiffness_factor = one("servo_stiffness_factor", ranges.servo_stiffness_factor);
  draw.extra_delay_s = one("extra_delay_s", ranges.extra_delay_s);
  draw.backlash_m = one("backlash_m", ranges.backlash_m);
  draw.backlash_rad = one("backlash_rad", ranges.backlash_rad);
  if (ranges.drive_friction) draw.drive_friction = drawn_friction(*ranges.drive_friction, seed);
  draw.sensor_noise_factor = one("sensor_noise_factor", ranges.sensor_noise_factor);
  draw.force_drift_N_sqrts = one("force_drift_N_sqrts", ranges.force_drift_N_sqrts);
  draw.torque_drift_Nm_sqrts = one("torque_drift_Nm_sqrts", ranges.torque_drift_Nm_sqrts);
  return draw;
}

Cell real_cell(const Cell& cell, const WorldDraw& draw) {
  Cell real = cell;
  real.X_BT = displaced(cell.X_BT, draw.task_in_base_error);
  real.X_FP = displaced(cell.X_FP, draw.tool_in_flange_error);
  real.X_FS = displaced(cell.X_FS, draw.sensor_in_flange_error);
  real.payload_mass_kg += draw.payload_mass_error_kg;
  if (cell.payload_mass_kg > 0.0 && real.payload_mass_kg <= 0.0) {
    throw InputError("experiment: payload_mass_error_kg leaves nothing of the payload of " +
                     std::to_string(cell.payload_mass_kg) + " kg; choose a smaller one");
  }
  // The payload hangs where it hangs, however the sensor is turned.
  const Vector3 com_in_flange_m =
      cell.X_FS.position_m +
      cell.X_FS.orientation * (cell.payload_com_m + draw.payload_com_error_m);
  real.payload_com_m = real.X_FS.orientation.conjugate() * (com_in_flange_m - real.X_FS.position_m);
  real.contact_stiffness_Npm = draw.contact_stiffness_Npm.value_or(cell.contact_stiffness_Npm);
  for (Joint& joint : real.robot.joints) joint.stiffness *= draw.servo_stiffness_factor;
  real.robot.sensor.force_noise_N *= draw.sensor_noise_factor;
  real.robot.sensor.torque_noise_Nm *= draw.sensor_noise_factor;
  return real;
}

Task real_task(const Task& task, const WorldDraw& draw) {
  Task real = task;
  real.friction.nominal = draw.friction.value_or(task.friction.nominal);
  grow(real.held, -draw.clearance_m, draw.held_size_error_m);
  grow(real.environment, 0.0, draw.environment_size_error_m);
  return real;
}

}  // namespace tenon::sim

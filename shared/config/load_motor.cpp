#include "shared/config/load_motor.h"

#include <algorithm>
#include <cmath>

#include "shared/base/text.h"
#include "shared/mit/constants.h"
#include "shared/mit/robot_motors.h"

namespace tenon::config {
namespace {

constexpr double kFullScale = 65535.0;

/// The joint's counts are the 16 bits of a position on the wire.
void set_counts(const Map& map, const MitMotor& motor, Joint& joint) {
  double zero_rad = 0.0;
  map.optional_number("zero_rad", within(motor.position_max_rad), zero_rad);
  const auto reversed = map.find("reversed");
  const double sign = reversed && reversed->choice({"false", "true"}) == 1 ? -1.0 : 1.0;
  const double per_rad = 0.5 * kFullScale / motor.position_max_rad;
  joint.counts_per_unit = sign * per_rad;
  joint.zero_counts = (zero_rad + motor.position_max_rad) * per_rad;
  for (const double end : {joint.lower, joint.upper}) {
    if (std::abs(sign * end + zero_rad) < motor.position_max_rad) continue;
    map.at("position_max_rad")
        .refuse(format("the joint goes to %g rad, the motor to %g at most", end,
                       motor.position_max_rad));
  }
}

}  // namespace

void read_motor(const Value& value, std::set<std::int64_t>& nodes, Joint& joint) {
  if (joint.kind != Joint::Kind::kRevolute) {
    value.refuse("joint " + joint.name + " is prismatic; motors in MIT mode turn");
  }
  const Map map(value,
                {"name", "node", "feedback_id", "reversed", "zero_rad", "position_max_rad",
                 "velocity_max_radps", "torque_max_Nm", "kp_Nmprad", "kd_Nmsprad", "watchdog_ms",
                 "acceleration_max_radps2", "rated_effort_Nm", "following_error_max_rad"});
  const Value node = map.at("node");
  joint.node = static_cast<std::uint8_t>(node.integer(1, mit::kMotorIdMax));
  if (!nodes.insert(joint.node).second) node.refuse_value("a number that nothing else uses");
  MitMotor motor;
  motor.feedback_id = static_cast<std::uint32_t>(
      map.at("feedback_id").integer(1, std::int64_t{mit::kRegisterId} - 1));
  motor.position_max_rad = map.number("position_max_rad", positive_to(1e3));
  motor.velocity_max_radps = map.number("velocity_max_radps", positive_to(1e3));
  motor.torque_max_Nm = map.number("torque_max_Nm", positive_to(1e3));
  motor.stiffness_Nmprad = map.number("kp_Nmprad", positive_to(mit::kStiffnessMax));
  motor.damping_Nmsprad = map.number("kd_Nmsprad", positive_to(mit::kDampingMax));
  motor.watchdog_ms = static_cast<std::uint32_t>(map.at("watchdog_ms").integer(1, 1000));
  set_counts(map, motor, joint);
  joint.acceleration_max = map.number("acceleration_max_radps2", positive_to(1e4));
  joint.rated_effort = map.number("rated_effort_Nm", positive_to(motor.torque_max_Nm));
  joint.following_error_max = map.number("following_error_max_rad", positive_to(1.0));
  // What the URDF allows beyond it, no command can say.
  joint.effort_max = std::min(joint.effort_max, motor.torque_max_Nm);
  joint.speed_max = std::min(joint.speed_max, motor.velocity_max_radps);
  joint.stiffness = motor.stiffness_Nmprad;
  joint.drive = motor;
}

}  // namespace tenon::config

#include "tests/support/hand_made.h"

#include <algorithm>
#include <numbers>

namespace tenon::executor {
namespace {

Eigen::Quaterniond turn(double angle_rad, const Vector3& axis) {
  return Eigen::Quaterniond(Eigen::AngleAxisd(angle_rad, axis));
}

}  // namespace

Cell hand_made_cell() {
  Cell cell;
  cell.name = "hand-made";
  cell.robot.name = "gantry";
  for (int axis = 0; axis < 3; ++axis) {
    Joint joint;
    joint.name = std::string(1, "xyz"[axis]);
    joint.axis = Vector3::Unit(axis);
    joint.lower = -0.5;
    joint.upper = 0.5;
    joint.speed_max = 0.5;
    joint.acceleration_max = 10.0;
    cell.robot.joints.push_back(joint);
  }
  cell.robot.cycle_us = 2000;
  cell.robot.measurement_delay_cycles = 1;
  cell.robot.response_lag_s = 0.0;
  cell.robot.sensor = {.node = 4,
                       .force_per_count_N = 0.01,
                       .torque_per_count_Nm = 0.001,
                       .force_range_N = 200.0,
                       .torque_range_Nm = 20.0,
                       .force_noise_N = 0.1,
                       .torque_noise_Nm = 1e-4};
  const double yaw_rad = std::numbers::pi / 6;
  cell.X_BT = {Vector3(0.02, -0.01, -0.10), turn(yaw_rad, Vector3::UnitZ())};
  cell.X_FP = {Vector3(0.0, 0.0, -0.12), turn(yaw_rad, Vector3::UnitZ())};
  cell.X_FS = {Vector3(0.0, 0.0, -0.04), turn(std::numbers::pi / 2, Vector3::UnitX())};
  cell.payload_mass_kg = 0.4;
  cell.payload_com_m = Vector3(0.0, 0.01, 0.03);
  cell.contact_stiffness_Npm = 5e4;
  cell.force_fault_N = 60.0;
  cell.torque_fault_Nm = 10.0;
  return cell;
}

Cell hand_made_arm_cell() {
  Cell cell = hand_made_cell();
  cell.name = "hand-made arm";
  cell.robot.name = "arm";
  cell.robot.joints.clear();
  const double half = std::numbers::pi / 2;
  const double whole = std::numbers::pi;
  const auto add = [&](const Vector3& xyz_m, const Vector3& rpy_rad, double range_rad) {
    Joint joint;
    joint.name = "arm_" + std::to_string(cell.robot.joints.size() + 1);
    joint.kind = Joint::Kind::kRevolute;
    joint.origin = {xyz_m, turn(rpy_rad.z(), Vector3::UnitZ()) *
                               turn(rpy_rad.y(), Vector3::UnitY()) *
                               turn(rpy_rad.x(), Vector3::UnitX())};
    joint.axis = Vector3::UnitZ();
    joint.lower = -range_rad;
    joint.upper = range_rad;
    joint.speed_max = 1.26;
    joint.acceleration_max = 5.0;
    cell.robot.joints.push_back(joint);
  };
  add({0, 0, 0}, {0, 0, 0}, 2.967);
  add({0, 0, 0}, {half, 0, 0}, 2.967);
  add({0, 0.350, 0}, {0, whole, 0}, 2.714);
  add({0, 0, 0}, {-half, whole, 0}, 2.967);
  add({0, 0.005263, 0.305}, {half, 0, whole}, 2.967);
  add({0, 0, 0}, {-half, 0, 0}, 2.967);
  cell.X_BT = {Vector3(0.40, 0.0, 0.05), Eigen::Quaterniond::Identity()};
  cell.X_FP = {Vector3(0.0, 0.0, 0.12), turn(whole, Vector3::UnitX())};
  cell.X_FS = {Vector3(0.0, 0.0, 0.04), Eigen::Quaterniond::Identity()};
  return cell;
}

Step hand_made_step(int axis, double displacement_m,
                    std::initializer_list<std::pair<Outcome, Successor>> ways) {
  Step step;
  step.displacement[axis] = displacement_m;
  for (const auto& [outcome, successor] : ways) {
    OutcomeRule& rule = step.outcomes[static_cast<std::size_t>(outcome)];
    rule.successor = successor;
    rule.envelope.travelled_min.head<3>().setConstant(-2e-3);
    rule.envelope.travelled_max.head<3>().setConstant(2e-3);
    rule.envelope.travelled_min[axis] = std::min(0.0, displacement_m) - 2e-3;
    rule.envelope.travelled_max[axis] = std::max(0.0, displacement_m) + 2e-3;
    rule.envelope.possible = kAllContacts;
  }
  return step;
}

Plan hand_made_plan() {
  Plan plan;
  plan.task_name = "hand-made";
  plan.start_name = "s1";
  plan.coordinates = 0x07;
  plan.start.position_m = Vector3(0.1, 0.0, 0.0);
  plan.goal = plan.start;
  plan.compliance.compliant_axes = 0x07;
  plan.latency_max_s = 0.010;
  plan.parameter_sets.emplace_back();
  return plan;
}

Plan touch_and_slide_plan() {
  Plan plan = hand_made_plan();
  plan.steps.push_back(hand_made_step(0, 0.05, {{Outcome::kContact, Successor{1}}}));
  plan.steps.push_back(hand_made_step(1, 0.04, {{Outcome::kReached, kSuccessorDone}}));
  plan.steps[0].outcomes[1].envelope.always.bits = ContactSignature::bit(0, -1);
  return plan;
}

Plan arm_plan() {
  Plan plan = touch_and_slide_plan();
  plan.start.position_m = Vector3(0.0, 0.0, 0.05);
  return plan;
}

}  // namespace tenon::executor

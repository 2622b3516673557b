#include "tests/hw/gantry_on_bus.h"

#include "hw/arm/describe_fault.h"

namespace tenon::hw {

Robot gantry_robot() {
  Robot robot;
  robot.name = "gantry";
  for (const auto& [name, node] : {std::pair{"x", 1}, {"y", 2}, {"z", 3}}) {
    Joint joint;
    joint.name = name;
    joint.node = static_cast<std::uint8_t>(node);
    joint.counts_per_unit = 1e6;
    joint.lower = -1.0;
    joint.upper = 1.0;
    joint.speed_max = 1.0;
    joint.acceleration_max = 10.0;
    joint.effort_max = 400.0;
    joint.rated_effort = 200.0;
    joint.following_error_max = 0.005;
    robot.joints.push_back(joint);
  }
  robot.sensor.node = 4;
  robot.sensor.force_per_count_N = 0.01;
  robot.sensor.torque_per_count_Nm = 0.0005;
  robot.sensor.force_range_N = 300.0;
  robot.sensor.torque_range_Nm = 15.0;
  return robot;
}

GantryOnBus::GantryOnBus(const Robot& robot_in)
    : robot(robot_in), master(bus.attach()), arm(robot, master) {
  for (const Joint& joint : robot.joints) {
    nodes.push_back(
        std::make_unique<ScriptedNode>(ScriptedNode::Kind::kDrive, joint.node, bus.attach()));
  }
  nodes.push_back(
      std::make_unique<ScriptedNode>(ScriptedNode::Kind::kSensor, robot.sensor.node, bus.attach()));
}

void GantryOnBus::step_nodes() {
  for (const auto& node : nodes) node->step(now_ns);
}

bool GantryOnBus::prepare(int limit_ms) {
  for (int i = 0; i < limit_ms; ++i) {
    if (arm.prepare(now_ns)) return true;
    if (arm.state() == ArmState::kFault) return false;
    step_nodes();
    now_ns += 1'000'000;
    bus.advance(now_ns);
  }
  return false;
}

std::string GantryOnBus::refused(int limit_ms) {
  if (prepare(limit_ms) || arm.state() != ArmState::kFault) return "";
  return describe(arm.fault(), robot);
}

bool GantryOnBus::cycle(ArmRequest request, const JointVector& position) {
  arm.start_cycle(now_ns);
  step_nodes();
  const bool complete = arm.receive(now_ns + 500'000, feedback);
  arm.command(now_ns + 600'000, request, position);
  now_ns += 2'000'000;
  bus.advance(now_ns);
  return complete;
}

bool GantryOnBus::run_until(ArmState state, ArmRequest request, int limit) {
  for (int i = 0; i < limit; ++i) {
    cycle(request, feedback.position);
    if (arm.state() == state) return true;
  }
  return false;
}

bool GantryOnBus::prepare_and_enable() {
  return prepare() && run_until(ArmState::kEnabled, ArmRequest::kEnabled);
}

}  // namespace tenon::hw

#pragma once
// The virtual cell behind a master that writes its frames by hand: three axes as nodes 1 to 3 and a
// force/torque sensor as node 4, SYNC every 2 ms in virtual time, counts of a micrometre.
//
//   cycle():  SYNC ──> cell steps ──> feedback read ──> controlword and target of each axis sent

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "shared/cell/cell.h"
#include "shared/task/task.h"
#include "sim/cell/virtual_arm/virtual_cell.h"
#include "tests/sim/literal_client.h"

namespace tenon::sim {

inline Cell gantry_cell() {
  Cell cell;
  cell.name = "test";
  cell.robot.name = "gantry";
  const std::array<double, 3> masses_kg = {12.0, 8.0, 4.0};
  for (int axis = 0; axis < 3; ++axis) {
    Joint joint;
    joint.name = std::string(1, static_cast<char>('x' + axis));
    joint.axis = Vector3::Unit(axis);
    joint.node = static_cast<std::uint8_t>(axis + 1);
    joint.counts_per_unit = 1e6;
    joint.lower = -0.8;
    joint.upper = 0.8;
    joint.acceleration_max = 10.0;
    joint.effort_max = 400.0;
    joint.rated_effort = 200.0;
    joint.stiffness = 1e6;
    joint.link.mass_kg = masses_kg[static_cast<std::size_t>(axis)];
    cell.robot.joints.push_back(joint);
  }
  cell.robot.sensor.node = 4;
  cell.robot.sensor.force_per_count_N = 0.01;
  cell.robot.sensor.torque_per_count_Nm = 0.0005;
  cell.robot.sensor.force_range_N = 300.0;
  cell.robot.sensor.torque_range_Nm = 15.0;
  cell.robot.sensor.force_noise_N = 0.1;
  cell.robot.sensor.torque_noise_Nm = 0.005;
  cell.robot.response_lag_s = 0.004;
  cell.X_FP.position_m = {0.0, 0.0, -0.15};
  cell.payload_mass_kg = 0.5;
  cell.payload_com_m = {0.02, 0.0, -0.10};
  return cell;
}

/// A cube of 0.1 m above a table, a wall 50 mm in front of its +x face.
inline Task wall_task() {
  Task task;
  task.name = "wall";
  task.coordinates = 0x03;
  Shape cube{"cube", Shape::Kind::kBox, {0.1, 0.1, 0.1}, {}};
  cube.pose.position_m.z() = 0.05;
  task.held = {cube};
  Shape table{"table", Shape::Kind::kBox, {1.0, 1.0, 0.05}, {}};
  table.pose.position_m.z() = -0.025;
  Shape wall{"wall", Shape::Kind::kBox, {0.05, 1.0, 0.1}, {}};
  wall.pose.position_m = {0.125, 0.0, 0.05};
  task.environment = {table, wall};
  Start start;
  start.name = "middle";
  start.pose.position_m.z() = 0.002;
  start.sigma.head<2>() = Vector3(0.03, 0.03, 0.0).head<2>();
  task.starts = {start};
  task.goal = start.pose;
  return task;
}

class LiteralCell {
 public:
  static constexpr std::int64_t kCycle_ns = 2'000'000;

  explicit LiteralCell(const Cell& cell_file = gantry_cell(), const Task& task = wall_task(),
                       const VirtualCell::Options& options = {})
      : cell(cell_file, task, options) {
    for (int i = 0; i < 10; ++i) step();  // boots up
  }

  /// One request to a node and its answer.
  CanFrame sdo(int node, std::initializer_list<int> request) {
    send(0x600U + static_cast<unsigned>(node), request);
    const std::vector<CanFrame> frames = step();
    for (const CanFrame& frame : frames) {
      if (frame.id == 0x580U + static_cast<unsigned>(node)) return frame;
    }
    return {};
  }
  void send(std::uint32_t id, std::initializer_list<int> bytes) {
    bus.to_devices.push_back(frame_of(id, bytes));
  }
  /// A millisecond without SYNC.
  std::vector<CanFrame> step() {
    now_ns += 1'000'000;
    return run();
  }

  /// PDOs, modes and the rest; false where a node refused something.
  bool configure() {
    bool good = true;
    const auto write = [&](int node, std::initializer_list<int> request) {
      good = sdo(node, request).data[0] == 0x60 && good;
    };
    for (int node = 1; node <= 3; ++node) {
      write(node, {0x2B, 0x17, 0x10, 0, 100, 0, 0, 0});
      write(node, {0x23, 0x16, 0x10, 1, 0x2C, 0x01, 0x7F, 0});  // node 127, 300 ms
      write(node, {0x2B, 0x07, 0x60, 0, 3, 0, 0, 0});
      write(node, {0x2B, 0x5A, 0x60, 0, 6, 0, 0, 0});
      write(node, {0x23, 0x65, 0x60, 0, 0x88, 0x13, 0, 0});  // 5 mm
      write(node, {0x2B, 0x66, 0x60, 0, 20, 0, 0, 0});
      write(node, {0x2F, 0xC2, 0x60, 1, 2, 0, 0, 0});
      write(node, {0x2F, 0xC2, 0x60, 2, 0xFD, 0, 0, 0});
      write(node, {0x2F, 0x60, 0x60, 0, 8, 0, 0, 0});
      // RPDO 1: controlword, target. TPDO 1: statusword, position, torque. Both with SYNC.
      write(node, {0x23, 0x00, 0x14, 1, node, 0x02, 0, 0x80});
      write(node, {0x2F, 0x00, 0x16, 0, 0, 0, 0, 0});
      write(node, {0x23, 0x00, 0x16, 1, 0x10, 0, 0x40, 0x60});
      write(node, {0x23, 0x00, 0x16, 2, 0x20, 0, 0x7A, 0x60});
      write(node, {0x2F, 0x00, 0x16, 0, 2, 0, 0, 0});
      write(node, {0x2F, 0x00, 0x14, 2, 1, 0, 0, 0});
      write(node, {0x23, 0x00, 0x14, 1, node, 0x02, 0, 0});
      write(node, {0x23, 0x00, 0x18, 1, 0x80 + node, 0x01, 0, 0x80});
      write(node, {0x2F, 0x00, 0x1A, 0, 0, 0, 0, 0});
      write(node, {0x23, 0x00, 0x1A, 1, 0x10, 0, 0x41, 0x60});
      write(node, {0x23, 0x00, 0x1A, 2, 0x20, 0, 0x64, 0x60});
      write(node, {0x23, 0x00, 0x1A, 3, 0x10, 0, 0x77, 0x60});
      write(node, {0x2F, 0x00, 0x1A, 0, 3, 0, 0, 0});
      write(node, {0x2F, 0x00, 0x18, 2, 1, 0, 0, 0});
      write(node, {0x23, 0x00, 0x18, 1, 0x80 + node, 0x01, 0, 0});
    }
    send(0x000, {0x01, 0x00});
    return good;
  }

  /// One control cycle; `control` and `target_counts` leave after the feedback is in.
  void cycle() {
    now_ns += kCycle_ns;
    send(0x080, {});
    take(run());
    if (master_alive) {
      if (++cycles % 50 == 0) send(0x77F, {0x05});
      for (int node = 1; node <= 3; ++node) {
        const std::int32_t target = target_counts[static_cast<std::size_t>(node - 1)];
        send(0x200U + static_cast<unsigned>(node),
             {control & 0xFF, control >> 8, target & 0xFF, target >> 8 & 0xFF, target >> 16 & 0xFF,
              target >> 24 & 0xFF});
      }
    }
  }
  void cycles_of(int control_word, int count) {
    control = control_word;
    for (int i = 0; i < count; ++i) cycle();
  }

  /// configure(), targets aligned, operation enabled.
  bool enable() {
    if (!configure()) return false;
    cycles_of(0x06, 2);
    target_counts = position_counts;
    cycles_of(0x06, 2);
    cycles_of(0x07, 2);
    cycles_of(0x0F, 15);  // the brakes open
    return (status[0] & 0x6F) == 0x27 && (status[1] & 0x6F) == 0x27 && (status[2] & 0x6F) == 0x27;
  }
  /// Moves one axis evenly.
  void move(int axis, int counts_a_cycle, int count) {
    for (int i = 0; i < count; ++i) {
      target_counts[static_cast<std::size_t>(axis)] += counts_a_cycle;
      cycle();
    }
  }
  /// Mean of the wrench over so many cycles, N and Nm.
  Vector6 mean_wrench(int count) {
    Vector6 sum = Vector6::Zero();
    for (int i = 0; i < count; ++i) {
      cycle();
      sum += wrench;
    }
    return sum / count;
  }

  VirtualCell cell;
  LiteralBus bus;
  std::int64_t now_ns = 0;
  bool master_alive = true;
  int cycles = 0;
  int control = 0;
  std::array<std::int32_t, 3> target_counts{};
  // Feedback.
  std::array<int, 3> status{};
  std::array<std::int32_t, 3> position_counts{};
  std::array<int, 3> torque_permille{};
  Vector6 wrench = Vector6::Zero();
  std::array<int, 2> sample{};
  std::vector<std::string> log;  ///< all that the devices sent

 private:
  std::vector<CanFrame> run() {
    cell.step(now_ns, bus);
    std::vector<CanFrame> frames;
    frames.swap(bus.from_devices);
    for (const CanFrame& frame : frames) log.push_back(text_of(frame));
    return frames;
  }
  void take(const std::vector<CanFrame>& frames) {
    for (const CanFrame& frame : frames) {
      if (frame.id >= 0x181 && frame.id <= 0x183) {
        const std::size_t axis = frame.id - 0x181;
        status[axis] = i16_at(frame, 0) & 0xFFFF;
        position_counts[axis] = i32_at(frame, 2);
        torque_permille[axis] = i16_at(frame, 6);
      }
      for (int i = 0; i < 3; ++i) {
        const auto at = static_cast<std::size_t>(2 * i);
        if (frame.id == 0x184) wrench[i] = 0.01 * i16_at(frame, at);
        if (frame.id == 0x284) wrench[3 + i] = 0.0005 * i16_at(frame, at);
      }
      if (frame.id == 0x184) sample[0] = i16_at(frame, 6) & 0xFFFF;
      if (frame.id == 0x284) sample[1] = i16_at(frame, 6) & 0xFFFF;
    }
  }
};

}  // namespace tenon::sim

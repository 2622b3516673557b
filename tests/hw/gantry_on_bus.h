#pragma once
// A CanopenArm and the scripted nodes of a three-axis gantry on one virtual bus, on which
// frames take no time.
//
//   step 1 ms: master | nodes | master | ...     cycle 2 ms: SYNC | nodes | receive | command

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "hw/arm/canopen_arm.h"
#include "shared/cell/robot.h"
#include "sim/cell/bus/virtual_bus.h"
#include "tests/hw/scripted_node.h"

namespace tenon::hw {

/// Nodes 1, 2, 3 (x, y, z; 1e6 counts a metre, rated 200 N) and sensor 4 (0.01 N, 0.0005 Nm a
/// count).
[[nodiscard]] Robot gantry_robot();

class GantryOnBus {
 public:
  explicit GantryOnBus(const Robot& robot = gantry_robot());

  /// Runs prepare() every millisecond until it succeeds or fails, at most `limit_ms`.
  bool prepare(int limit_ms = 10'000);
  /// What is said of the fault in which prepare() ends; empty where it succeeds.
  std::string refused(int limit_ms = 10'000);
  /// One control cycle of 2 ms; true where receive() said complete.
  bool cycle(ArmRequest request, const JointVector& position = {});
  /// Cycles until the state is reached; false after `limit` cycles.
  bool run_until(ArmState state, ArmRequest request, int limit = 200);
  bool prepare_and_enable();
  void step_nodes();

  Robot robot;
  sim::VirtualBus bus{{.bitrate_bps = 0}};
  CanBus& master;
  CanopenArm arm;
  std::vector<std::unique_ptr<ScriptedNode>> nodes;  ///< x, y, z, sensor
  ArmFeedback feedback;
  std::int64_t now_ns = 1'000'000'000;
};

}  // namespace tenon::hw

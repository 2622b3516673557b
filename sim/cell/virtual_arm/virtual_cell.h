#pragma once
// The whole virtual cell: drives and sensor on the bus, the arm and its environment in physics, and
// the truth about them. It answers on CAN as a real cell would and has no clock: the caller's time
// drives it, in lockstep or in real time.
//
//   time     ──────SYNC k──────────────────────SYNC k+1──────────────────────SYNC k+2
//   PDOs           feedback k sampled          feedback k+1                  feedback k+2
//   targets        sent after feedback k ────> taken up, interpolated ─────> reached
//
// Frames are taken in order; before a SYNC acts, physics catches up with the given time. One
// thread. ODE counts its complaints per thread, so the cell must stay on the thread that made it.

#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "shared/cell/cell.h"
#include "shared/eds/device_file.h"
#include "shared/ports/arm.h"
#include "shared/ports/can_bus.h"
#include "shared/task/task.h"
#include "sim/cell/faults/fault.h"
#include "sim/cell/faults/fault_phases.h"
#include "sim/cell/virtual_arm/cell_moment.h"
#include "sim/cell/virtual_arm/truth.h"
#include "sim/cell/virtual_arm/world_draw.h"

namespace tenon::sim {

class VirtualCell {
 public:
  struct Options {
    std::string start;                  ///< a start of the task; empty: its first
    std::uint64_t seed = 0;             ///< of the sensor's noise, and of the drives'
    Vector6 offset = Vector6::Zero();   ///< displacement of the environment, task axes
    WorldDraw world;                    ///< how the real cell and task differ from those given
    std::vector<Fault> faults;          ///< those of devices are carried out, those of the bus not
    FaultPhases* phases = nullptr;      ///< noted there too, for the bus; must outlive the cell
    std::optional<JointVector> joints;  ///< unset: tool at the start in the nominal task frame
    /// By node: what that joint's drive answers like.
    std::map<std::uint8_t, DeviceFile> twins{};
    /// Of what drives under power report of their efforts, in thousandths of the rated one: a few
    /// counts of 6077h, as of current sensors; standard deviation.
    double effort_noise_permille = 2.0;
    std::int64_t physics_step_ns = 500'000;
    bool watched = false;  ///< gathers what moment() tells
    /// A clock of the caller's, read before and after each step of physics, for its cost alone.
    std::int64_t (*stopwatch_ns)() = nullptr;
  };

  /// Allocates. @throws InputError where the cell cannot hold this task, and for faults
  /// that can strike nothing of it
  VirtualCell(const Cell& cell, const Task& task, const Options& options);
  VirtualCell(const VirtualCell&) = delete;
  VirtualCell& operator=(const VirtualCell&) = delete;
  ~VirtualCell();

  /// Takes in all frames of the bus, advances to `now_ns`, and answers. The first call switches the
  /// cell on. Times must not decrease. Cost: about
  /// 10 us of computation for each millisecond passed.
  void step(std::int64_t now_ns, CanBus& bus);

  [[nodiscard]] Truth truth() const;
  /// The truth since it was last asked for, where the options have the cell watched. No allocation.
  [[nodiscard]] CellMoment moment();
  /// Where the task frame of the environment really stands, in the base: X_BE.
  [[nodiscard]] Pose environment() const;
  /// What physics took so far by the stopwatch.
  [[nodiscard]] std::int64_t physics_cost_ns() const;
  /// No joint moves.
  [[nodiscard]] bool at_standstill() const;

 private:
  class Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace tenon::sim

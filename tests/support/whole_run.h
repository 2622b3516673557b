#pragma once
// The whole chain in one process and in virtual time: executor, CANopen master, virtual bus in its
// own bit rate, virtual arm. No thread, no clock; no sleep either, unless the ends of a foreign bus
// are given.

#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "executor/dry_run/dry_run.h"
#include "executor/loop/controller.h"
#include "executor/loop/cycle_runner.h"
#include "hw/arm/canopen_arm.h"
#include "hw/robot_arm/open_arm.h"
#include "shared/cell/cell.h"
#include "shared/plan/plan.h"
#include "shared/task/task.h"
#include "sim/cell/faults/bus_faults.h"
#include "sim/cell/faults/fault.h"
#include "sim/cell/faults/fault_phases.h"
#include "sim/cell/lockstep/lockstep.h"
#include "sim/cell/lockstep/virtual_clock.h"
#include "sim/cell/lockstep/virtual_link.h"
#include "sim/cell/virtual_arm/virtual_cell.h"

namespace tenon::tests {

/// One run of a plan. Use it on one thread, the one that made it.
class WholeRun {
 public:
  struct Options {
    std::string start;
    std::uint64_t seed = 1;
    Vector6 offset = Vector6::Zero();
    executor::Controller::Parameters controller;
    double bit_error_rate = 0.0;
    std::vector<sim::Fault> faults;              ///< of the bus and of devices
    std::map<std::uint8_t, DeviceFile> twins{};  ///< by node
    sim::WorldDraw world;
    std::optional<JointVector> joints;  ///< where the arm stands; unset: at the start
    /// Of what drives report of their efforts; unset: the virtual arm's.
    std::optional<double> effort_noise_permille{};
    sim::Link* link = nullptr;  ///< in place of the virtual bus; must outlive the run
    /// What is executed where it was made already, for this cell or another; unset: by the run.
    std::optional<executor::DryRun> dry_run = std::nullopt;
    /// Called with every setpoint on its way from the executor to the arm; empty: left alone.
    std::function<void(JointVector&)> tamper{};
  };
  struct Result {
    executor::Ending ending;
    sim::Truth truth;
    std::size_t steps = 0;
    std::int64_t cycles = 0;
    std::string reason;  ///< one line
  };

  WholeRun(const Cell& cell, const Task& task, const Plan& plan, const Options& options,
           executor::CycleSink* sink = nullptr);
  WholeRun(const WholeRun&) = delete;
  WholeRun& operator=(const WholeRun&) = delete;
  ~WholeRun() = default;

  /// Brings the arm up. False: it failed, see arm().fault().
  bool prepare();
  /// One control cycle. False once the run is over.
  bool cycle();
  /// prepare() and cycles to the end.
  Result run();
  /// prepare() and the loop's own run() on virtual time. @param late by how much it wakes late
  Result run_on_clock(sim::VirtualClock::Lateness late);
  /// As it stands.
  [[nodiscard]] Result result() const;

  /// Virtual time goes on without the executor: what a killed process looks like from the bus.
  void leave_alone(double duration_s);

  /// Not where another link was given.
  [[nodiscard]] sim::VirtualBus& bus() { return link_->bus(); }
  [[nodiscard]] sim::VirtualBus& sensor_bus() { return link_->sensor_bus(); }
  [[nodiscard]] const sim::Lockstep::Statistics& statistics() const { return time_->statistics(); }
  [[nodiscard]] hw::DeviceArm& arm() { return *arm_; }
  [[nodiscard]] executor::Controller& controller() { return *controller_; }
  [[nodiscard]] executor::CycleRunner& runner() { return *runner_; }
  [[nodiscard]] sim::VirtualCell& cell() { return *virtual_cell_; }
  /// Which faults wait for; a test may begin one earlier than the cell would notice it.
  [[nodiscard]] sim::FaultPhases& phases() { return phases_; }
  [[nodiscard]] std::int64_t now_ns() const { return time_->now_ns(); }

 private:
  /// Of the plan, for the faults that wait for it.
  void note_step();

  Cell cell_description_;
  Plan plan_;
  std::unique_ptr<sim::VirtualLink> link_;
  sim::FaultPhases phases_;
  std::unique_ptr<sim::BusFaults> bus_faults_;
  std::unique_ptr<sim::LockstepBus> master_;
  std::unique_ptr<hw::DeviceArm> arm_;
  std::unique_ptr<Arm> port_;  ///< what the executor sees of it, where somebody tampers
  std::unique_ptr<executor::Controller> controller_;
  std::unique_ptr<executor::CycleRunner> runner_;
  std::unique_ptr<sim::VirtualCell> virtual_cell_;
  std::unique_ptr<sim::Lockstep> time_;
};

/// An offset of the environment: normal with the start's sigma on every search coordinate. Its
/// Mahalanobis distance comes back in `distance`.
[[nodiscard]] Vector6 draw_offset(const Task& task, const Start& start, std::uint64_t seed,
                                  double& distance);

}  // namespace tenon::tests

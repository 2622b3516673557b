#pragma once
// One trial of a plan: executor, CANopen master, bus and virtual cell in one process and in virtual
// time. Made, used and gone on one thread; reads no clock.

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "executor/dry_run/dry_run.h"
#include "executor/loop/controller.h"
#include "executor/loop/cycle_runner.h"
#include "executor/telemetry/run_result.h"
#include "hw/robot_arm/open_arm.h"
#include "shared/cell/cell.h"
#include "shared/ports/arm.h"
#include "shared/task/task.h"
#include "sim/cell/lockstep/lockstep.h"
#include "sim/cell/lockstep/virtual_link.h"
#include "sim/cell/virtual_arm/truth.h"
#include "sim/cell/virtual_arm/virtual_cell.h"
#include "sim/evaluation/evaluation.h"
#include "sim/evaluation/recording.h"
#include "sim/evaluation/trial.h"

namespace tenon::sim {

/// What all trials of a plan share.
struct PreparedPlan {
  const Cell& cell;
  const Task& task;
  const Candidate& candidate;
  executor::DryRun dry_run;
  JointVector joints{};  ///< where the arm stands at first
};

/// Where the part is, of a run that was done and is not at the goal. Of whether it is inserted only
/// where the task asks for that.
[[nodiscard]] std::string wrong_end_text(const Task& task, const Truth& truth);

class TrialChain {
 public:
  /// @param prepared must outlive it
  /// @throws InputError where the drawn world cannot be
  TrialChain(const PreparedPlan& prepared, const Trial& trial,
             const executor::CycleRunner::Parameters& loop);

  /// From bringing the arm up to the run's end. Once. @param recording null: none is made
  void run(Recording* recording = nullptr);
  /// What came of it, by the executor's word and by the truth.
  [[nodiscard]] TrialResult result() const;
  /// Prints the steps, the ending and the truth.
  void print() const;
  [[nodiscard]] const executor::BlackBox& black_box() const { return runner_.black_box(); }

 private:
  [[nodiscard]] executor::RunResult told() const;
  void follow();
  void record(Recording& recording) const;

  const Cell& cell_;
  const Task& task_;
  VirtualLink link_;
  std::unique_ptr<hw::DeviceArm> arm_;
  executor::Controller controller_;
  executor::CycleRunner runner_;
  VirtualCell virtual_cell_;
  Lockstep time_;
  bool plan_ran_ = false;
  std::int64_t began_ns_ = 0;    ///< the plan, in motion time
  std::vector<Vector3> path_m_;  ///< up to the last step that has ended
};

}  // namespace tenon::sim

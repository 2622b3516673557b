#pragma once
// One task on an arm over CAN: the bus, the loop on a thread of its own, and everything that writes
// along.

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "executor/loop/control_task.h"
#include "executor/loop/cycle_runner.h"
#include "executor/loop/stop_requests.h"
#include "executor/main_exec_options.h"
#include "executor/main_exec_output.h"
#include "executor/motion/plan_runner.h"
#include "executor/telemetry/recorder.h"
#include "executor/telemetry/run_result.h"
#include "executor/telemetry/telemetry.h"
#include "executor/telemetry/trace.h"
#include "shared/ports/can_bus.h"

namespace tenon::hw {
class Buses;
class DeviceArm;
class MeteredBus;
class RecordingBus;
}  // namespace tenon::hw

namespace tenon::executor {

class CanLog;

class TaskRun {
 public:
  /// Opens the bus and whatever is written to. All arguments outlive it.
  /// @param steps of the plan that the task runs, null where it runs none
  /// @param stop set by anyone to end the run in good order
  /// @throws InputError where something cannot be opened
  TaskRun(const Options& options, ControlTask& task, const PlanRunner* steps, StopRequests& stop);
  ~TaskRun();
  TaskRun(const TaskRun&) = delete;
  TaskRun& operator=(const TaskRun&) = delete;

  /// Before run(); outlives it.
  void add(RecordConsumer& consumer) { recorder_->add(consumer); }

  /// To the end of the task. @throws what the bring-up throws; what the records lost is told first,
  /// and conclude() has nothing more to tell
  void run();

  [[nodiscard]] const CycleRunner& runner() const { return runner_; }
  [[nodiscard]] std::uint64_t records_dropped() const { return recorder_->dropped(); }
  /// What the arm's fault was, for people.
  [[nodiscard]] std::string arm_fault_text() const;

  /// Tells what came of it, everywhere, and at last what could not be told. @return the exit status
  int conclude(RunResult result);

 private:
  void run_arm();
  /// Both, where there are two.
  [[nodiscard]] CanBus& bus() const;
  [[nodiscard]] std::vector<RecordReport> close_records();
  /// Of a run that never began.
  void tell_lost_records();
  void keep_black_box(RunResult& result) const;
  [[nodiscard]] const Robot& robot() const { return task_.cell().robot; }

  const Options& options_;
  ControlTask& task_;
  StopRequests& stop_;
  std::unique_ptr<hw::Buses> buses_;
  std::unique_ptr<CanLog> can_log_;
  std::unique_ptr<hw::RecordingBus> logged_bus_;
  std::unique_ptr<hw::MeteredBus> metered_bus_;
  std::unique_ptr<hw::DeviceArm> arm_;
  std::unique_ptr<Recorder> recorder_;
  CycleRunner runner_;
  Telemetry telemetry_;
  HoldPrinter hold_printer_;
  std::optional<TraceWriter> trace_;
};

}  // namespace tenon::executor

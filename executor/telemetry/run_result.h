#pragma once
// What a run came to, gathered once it is over.

#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "executor/identification/finding.h"
#include "executor/loop/controller.h"
#include "executor/loop/cycle_runner.h"
#include "shared/ports/can_bus.h"
#include "shared/system/record_file.h"

namespace tenon::executor {

struct RunResult {
  int exit_code = 1;  ///< 0: the plan is done, or something identified, and the arm is disabled
  EndReason reason = EndReason::kNone;
  ArmFaultKind arm_fault = ArmFaultKind::kNone;  ///< the reason, or of its not being held
  std::string message;                           ///< one line
  bool disable_confirmed = false;
  BrakeSlip slip{};                    ///< whatever ended the run
  Hold hold = Hold::kNone;             ///< of an arm whose brake slips
  std::uint32_t brakes_unwatched = 0;  ///< bit i: of joint i
  std::string task;                    ///< of a plan
  std::string start;
  std::vector<StepReport> steps;
  std::optional<Finding> finding;  ///< of an identification that has all its readings
  double duration_s = 0.0;         ///< of the cycles
  std::uint64_t blind_cycles = 0;  ///< since the tare, in which a sample that was due was not seen
  double peak_force_N = 0.0;
  double peak_torque_Nm = 0.0;
  CycleRunner::Statistics statistics;
  std::uint64_t records_dropped = 0;
  double cycle_s = 0.0;
  /// What the arm's side of the bus has counted, by name.
  std::vector<std::pair<std::string, std::uint64_t>> arm_counters;
  /// What the transport knows. Of frames that it took, an adapter may drop some later.
  CanBusStatus bus;
  std::uint64_t unpublished = 0;      ///< messages that LCM could not send
  std::vector<RecordReport> records;  ///< of every file that was written along
  bool output_lost = false;           ///< of what was printed, not all has arrived

  /// It went wrong in a way that the last cycles may explain: neither as it should, nor on request.
  [[nodiscard]] bool ended_badly() const;
  /// Of the program: the arm's work may be done, and what was asked for along with it not be whole.
  [[nodiscard]] int exit_status() const;
  /// All that was lost, in one line; empty where nothing was.
  [[nodiscard]] std::string losses() const;
};

/// Allocates; after the loop has ended. @param arm_fault_text see describe(Ending)
[[nodiscard]] RunResult gather_result(const Controller& controller, const CycleRunner& runner,
                                      std::uint64_t records_dropped,
                                      const std::string& arm_fault_text);
/// The same for an identification. @param finding where it ended with kMeasured
[[nodiscard]] RunResult gather_result(const ControlTask& task,
                                      const std::optional<Finding>& finding,
                                      const CycleRunner& runner, std::uint64_t records_dropped,
                                      const std::string& arm_fault_text);

/// result.json; README.md names its keys.
[[nodiscard]] std::string to_json(const RunResult& result, const Cell& cell);

/// "step  2: +x 0.100 m -> contact (-x) after 0.0312 m, 6.8 N, 0.84 s"
[[nodiscard]] std::string step_line(const StepReport& report);

/// "step  2 waits: +x 0.100 m; Enter runs it, Ctrl-C stops". Of a cycle in which a step waits.
[[nodiscard]] std::string waiting_line(const CycleRecord& record, const Plan& plan);

/// Of a run that is over but for a joint which its brake does not hold, and which is therefore to
/// be held under power until the user stops: what happened and what to do, once power is back, and
/// what ended it, or that it never came. Empty before that, and for any other run.
/// @param arm_fault_text what hw says about the record's arm_fault, may be empty
[[nodiscard]] std::string hold_line(const CycleRecord& record, const Cell& cell,
                                    const std::string& arm_fault_text = {});

}  // namespace tenon::executor

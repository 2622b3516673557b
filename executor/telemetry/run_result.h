#pragma once
// What a run came to, gathered once it is over.

#include <cstdint>
#include <string>
#include <vector>

#include "executor/controller.h"
#include "executor/cycle_runner.h"

namespace tenon::executor {

struct RunResult {
  int exit_code = 1;  ///< 0: the plan is done and the arm is disabled
  EndReason reason = EndReason::kNone;
  std::string message;  ///< one line
  bool disable_confirmed = false;
  std::vector<StepReport> steps;
  double duration_s = 0.0;  ///< of the cycles
  double peak_force_N = 0.0;
  double peak_torque_Nm = 0.0;
  CycleRunner::Statistics statistics;
  std::uint64_t records_dropped = 0;
  double cycle_s = 0.0;
};

/// Allocates; after the loop has ended. @param arm_fault_text see describe(Ending)
[[nodiscard]] RunResult gather_result(const Controller& controller, const CycleRunner& runner,
                                      std::uint64_t records_dropped,
                                      const std::string& arm_fault_text);

/// result.json; README.md names its keys.
[[nodiscard]] std::string to_json(const RunResult& result, const Plan& plan, const Cell& cell);

/// "step  2: +x 0.100 m -> contact (-x) after 0.0312 m, 6.8 N, 0.84 s"
[[nodiscard]] std::string step_line(const StepReport& report);

}  // namespace tenon::executor

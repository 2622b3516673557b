#include "executor/plan_executor.h"

#include <cassert>
#include <cmath>

namespace tenon::executor {

PlanExecutor::PlanExecutor(const Plan& plan, const Parameters& parameters)
    : plan_(with_steps(plan)),
      cycle_s_(parameters.cycle_s),
      cycle_ns_(std::llround(1e9 * parameters.cycle_s)),
      runner_(plan_),
      tool_(plan_.compliance) {
  assert(cycle_ns_ > 0);
}

PlanExecutor::Result PlanExecutor::update(const Input& input, Output& output) noexcept {
  if (time_ns_ == 0) tool_.rest_at(input.tool);
  time_ns_ += cycle_ns_;
  const std::size_t finished_before = runner_.report_count();
  const GuardedMove::Output move = runner_.update({.time_ns = time_ns_,
                                                   .pose = tool_.seen(input.tool),
                                                   .wrench = input.wrench,
                                                   .wrench_fresh = input.wrench_fresh});
  const Admittance::State& commanded = tool_.update(move.setpoint, input.wrench, cycle_s_);
  output.tool = commanded.pose;
  output.velocity = commanded.velocity;
  output.setpoint = move.setpoint;
  output.step = runner_.step();
  const bool ended = runner_.report_count() > finished_before;
  output.finished = ended ? &runner_.report(finished_before) : nullptr;
  return runner_.status();
}

}  // namespace tenon::executor

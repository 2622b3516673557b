#include "executor/motion/plan_runner.h"

#include <cassert>

#include "shared/base/error.h"

namespace tenon::executor {

const Plan& with_steps(const Plan& plan) {
  if (plan.steps.empty()) throw InputError("plan '" + plan.task_name + "' has no steps");
  return plan;
}

PlanRunner::PlanRunner(const Plan& plan) : plan_(plan) {
  assert(!plan.steps.empty() && plan.steps.size() <= kMaxSteps);
}

GuardedMove::Output PlanRunner::update(const GuardedMove::Input& input) {
  move_started_ = false;
  if (status_ != Status::kRunning) return output_;
  if (!first_) first_ = input.pose;
  if (begin_next_) {
    begin_next_ = false;
    step_ = next_;
    before_ = signature_;
    std::optional<Pose> held;
    if (move_) held = output_.setpoint.pose;
    move_.emplace(move_parameters(plan_, step_), before_, held);
    move_started_ = true;
    start_ns_ = input.time_ns;
  }
  output_ = move_->update(input);
  signature_ = move_->signature();
  if (move_->result()) finish(*move_->result());
  return output_;
}

void PlanRunner::finish(const GuardedMove::Result& result) {
  signature_ = result.signature;
  StepReport& report = reports_[report_count_++];
  report.step = step_;
  report.commanded = plan_.steps[step_].displacement;
  report.signature_before = before_;
  report.result = result;
  report.transition = transition(plan_, step_, *first_, result);
  report.start_ns = start_ns_;

  const Successor successor = report.transition.successor;
  if (successor == kSuccessorDone) {
    status_ = Status::kDone;
  } else if (successor == kSuccessorFail) {
    status_ = Status::kFailed;
  } else {
    assert(successor > step_ && successor < plan_.steps.size());
    next_ = successor;
    begin_next_ = true;
  }
}

}  // namespace tenon::executor

#pragma once
// The user's word for every step, from standard input: an Enter lets the step that waits begin.

#include <atomic>
#include <memory>

#include "executor/loop/controller.h"

namespace tenon::executor {

class StepByStep {
 public:
  /// Listens until it ends. Where standard input ends, nobody can be asked any more: the run is
  /// stopped. @param controller, stop outlive this
  StepByStep(Controller& controller, std::atomic<bool>& stop);
  StepByStep(const StepByStep&) = delete;
  StepByStep& operator=(const StepByStep&) = delete;
  ~StepByStep();

 private:
  class Listener;
  std::unique_ptr<Listener> listener_;
};

}  // namespace tenon::executor

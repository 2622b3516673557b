#pragma once
// The step of the plan that runs, as an executor's telemetry tells it: for a virtual arm in a
// process of its own, whose faults wait for one. It only listens. Not for real time; one thread.

#include <functional>
#include <memory>
#include <string>

namespace lcm {
class LCM;
}

namespace tenon::sim {

class StepListener {
 public:
  /// @param url as of telemetry, or file:// of a log
  /// @param took called by listen() with the step of every cycle in which one runs
  /// @throws InputError where LCM cannot listen there
  StepListener(const std::string& url, std::function<void(int)> took);
  StepListener(const StepListener&) = delete;
  StepListener& operator=(const StepListener&) = delete;
  ~StepListener();

  /// Takes what has come. Returns at once.
  void listen();

 private:
  std::function<void(int)> took_;
  std::unique_ptr<lcm::LCM> lcm_;
};

}  // namespace tenon::sim

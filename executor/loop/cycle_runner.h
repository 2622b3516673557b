#pragma once
// The loop around a task of the control cycle: opens a cycle on the arm (SYNC), takes feedback
// until it is complete or late, lets the task decide, and sends the setpoints. run() does so on the
// clock, begin() and finish() without one, for virtual time. Real-time after construction, one
// thread; refers to arm, task and sink, which must outlive it.

#include <cstdint>

#include "executor/faults/fault_bounds.h"
#include "executor/loop/control_task.h"
#include "executor/loop/leaky_bucket.h"
#include "executor/loop/stop_requests.h"
#include "executor/record/black_box.h"
#include "executor/record/cycle_sink.h"
#include "executor/record/histogram.h"
#include "shared/ports/arm.h"
#include "shared/ports/clock.h"

namespace tenon::executor {

class CycleRunner {
 public:
  struct Parameters {
    double feedback_deadline = 0.7;  ///< share of the cycle after which the task goes ahead
    double black_box_s = 1.0;
    LeakyBucket::Parameters late;
    /// Each cycle without its feedback costs some of the plan's accuracy, which no envelope sees:
    /// one in a hundred can go on for ever.
    LeakyBucket::Parameters incomplete{kIncompleteCyclesMost, 0.01};
  };

  struct Statistics {
    std::uint64_t cycles = 0;
    std::uint64_t late_cycles = 0;        ///< periods that had to be skipped
    std::uint64_t incomplete_cycles = 0;  ///< feedback still missing at the deadline
    Histogram wakeup;                     ///< from the due time to being awake
    Histogram compute;                    ///< from the last feedback to the last setpoint
  };

  /// @param sink may be null
  CycleRunner(Arm& arm, ControlTask& task, CycleSink* sink, const Parameters& parameters);
  CycleRunner(const CycleRunner&) = delete;
  CycleRunner& operator=(const CycleRunner&) = delete;

  /// Without a clock: begin(), then let the other end of the bus answer, then finish().
  void begin(std::int64_t now_ns) noexcept;
  /// False once the run is over.
  bool finish(std::int64_t now_ns) noexcept;
  /// Both, for an arm that answers by itself.
  bool step(std::int64_t now_ns) noexcept {
    begin(now_ns);
    return finish(now_ns);
  }

  /// Runs to the end on the system's clock. @param stop set by anyone to end the run in good order
  void run(StopRequests& stop) noexcept;
  /// The same on another clock; the arm's wait() must go by it, too.
  void run(StopRequests& stop, Clock& clock) noexcept;

  [[nodiscard]] const Statistics& statistics() const noexcept { return statistics_; }
  [[nodiscard]] const BlackBox& black_box() const noexcept { return black_box_; }

 private:
  void pass_on(StopRequests& stop) noexcept;
  void count_answers(bool complete) noexcept;
  void decide(std::int64_t now_ns) noexcept;
  void wait_until(std::int64_t due_ns, Clock& clock) noexcept;
  void publish(std::int64_t wakeup_late_ns, std::int64_t compute_ns) noexcept;
  [[nodiscard]] std::int64_t next_due(std::int64_t due_ns, std::int64_t now_ns) noexcept;

  Arm& arm_;
  ControlTask& task_;
  CycleSink* sink_;
  Parameters parameters_;
  std::int64_t cycle_ns_;
  ArmFeedback feedback_;
  LeakyBucket late_;
  LeakyBucket incomplete_;
  BlackBox black_box_;
  Statistics statistics_;
};

}  // namespace tenon::executor

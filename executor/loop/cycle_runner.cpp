#include "executor/loop/cycle_runner.h"

#include <algorithm>
#include <cmath>

#include "shared/system/monotonic_clock.h"

namespace tenon::executor {
namespace {

// Periods from one SYNC to the next beyond which the drives have stopped for want of a setpoint.
constexpr double kLateSync = 1.25;

// Before a cycle is due: more than it takes to be woken by the bus and fall asleep again.
constexpr std::int64_t kExactWait_ns = 200'000;

std::size_t cycles_in(double duration_s, double cycle_s) {
  return static_cast<std::size_t>(std::max(1.0, std::ceil(duration_s / cycle_s)));
}

}  // namespace

CycleRunner::CycleRunner(Arm& arm, ControlTask& task, CycleSink* sink, const Parameters& parameters)
    : arm_(arm),
      task_(task),
      sink_(sink),
      parameters_(parameters),
      cycle_ns_(std::int64_t{1000} * task.cell().robot.cycle_us),
      late_(parameters.late),
      incomplete_(parameters.incomplete),
      black_box_(cycles_in(parameters.black_box_s, task.cycle_s())) {}

void CycleRunner::begin(std::int64_t now_ns) noexcept {
  feedback_.joints_fresh = 0;
  feedback_.wrench_fresh = false;
  arm_.start_cycle(now_ns);
}

bool CycleRunner::finish(std::int64_t now_ns) noexcept {
  count_answers(arm_.receive(now_ns, feedback_));
  decide(now_ns);
  publish(0, 0);
  return !task_.finished();
}

void CycleRunner::count_answers(bool complete) noexcept {
  if (complete) return incomplete_.good();
  ++statistics_.incomplete_cycles;
  incomplete_.bad(1);
  task_.distrust_samples();
  if (incomplete_.full()) task_.report_poor_feedback(statistics_.incomplete_cycles);
}

void CycleRunner::decide(std::int64_t now_ns) noexcept {
  feedback_.state = arm_.state();
  feedback_.fault = arm_.fault();
  const ControlTask::Command command = task_.cycle(now_ns, feedback_);
  arm_.limit_force(task_.force_limit());
  arm_.rely_on_sensor(task_.relies_on_sensor());
  arm_.command(now_ns, command.request, command.position);
  ++statistics_.cycles;
}

void CycleRunner::publish(std::int64_t wakeup_late_ns, std::int64_t compute_ns) noexcept {
  CycleRecord record = task_.record();
  record.wakeup_late_ns = wakeup_late_ns;
  record.compute_ns = compute_ns;
  record.late_cycles = static_cast<std::uint32_t>(statistics_.late_cycles);
  black_box_.record(record);
  if (sink_ != nullptr) sink_->record(record);
}

void CycleRunner::run(StopRequests& stop) noexcept {
  MonotonicClock clock;
  run(stop, clock);
}

void CycleRunner::run(StopRequests& stop, Clock& clock) noexcept {
  const auto deadline_ns =
      static_cast<std::int64_t>(parameters_.feedback_deadline * static_cast<double>(cycle_ns_));
  const auto late_sync_ns = static_cast<std::int64_t>(kLateSync * static_cast<double>(cycle_ns_));
  std::int64_t due_ns = clock.now_ns() + cycle_ns_;
  std::int64_t last_awake_ns = due_ns;
  while (!task_.finished()) {
    wait_until(due_ns, clock);
    const std::int64_t awake_ns = clock.now_ns();
    pass_on(stop);
    if (awake_ns - last_awake_ns > late_sync_ns) task_.distrust_samples();
    last_awake_ns = awake_ns;

    begin(awake_ns);
    std::int64_t now_ns = awake_ns;
    bool complete = arm_.receive(now_ns, feedback_);
    while (!complete && now_ns < awake_ns + deadline_ns) {
      arm_.wait(awake_ns + deadline_ns - now_ns);
      now_ns = clock.now_ns();
      complete = arm_.receive(now_ns, feedback_);
    }
    count_answers(complete);

    decide(now_ns);
    const std::int64_t done_ns = clock.now_ns();
    statistics_.wakeup.add(awake_ns - due_ns);
    statistics_.compute.add(done_ns - now_ns);
    publish(awake_ns - due_ns, done_ns - now_ns);
    // After the last cycle none is late: every record and the result tell of the same ones.
    if (!task_.finished()) due_ns = next_due(due_ns, clock.now_ns());
  }
}

void CycleRunner::pass_on(StopRequests& stop) noexcept {
  if (stop.by_user.exchange(false, std::memory_order_relaxed)) task_.request_stop();
  if (stop.by_circumstance.exchange(false, std::memory_order_relaxed)) task_.request_end();
}

// On the bus, for what may come; the end on the clock, which is the more exact.
void CycleRunner::wait_until(std::int64_t due_ns, Clock& clock) noexcept {
  const std::int64_t listened_ns = due_ns - kExactWait_ns;
  std::int64_t now_ns = clock.now_ns();
  while (now_ns < listened_ns) {
    arm_.wait(listened_ns - now_ns);
    now_ns = clock.now_ns();
    // A bus that is gone ends every wait at once.
    if (!arm_.attend(now_ns)) break;
  }
  clock.wait_until_ns(due_ns);
}

// A late cycle is counted and skips whole periods, so that the phase stays.
std::int64_t CycleRunner::next_due(std::int64_t due_ns, std::int64_t now_ns) noexcept {
  due_ns += cycle_ns_;
  if (now_ns < due_ns) {
    late_.good();
    return due_ns;
  }
  const std::int64_t skipped = (now_ns - due_ns) / cycle_ns_ + 1;
  statistics_.late_cycles += static_cast<std::uint64_t>(skipped);
  late_.bad(skipped);
  if (late_.full()) task_.report_overruns(statistics_.late_cycles);
  return due_ns + skipped * cycle_ns_;
}

}  // namespace tenon::executor

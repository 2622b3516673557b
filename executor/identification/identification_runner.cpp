#include "executor/identification/identification_runner.h"

#include "executor/monotonic_clock.h"

namespace tenon::executor {
namespace {

// Of the cycle; after it the motion goes ahead with the feedback that is there.
constexpr std::int64_t kDeadline_percent = 70;

}  // namespace

IdentificationRunner::IdentificationRunner(Arm& arm, IdentificationMotion& motion)
    : arm_(arm), motion_(motion), cycle_ns_(std::int64_t{1000} * motion.cell().robot.cycle_us) {}

void IdentificationRunner::begin(std::int64_t now_ns) noexcept {
  feedback_.joints_fresh = 0;
  feedback_.wrench_fresh = false;
  arm_.start_cycle(now_ns);
}

bool IdentificationRunner::finish(std::int64_t now_ns) noexcept {
  static_cast<void>(arm_.receive(now_ns, feedback_));
  decide(now_ns);
  return !motion_.finished();
}

void IdentificationRunner::decide(std::int64_t now_ns) noexcept {
  feedback_.state = arm_.state();
  feedback_.fault = arm_.fault();
  const IdentificationMotion::Command command = motion_.cycle(feedback_);
  arm_.command(now_ns, command.request, command.position);
}

void IdentificationRunner::run(const std::atomic<bool>& stop) noexcept {
  std::int64_t due_ns = MonotonicClock::now_ns() + cycle_ns_;
  while (!motion_.finished()) {
    MonotonicClock::wait_until(due_ns);
    if (stop.load(std::memory_order_relaxed)) motion_.request_stop();
    std::int64_t now_ns = MonotonicClock::now_ns();
    const std::int64_t deadline_ns = now_ns + cycle_ns_ * kDeadline_percent / 100;
    begin(now_ns);
    while (!arm_.receive(now_ns, feedback_) && now_ns < deadline_ns) {
      arm_.wait(deadline_ns - now_ns);
      now_ns = MonotonicClock::now_ns();
    }
    decide(now_ns);
    due_ns += cycle_ns_;
    if (now_ns >= due_ns) due_ns += cycle_ns_ * ((now_ns - due_ns) / cycle_ns_ + 1);
  }
}

}  // namespace tenon::executor

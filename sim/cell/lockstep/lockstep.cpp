#include "sim/cell/lockstep/lockstep.h"

#include <algorithm>

namespace tenon::sim {
namespace {

// The cell's timers, and how often a master asks while it brings devices up.
constexpr std::int64_t kTick_ns = 1'000'000;

}  // namespace

Lockstep::Lockstep(Arm& arm, VirtualCell& cell, Link& link, const Parameters& parameters)
    : arm_(arm), cell_(cell), link_(link), parameters_(parameters) {
  cell_.step(now_ns_, link_.devices());
}

bool Lockstep::prepare() {
  const std::int64_t until_ns = now_ns_ + parameters_.prepare_max_ns;
  while (now_ns_ < until_ns) {
    if (arm_.prepare(now_ns_)) {
      next_sync_ns_ = now_ns_ + parameters_.cycle_ns;
      return true;
    }
    if (arm_.state() == ArmState::kFault) return false;
    const std::int64_t ask_ns = std::min(now_ns_ + kTick_ns, until_ns);
    await_master(ask_ns);
  }
  return false;
}

/// To the next arrival or tick. The cell takes in what has come, and answers.
void Lockstep::step(std::int64_t until_ns) {
  now_ns_ = link_.advance(std::min(until_ns, next_tick_ns_));
  if (!link_.at_devices() && now_ns_ < next_tick_ns_) return;
  cell_.step(now_ns_, link_.devices());
  next_tick_ns_ = std::max(next_tick_ns_, now_ns_ + kTick_ns);
}

void Lockstep::run_until(std::int64_t until_ns) {
  while (now_ns_ < until_ns) step(until_ns);
}

void Lockstep::await_master(std::int64_t until_ns) {
  do {
    step(until_ns);
  } while (now_ns_ < until_ns && !link_.at_master());
}

void Lockstep::run_to_sync() {
  run_until(next_sync_ns_);
  if (statistics_.cycles > 0 && link_.from_master()) ++statistics_.missed_cycles;
  next_sync_ns_ += parameters_.cycle_ns;
  ++statistics_.cycles;
}

void Lockstep::await_feedback() {
  const std::int64_t sync_ns = now_ns_;
  const auto deadline_ns =
      sync_ns + static_cast<std::int64_t>(parameters_.feedback_deadline *
                                          static_cast<double>(parameters_.cycle_ns));
  ArmFeedback feedback;
  while (!arm_.receive(now_ns_, feedback)) {
    if (now_ns_ >= deadline_ns) {
      ++statistics_.incomplete_cycles;
      return;
    }
    await_master(deadline_ns);
  }
  statistics_.latest_feedback_ns = std::max(statistics_.latest_feedback_ns, now_ns_ - sync_ns);
}

}  // namespace tenon::sim

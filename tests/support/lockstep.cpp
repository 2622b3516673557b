#include "tests/support/lockstep.h"

#include <cmath>
#include <numbers>
#include <random>

#include "hw/describe_fault.h"

namespace tenon::tests {
namespace {

constexpr std::int64_t kMillisecond_ns = 1'000'000;
constexpr std::int64_t kPrepareMax_ns = 20'000'000'000;
constexpr std::int64_t kRunMax_cycles = 500'000;

sim::VirtualCell::Options world_of(const Lockstep::Options& options) {
  sim::VirtualCell::Options world;
  world.start = options.start;
  world.seed = options.seed;
  world.offset = options.offset;
  return world;
}

}  // namespace

Lockstep::Lockstep(const Cell& cell, const Task& task, const Plan& plan, const Options& options,
                   executor::CycleSink* sink)
    : cell_description_(cell),
      plan_(plan),
      master_(bus_.attach()),
      devices_(bus_.attach()),
      arm_(std::make_unique<hw::CanopenArm>(cell.robot, master_)),
      controller_(std::make_unique<executor::Controller>(cell, plan, options.controller)),
      runner_(std::make_unique<executor::CycleRunner>(*arm_, *controller_, sink,
                                                      executor::CycleRunner::Parameters{})),
      virtual_cell_(std::make_unique<sim::VirtualCell>(cell, task, world_of(options))) {}

void Lockstep::let_cell_answer(std::int64_t now_ns) {
  bus_.set_time(now_ns);
  virtual_cell_->step(now_ns, devices_);
}

bool Lockstep::prepare() {
  for (const std::int64_t until_ns = now_ns_ + kPrepareMax_ns; now_ns_ < until_ns;
       now_ns_ += kMillisecond_ns) {
    let_cell_answer(now_ns_);
    if (arm_->prepare(now_ns_)) return true;
    if (arm_->state() == ArmState::kFault) return false;
  }
  return false;
}

bool Lockstep::cycle() {
  now_ns_ += std::int64_t{1000} * cell_description_.robot.cycle_us;
  bus_.set_time(now_ns_);
  runner_->begin(now_ns_);   // SYNC
  let_cell_answer(now_ns_);  // feedback
  ++cycles_;
  return runner_->finish(now_ns_);  // decision and setpoints
}

Lockstep::Result Lockstep::run() {
  if (prepare()) {
    while (cycle() && cycles_ < kRunMax_cycles) {
    }
  }
  return result();
}

Lockstep::Result Lockstep::result() const {
  Result result;
  result.ending = controller_->ending();
  result.truth = virtual_cell_->truth();
  result.steps = controller_->runner().report_count();
  result.cycles = cycles_;
  const std::string fault = hw::describe(arm_->fault(), cell_description_.robot);
  result.reason = executor::describe(result.ending, plan_, cell_description_, fault);
  return result;
}

void Lockstep::leave_alone(double duration_s) {
  const auto until_ns = now_ns_ + static_cast<std::int64_t>(1e9 * duration_s);
  for (; now_ns_ < until_ns; now_ns_ += kMillisecond_ns) let_cell_answer(now_ns_);
}

Vector6 draw_offset(const Task& task, const Start& start, std::uint64_t seed, double& distance) {
  // Box-Muller on raw bits: the same draws on every platform.
  std::mt19937_64 random(seed);
  const auto uniform = [&] { return (static_cast<double>(random() >> 11) + 0.5) * 0x1.0p-53; };
  Vector6 offset = Vector6::Zero();
  double squares = 0.0;
  for (int axis = 0; axis < 6; ++axis) {
    if ((task.coordinates >> axis & 1U) == 0) continue;
    const double normal =
        std::sqrt(-2.0 * std::log(uniform())) * std::cos(2.0 * std::numbers::pi * uniform());
    offset[axis] = normal * start.sigma[axis];
    squares += normal * normal;
  }
  distance = std::sqrt(squares);
  return offset;
}

}  // namespace tenon::tests

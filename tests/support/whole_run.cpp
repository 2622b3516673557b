#include "tests/support/whole_run.h"

#include <cmath>
#include <numbers>
#include <random>
#include <utility>

#include "hw/arm/describe_fault.h"

namespace tenon::tests {
namespace {

constexpr std::int64_t kRunMax_cycles = 500'000;

/// An arm whose setpoints somebody tampers with.
class TamperedArm final : public Arm {
 public:
  TamperedArm(Arm& arm, std::function<void(JointVector&)> tamper)
      : arm_(arm), tamper_(std::move(tamper)) {}

  [[nodiscard]] std::size_t joint_count() const noexcept override { return arm_.joint_count(); }
  [[nodiscard]] bool prepare(std::int64_t now_ns) override { return arm_.prepare(now_ns); }
  void start_cycle(std::int64_t now_ns) noexcept override { arm_.start_cycle(now_ns); }
  [[nodiscard]] bool receive(std::int64_t now_ns, ArmFeedback& feedback) noexcept override {
    return arm_.receive(now_ns, feedback);
  }
  void command(std::int64_t now_ns, ArmRequest request,
               const JointVector& position) noexcept override {
    JointVector tampered = position;
    tamper_(tampered);
    arm_.command(now_ns, request, tampered);
  }
  void limit_force(const ForceLimit& limit) noexcept override { arm_.limit_force(limit); }
  void rely_on_sensor(bool relied) noexcept override { arm_.rely_on_sensor(relied); }
  bool attend(std::int64_t now_ns) noexcept override { return arm_.attend(now_ns); }
  void wait(std::int64_t at_most_ns) noexcept override { arm_.wait(at_most_ns); }
  [[nodiscard]] ArmState state() const noexcept override { return arm_.state(); }
  [[nodiscard]] ArmFault fault() const noexcept override { return arm_.fault(); }

 private:
  Arm& arm_;
  std::function<void(JointVector&)> tamper_;
};

sim::VirtualCell::Options world_of(const WholeRun::Options& options) {
  sim::VirtualCell::Options world;
  world.start = options.start;
  world.seed = options.seed;
  world.offset = options.offset;
  world.faults = options.faults;
  world.world = options.world;
  world.joints = options.joints;
  world.twins = options.twins;
  world.effort_noise_permille = options.effort_noise_permille.value_or(world.effort_noise_permille);
  return world;
}

}  // namespace

WholeRun::WholeRun(const Cell& cell, const Task& task, const Plan& plan, const Options& options,
                   executor::CycleSink* sink)
    : cell_description_(cell), plan_(plan) {
  const Robot& robot = cell.robot;
  if (options.link == nullptr) {
    link_ = std::make_unique<sim::VirtualLink>(
        sim::VirtualBus::Parameters{.bitrate_bps = robot.bitrate_bps,
                                    .bit_error_rate = options.bit_error_rate,
                                    .seed = options.seed},
        robot.master_node, robot.sensor.own_bitrate_bps);
    bus_faults_ = std::make_unique<sim::BusFaults>(options.faults, robot.master_node, 0, &phases_);
    if (!options.faults.empty()) bus().set_disturbance(bus_faults_.get());
  }
  sim::Link* link = options.link != nullptr ? options.link : link_.get();
  const executor::CycleRunner::Parameters loop;
  master_ = std::make_unique<sim::LockstepBus>(link->master());
  arm_ = hw::open_arm(cell, *master_);
  controller_ = std::make_unique<executor::Controller>(
      cell, options.dry_run ? *options.dry_run : executor::dry_run(plan, cell), options.controller);
  if (options.tamper) port_ = std::make_unique<TamperedArm>(*arm_, options.tamper);
  Arm& port = port_ ? *port_ : static_cast<Arm&>(*arm_);
  runner_ = std::make_unique<executor::CycleRunner>(port, *controller_, sink, loop);
  sim::VirtualCell::Options world = world_of(options);
  world.phases = &phases_;
  virtual_cell_ = std::make_unique<sim::VirtualCell>(cell, task, world);
  time_ = std::make_unique<sim::Lockstep>(
      *arm_, *virtual_cell_, *link,
      sim::Lockstep::Parameters{.cycle_ns = std::int64_t{1000} * robot.cycle_us,
                                .feedback_deadline = loop.feedback_deadline});
}

WholeRun::Result WholeRun::run_on_clock(sim::VirtualClock::Lateness late) {
  master_->wait_by(*time_);
  executor::StopRequests stop;
  const std::int64_t end_ns =
      now_ns() + kRunMax_cycles * std::int64_t{1000} * cell_description_.robot.cycle_us;
  sim::VirtualClock clock(*time_, [&](std::int64_t due_ns) {
    if (due_ns > end_ns) stop.by_user = true;
    note_step();
    return late(due_ns);
  });
  if (prepare()) runner_->run(stop, clock);
  return result();
}

bool WholeRun::prepare() { return time_->prepare(); }

bool WholeRun::cycle() {
  const bool more = time_->cycle(*runner_);
  note_step();
  return more;
}

void WholeRun::note_step() {
  const std::int32_t step = controller_->record().step;
  if (step >= 0) phases_.begin_step(step, now_ns());
}

WholeRun::Result WholeRun::run() {
  if (prepare()) {
    while (cycle() && statistics().cycles < kRunMax_cycles) {
    }
  }
  return result();
}

WholeRun::Result WholeRun::result() const {
  Result result;
  result.ending = controller_->ending();
  result.truth = virtual_cell_->truth();
  result.steps = controller_->runner().report_count();
  result.cycles = statistics().cycles;
  const std::string fault = hw::fault_text(arm_->fault(), cell_description_.robot);
  result.reason = executor::describe(result.ending, plan_, cell_description_, fault);
  return result;
}

void WholeRun::leave_alone(double duration_s) {
  time_->leave_alone(static_cast<std::int64_t>(1e9 * duration_s));
}

Vector6 draw_offset(const Task& task, const Start& start, std::uint64_t seed, double& distance) {
  // Box-Muller on raw bits: the same draws on every platform.
  std::mt19937_64 random(seed);
  const auto uniform = [&] { return (static_cast<double>(random() >> 11) + 0.5) * 0x1.0p-53; };
  Vector6 offset = Vector6::Zero();
  double squares = 0.0;
  for (int axis = 0; axis < 6; ++axis) {
    if (!has(task.coordinates, axis)) continue;
    const double normal =
        std::sqrt(-2.0 * std::log(uniform())) * std::cos(2.0 * std::numbers::pi * uniform());
    offset[axis] = normal * start.sigma[axis];
    squares += normal * normal;
  }
  distance = std::sqrt(squares);
  return offset;
}

}  // namespace tenon::tests

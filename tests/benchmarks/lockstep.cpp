// The whole chain in lockstep on one core, physics and executor included: how much faster than real
// time it is, and where the time goes. real_time_ratio is simulated time over the thread's own time
// on a core, from the first control cycle to the brakes at the end. The shares are of the time
// spent: physics (ODE and servos), devices (drives, sensor, their CANopen slaves, and the lockstep
// itself), bus (frames in virtual time), executor (controller and CANopen master). Reading the
// clock is in them, some 25 ns each.

#include "sim/cell/lockstep/lockstep.h"

#include <benchmark/benchmark.h>

#include <array>
#include <cstdint>
#include <ctime>
#include <string>
#include <utility>

#include "executor/loop/controller.h"
#include "executor/loop/cycle_runner.h"
#include "hw/arm/canopen_arm.h"
#include "hw/arm/describe_fault.h"
#include "shared/system/monotonic_clock.h"
#include "sim/cell/lockstep/virtual_link.h"
#include "sim/cell/virtual_arm/virtual_cell.h"
#include "tests/support/planned.h"

namespace {

using namespace tenon;

constexpr std::int64_t kCyclesMax = 200'000;
constexpr const char* kStart = "1";

/// Of this thread on a core, whoever else runs beside it.
std::int64_t core_ns() {
  timespec time{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &time);
  return std::int64_t{1'000'000'000} * time.tv_sec + time.tv_nsec;
}

enum Part : std::size_t { kCell, kBus, kExecutor, kParts };

/// Whose time it is: each part's own, without that of the parts that it calls.
class Shares {
 public:
  template <typename Work>
  auto of(Part part, const Work& work) {
    struct Turn {
      Shares& shares;
      Part before;
      ~Turn() { shares.turn_to(before); }
    } const turn{*this, turn_to(part)};
    return work();
  }
  Part turn_to(Part part) {
    const std::int64_t now_ns = monotonic_now_ns();
    spent_ns_[current_] += now_ns - since_ns_;
    since_ns_ = now_ns;
    return std::exchange(current_, part);
  }
  [[nodiscard]] std::int64_t spent_ns(Part part) const { return spent_ns_[part]; }

 private:
  std::array<std::int64_t, kParts> spent_ns_{};
  Part current_ = kCell;
  std::int64_t since_ns_ = monotonic_now_ns();
};

class TimedBus final : public CanBus {
 public:
  TimedBus(CanBus& bus, Shares& shares) : bus_(bus), shares_(shares) {}
  SendResult send(const CanFrame& frame) noexcept override {
    return shares_.of(kBus, [&] { return bus_.send(frame); });
  }
  bool receive(ReceivedFrame& received) noexcept override {
    return shares_.of(kBus, [&] { return bus_.receive(received); });
  }
  void flush() noexcept override { bus_.flush(); }
  void wait(std::int64_t at_most_ns) noexcept override { bus_.wait(at_most_ns); }
  [[nodiscard]] CanBusStatus status() const noexcept override { return bus_.status(); }

 private:
  CanBus& bus_;
  Shares& shares_;
};

class TimedLink final : public sim::Link {
 public:
  TimedLink(sim::Link& link, Shares& shares)
      : link_(link),
        master_(link.master(), shares),
        devices_(link.devices(), shares),
        shares_(shares) {}
  [[nodiscard]] CanBus& master() override { return master_; }
  [[nodiscard]] CanBus& devices() override { return devices_; }
  [[nodiscard]] std::int64_t advance(std::int64_t until_ns) override {
    return shares_.of(kBus, [&] { return link_.advance(until_ns); });
  }
  [[nodiscard]] bool at_master() const override { return link_.at_master(); }
  [[nodiscard]] bool at_devices() const override { return link_.at_devices(); }
  [[nodiscard]] bool from_master() const override { return link_.from_master(); }

 private:
  sim::Link& link_;
  TimedBus master_;
  TimedBus devices_;
  Shares& shares_;
};

/// What the lockstep itself asks of the master, between the executor's begin() and finish().
class TimedArm final : public Arm {
 public:
  TimedArm(Arm& arm, Shares& shares) : arm_(arm), shares_(shares) {}
  [[nodiscard]] std::size_t joint_count() const noexcept override { return arm_.joint_count(); }
  [[nodiscard]] bool prepare(std::int64_t now_ns) override { return arm_.prepare(now_ns); }
  void start_cycle(std::int64_t now_ns) noexcept override { arm_.start_cycle(now_ns); }
  [[nodiscard]] bool receive(std::int64_t now_ns, ArmFeedback& feedback) noexcept override {
    return shares_.of(kExecutor, [&] { return arm_.receive(now_ns, feedback); });
  }
  void command(std::int64_t now_ns, ArmRequest request,
               const JointVector& position) noexcept override {
    arm_.command(now_ns, request, position);
  }
  void wait(std::int64_t at_most_ns) noexcept override { arm_.wait(at_most_ns); }
  [[nodiscard]] ArmState state() const noexcept override { return arm_.state(); }
  [[nodiscard]] ArmFault fault() const noexcept override { return arm_.fault(); }

 private:
  Arm& arm_;
  Shares& shares_;
};

struct TimedLoop {
  executor::CycleRunner& runner;
  Shares& shares;
  void begin(std::int64_t now_ns) {
    shares.of(kExecutor, [&] { runner.begin(now_ns); });
  }
  bool finish(std::int64_t now_ns) {
    return shares.of(kExecutor, [&] { return runner.finish(now_ns); });
  }
};

struct Spent {
  std::int64_t simulated_ns = 0;
  std::int64_t core_ns = 0;
  std::int64_t physics_ns = 0;
  std::int64_t devices_ns = 0;
  std::int64_t bus_ns = 0;
  std::int64_t executor_ns = 0;
  [[nodiscard]] std::int64_t total_ns() const {
    return physics_ns + devices_ns + bus_ns + executor_ns;
  }
};

/// Why the plan did not come to its end; empty: it did.
std::string run_once(const Cell& cell, const Plan& plan, Spent& spent) {
  Shares shares;
  sim::VirtualLink virtual_link({.bitrate_bps = cell.robot.bitrate_bps}, cell.robot.master_node);
  TimedLink link(virtual_link, shares);
  hw::CanopenArm master(cell.robot, link.master());
  TimedArm arm(master, shares);
  executor::Controller controller(cell, plan, {});
  executor::CycleRunner runner(master, controller, nullptr, {});
  sim::VirtualCell::Options options;
  options.start = kStart;
  options.offset.head<2>() << 0.01, -0.01;
  options.stopwatch_ns = monotonic_now_ns;
  sim::VirtualCell virtual_cell(cell, tests::box_task(), options);
  sim::Lockstep time(arm, virtual_cell, link,
                     {.cycle_ns = std::int64_t{1000} * cell.robot.cycle_us});
  if (!time.prepare()) return hw::describe(master.fault(), cell.robot);

  shares = Shares{};
  const std::int64_t physics_before_ns = virtual_cell.physics_cost_ns();
  const std::int64_t simulated_before_ns = time.now_ns();
  const std::int64_t core_before_ns = core_ns();
  TimedLoop loop{runner, shares};
  for (std::int64_t i = 0; i < kCyclesMax && time.cycle(loop); ++i) {
  }
  shares.turn_to(kCell);
  spent.core_ns += core_ns() - core_before_ns;
  const std::int64_t physics_ns = virtual_cell.physics_cost_ns() - physics_before_ns;
  spent.simulated_ns += time.now_ns() - simulated_before_ns;
  spent.physics_ns += physics_ns;
  spent.devices_ns += shares.spent_ns(kCell) - physics_ns;
  spent.bus_ns += shares.spent_ns(kBus);
  spent.executor_ns += shares.spent_ns(kExecutor);
  if (virtual_cell.truth().solver_messages > 0) return "the physics solver gave up";
  if (controller.ending().reason == executor::EndReason::kPlanDone) return {};
  return executor::describe(controller.ending(), plan, cell,
                            hw::describe(master.fault(), cell.robot));
}

void lockstep(benchmark::State& state, const std::string& cell_name) {
  const Cell cell = tests::shipped_cell(cell_name);
  const Plan plan = tests::planned_box(cell, kStart).plan;
  Spent spent;
  for (auto _ : state) {
    const std::string failure = run_once(cell, plan, spent);
    if (!failure.empty()) state.SkipWithError(failure.c_str());
  }
  const auto share = [&](std::int64_t part_ns) {
    return static_cast<double>(part_ns) / static_cast<double>(spent.total_ns());
  };
  state.counters["real_time_ratio"] =
      static_cast<double>(spent.simulated_ns) / static_cast<double>(spent.core_ns);
  state.counters["physics"] = share(spent.physics_ns);
  state.counters["devices"] = share(spent.devices_ns);
  state.counters["bus"] = share(spent.bus_ns);
  state.counters["executor"] = share(spent.executor_ns);
}

BENCHMARK_CAPTURE(lockstep, gantry3, "gantry3")->Iterations(3)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(lockstep, csp6, "csp6")->Iterations(3)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(lockstep, lwa4p, "lwa4p")->Iterations(3)->Unit(benchmark::kMillisecond);

}  // namespace

// From the end of the bring-up to the end of the run, neither executor nor CANopen master nor
// virtual bus allocates, together on one bus, through a plan's end and through faults. The virtual
// cell is not counted: physics allocates.

#include <gtest/gtest.h>

#include <cstdint>
#include <cstdio>
#include <functional>
#include <memory>
#include <vector>

#include "executor/loop/controller.h"
#include "executor/loop/cycle_runner.h"
#include "executor/telemetry/recorder.h"
#include "hw/arm/canopen_arm.h"
#include "sim/cell/lockstep/lockstep.h"
#include "sim/cell/lockstep/virtual_link.h"
#include "tests/support/allocation_count.h"
#include "tests/support/planned.h"

namespace tenon::tests {
namespace {

// Adds up what its blocks allocate while it is on.
class Allocations {
 public:
  template <typename Work>
  auto during(const Work& work) {
    const Block block(*this);
    return work();
  }
  void start() { on_ = true; }
  [[nodiscard]] std::uint64_t count() const { return count_; }

 private:
  class Block {
   public:
    explicit Block(Allocations& owner) : owner_(owner), before_(allocation_count()) {}
    Block(const Block&) = delete;
    Block& operator=(const Block&) = delete;
    ~Block() {
      if (owner_.on_) owner_.count_ += allocation_count() - before_;
    }

   private:
    Allocations& owner_;
    std::uint64_t before_;
  };
  bool on_ = false;
  std::uint64_t count_ = 0;
};

class CountedLink : public sim::Link {
 public:
  CountedLink(const Robot& robot, Allocations& allocations)
      : link_({.bitrate_bps = robot.bitrate_bps}, robot.master_node), allocations_(allocations) {}
  [[nodiscard]] CanBus& master() override { return link_.master(); }
  [[nodiscard]] CanBus& devices() override { return link_.devices(); }
  [[nodiscard]] std::int64_t advance(std::int64_t until_ns) override {
    return allocations_.during([&] { return link_.advance(until_ns); });
  }
  [[nodiscard]] bool at_master() const override { return link_.at_master(); }
  [[nodiscard]] bool at_devices() const override { return link_.at_devices(); }
  [[nodiscard]] bool from_master() const override { return link_.from_master(); }
  [[nodiscard]] sim::VirtualBus& bus() { return link_.bus(); }

 private:
  sim::VirtualLink link_;
  Allocations& allocations_;
};

class CountedArm : public Arm {
 public:
  CountedArm(Arm& arm, Allocations& allocations) : arm_(arm), allocations_(allocations) {}
  [[nodiscard]] std::size_t joint_count() const noexcept override { return arm_.joint_count(); }
  [[nodiscard]] bool prepare(std::int64_t now_ns) override { return arm_.prepare(now_ns); }
  void start_cycle(std::int64_t now_ns) noexcept override {
    allocations_.during([&] { arm_.start_cycle(now_ns); });
  }
  [[nodiscard]] bool receive(std::int64_t now_ns, ArmFeedback& feedback) noexcept override {
    return allocations_.during([&] { return arm_.receive(now_ns, feedback); });
  }
  void command(std::int64_t now_ns, ArmRequest request,
               const JointVector& position) noexcept override {
    allocations_.during([&] { arm_.command(now_ns, request, position); });
  }
  void wait(std::int64_t at_most_ns) noexcept override { arm_.wait(at_most_ns); }
  [[nodiscard]] ArmState state() const noexcept override { return arm_.state(); }
  [[nodiscard]] ArmFault fault() const noexcept override { return arm_.fault(); }

 private:
  Arm& arm_;
  Allocations& allocations_;
};

sim::VirtualCell::Options at_start(std::uint64_t seed) {
  sim::VirtualCell::Options options;
  options.start = "1";
  options.seed = seed;
  return options;
}

struct CountedChain {
  explicit CountedChain(std::uint64_t seed = 1) : cell(gantry_cell(), box_task(), at_start(seed)) {}

  Allocations allocations;
  CountedLink link{gantry_cell().robot, allocations};
  hw::CanopenArm canopen_arm{gantry_cell().robot, link.master()};
  CountedArm arm{canopen_arm, allocations};
  executor::Controller controller{gantry_cell(), box_plan("1"), {}};
  std::unique_ptr<executor::Recorder> recorder = std::make_unique<executor::Recorder>();
  executor::CycleRunner runner{arm, controller, recorder.get(), {}};
  sim::VirtualCell cell;
  sim::Lockstep time{arm, cell, link, {.cycle_ns = 2'000'000}};

  // What sim::Lockstep drives.
  void begin(std::int64_t now_ns) {
    allocations.during([&] { runner.begin(now_ns); });
  }
  bool finish(std::int64_t now_ns) {
    return allocations.during([&] { return runner.finish(now_ns); });
  }

  /// To the end of the run; `disturb` is called once, half a second into the plan.
  void run(const std::function<void(CountedChain&)>& disturb) {
    ASSERT_TRUE(time.prepare());
    allocations.start();
    int moving = 0;
    while (time.cycle(*this)) {
      recorder->drain();
      moving += controller.state() == executor::State::kRunning;
      if (moving == 250) disturb(*this);
    }
  }
};

TEST(ChainAllocation, TheCountSeesAnAllocation) {
  Allocations allocations;
  allocations.start();
  const auto something = allocations.during([] { return std::make_unique<int>(1); });
  EXPECT_EQ(*something, 1);
  EXPECT_EQ(allocations.count(), 1U);
}

TEST(ChainAllocation, WholePlansOfTenThousandCyclesAndMoreAllocateNothing) {
  std::uint64_t cycles = 0;
  for (std::uint64_t seed = 1; cycles <= 10'000; ++seed) {
    ASSERT_LE(seed, 10U);
    CountedChain chain(seed);
    chain.run([](CountedChain& /*chain*/) {});
    EXPECT_EQ(chain.controller.ending().reason, executor::EndReason::kPlanDone) << seed;
    EXPECT_EQ(chain.allocations.count(), 0U) << seed;
    cycles += chain.runner.statistics().cycles;
  }
  std::printf("%llu cycles of executor and CANopen master, no allocation\n",
              static_cast<unsigned long long>(cycles));
}

TEST(ChainAllocation, AStopAndFaultsAllocateNothing) {
  using executor::EndReason;
  struct Case {
    EndReason reason;
    std::function<void(CountedChain&)> disturb;
  };
  const std::vector<Case> cases = {
      {EndReason::kStopRequested, [](CountedChain& chain) { chain.controller.request_stop(); }},
      {EndReason::kOverruns, [](CountedChain& chain) { chain.controller.report_overruns(50); }},
      {EndReason::kFeedbackPoor,
       [](CountedChain& chain) { chain.controller.report_poor_feedback(50); }},
      {EndReason::kArmFault, [](CountedChain& chain) { chain.link.bus().set_up(false); }},
  };
  for (const Case& each : cases) {
    CountedChain chain;
    chain.run(each.disturb);
    EXPECT_EQ(chain.controller.ending().reason, each.reason);
    EXPECT_EQ(chain.allocations.count(), 0U) << to_string(each.reason);
  }
}

}  // namespace
}  // namespace tenon::tests

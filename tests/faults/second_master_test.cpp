// Somebody else commands a drive while a plan runs, and while its power goes: the drive acts on
// what it hears at once, and what is left is to see that its axis stops and that it stays off.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <string>
#include <vector>

#include "shared/base/bytes.h"
#include "shared/base/time_units.h"
#include "tests/support/faulty_options.h"
#include "tests/support/planned.h"
#include "tests/support/rest_watch.h"
#include "tests/support/whole_run.h"

namespace tenon::tests {
namespace {

using executor::EndReason;
using executor::State;
using sim::FaultPhase;

constexpr std::uint8_t kEnable = 0x0F;

/// A whole run and somebody else on its bus.
class Intruded {
 public:
  explicit Intruded(const std::string& cell_name)
      : cell(shipped_cell(cell_name)),
        planned(planned_box(cell, "1")),
        run(cell, planned.task, planned.plan, with_faults({})),
        other_(run.bus().attach()),
        rest(cell.robot) {
    EXPECT_TRUE(run.prepare());
  }

  /// A controlword; where targets stand in the same frame, with one.
  void command(std::uint8_t word, std::int32_t target = 0) {
    CanFrame frame;
    frame.data[0] = word;
    if (packed()) {
      frame.id = 0x300U + node();
      frame.length = 2;
    } else {
      frame.id = 0x200U + node();
      frame.length = 6;
      store_le(std::span(frame.data).subspan(2), target);
    }
    (void)other_.send(frame);
  }
  /// A target of the first joint.
  void aim(std::int32_t target) {
    if (!packed()) return command(kEnable, target);
    CanFrame frame;
    frame.id = 0x200U + node();
    frame.length = 8;
    store_le(std::span(frame.data), target);
    store_le(std::span(frame.data).subspan(4), target);
    (void)other_.send(frame);
  }
  [[nodiscard]] bool packed() const { return cell.robot.targets_per_frame == 2; }
  [[nodiscard]] std::uint8_t node() const { return cell.robot.joints.front().node; }

  Cell cell;
  Planned planned;
  WholeRun run;

 private:
  CanBus& other_;

 public:
  RestWatch rest;
};

class SecondMaster : public ::testing::TestWithParam<const char*> {};

// The drive runs for the forged target as fast as it can, and so does its ramp.
TEST_P(SecondMaster, OneForgedTargetInMotionEndsInTheBrakeAtOnce) {
  for (const std::int32_t target :
       {0, std::numeric_limits<std::int32_t>::max(), std::numeric_limits<std::int32_t>::min()}) {
    Intruded intruded(GetParam());
    WholeRun& run = intruded.run;
    while (!run.phases().began_ns(FaultPhase::kFree)) ASSERT_TRUE(run.cycle());
    for (int i = 0; i < 50; ++i) ASSERT_TRUE(run.cycle());
    const sim::Truth before = run.result().truth;
    const std::int64_t struck_ns = run.now_ns();
    intruded.aim(target);
    std::int64_t braked_ns = 0;
    bool more = true;
    while (more) {
      more = run.cycle();
      const sim::Truth now = run.result().truth;
      intruded.rest.look(now);
      if (braked_ns == 0 && now.drives.front().brake_engaged) braked_ns = run.now_ns();
    }
    const auto result = run.result();
    EXPECT_EQ(result.ending.arm_fault.kind, ArmFaultKind::kOtherMaster) << result.reason;
    EXPECT_TRUE(result.ending.disable_confirmed) << result.reason;
    EXPECT_TRUE(intruded.rest.off()) << target;
    const double braked_s = kNanosecond_s * static_cast<double>(braked_ns - struck_ns);
    EXPECT_LT(braked_s, 0.05) << target;
    const double way =
        std::abs(result.truth.drives.front().position - before.drives.front().position);
    std::printf("%s, target %d: brake after %.3f s, %.4f m or rad on, %.0f N at most\n", GetParam(),
                target, braked_s, way, result.truth.contact_force_N_max);
  }
}

// While the drives go off, and while their brakes are watched.
TEST_P(SecondMaster, ADriveThatIsSwitchedOnAgainIsSwitchedOffAndSaidSo) {
  for (const State since : {State::kDisabling, State::kWatching}) {
    Intruded intruded(GetParam());
    WholeRun& run = intruded.run;
    std::vector<std::uint8_t> words = {0x06, 0x07, kEnable};
    bool more = true;
    while (more) {
      if (run.controller().state() == since && !words.empty()) {
        intruded.command(words.front());
        words.erase(words.begin());
      }
      more = run.cycle();
      intruded.rest.look(run.result().truth);
    }
    EXPECT_TRUE(words.empty());
    const auto result = run.result();
    EXPECT_EQ(result.ending.reason, EndReason::kArmFault) << result.reason;
    EXPECT_EQ(result.ending.arm_fault.kind, ArmFaultKind::kOtherMaster) << result.reason;
    EXPECT_TRUE(result.ending.disable_confirmed);
    EXPECT_TRUE(intruded.rest.off()) << to_string(since);
  }
}

// Again and again until the end: nobody says that the arm is off while it is not.
TEST_P(SecondMaster, ADriveThatIsKeptOnIsNeverSaidToBeOff) {
  Intruded intruded(GetParam());
  WholeRun& run = intruded.run;
  const std::vector<std::uint8_t> words = {0x06, 0x07, kEnable, kEnable};
  std::size_t next = 0;
  bool more = true;
  while (more) {
    if (run.controller().state() == State::kWatching) {
      intruded.command(words[next++ % words.size()]);
    }
    more = run.cycle();
  }
  const auto result = run.result();
  EXPECT_EQ(result.ending.arm_fault.kind, ArmFaultKind::kOtherMaster) << result.reason;
  const bool off = result.truth.drives.front().brake_engaged;
  EXPECT_TRUE(off || !result.ending.disable_confirmed) << result.truth.drives.front().state;
  std::printf("%s: %s, confirmed %d\n", GetParam(), result.truth.drives.front().state.c_str(),
              result.ending.disable_confirmed);
}

INSTANTIATE_TEST_SUITE_P(Each, SecondMaster, ::testing::Values("gantry3", "csp6"));

}  // namespace
}  // namespace tenon::tests

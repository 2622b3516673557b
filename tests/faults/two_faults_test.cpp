// Two things go wrong at a time: the run is named for the first, the arm is left in its brakes, no
// record is lost, and what the second adds is said.

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <cstdio>
#include <functional>
#include <string>
#include <vector>

#include "tests/faults/mover_of.h"
#include "tests/support/faulty_options.h"
#include "tests/support/planned.h"
#include "tests/support/whole_run.h"

namespace tenon::tests {
namespace {

using executor::EndReason;
using executor::State;

class Keeper : public executor::CycleSink {
 public:
  void record(const executor::CycleRecord& record) noexcept override {
    whole = whole && record.sequence == count;
    ++count;
    last = record;
  }
  bool whole = true;
  std::uint64_t count = 0;
  executor::CycleRecord last;
};

struct Case {
  const char* name = "";
  std::vector<std::string> faults;
  EndReason reason = EndReason::kArmFault;
  const char* said = "";  ///< besides, in the message
  /// Called before every cycle.
  std::function<void(WholeRun&)> meddle = nullptr;
  bool powered = false;  ///< an unkind drive stays so
};

void pause_in_step_two(WholeRun& run) {
  if (run.controller().record().step == 2) run.controller().pause(true);
}

bool stops(State state) {
  return state == State::kStopping || state == State::kQuickStopping || state == State::kDisabling;
}

// What comes into a pause, and to a brake.
std::vector<Case> cases(const Plan& plan) {
  const std::string last_step = std::to_string(plan.steps.size() - 1);
  return {
      {"a node falls silent while the user pauses",
       {"silent-node:node=2,at=step:2,time_s=1"},
       EndReason::kArmFault,
       "node 2",
       pause_in_step_two},
      {"answers are lost while the user pauses",
       {"drop:node=1,id=answers,at=step:2,time_s=1,duration_s=100"},
       EndReason::kArmFault,
       "node 1",
       pause_in_step_two},
      {"a stop is asked for in a pause, and a drive faults as the arm ramps down",
       {"emergency:node=1,code=0x3210,at=stopping"},
       EndReason::kStopRequested,
       "",
       [](WholeRun& run) {
         pause_in_step_two(run);
         if (run.phases().step_began_ns(2) &&
             run.now_ns() > *run.phases().step_began_ns(2) + 1'000'000'000) {
           run.controller().request_stop();
         }
       }},
      {"a fault on the last step, and its brake",
       {"emergency:node=1,code=0x3210,at=step:" + last_step, "brake-failure:node=3,at=stopping"},
       EndReason::kArmFault,
       "; then joint z moved by"},
      {"a brake fails whose answers are lost",
       {"emergency:node=1,code=0x3210,at=step:2", "brake-failure:node=3,at=stopping",
        "drop:node=3,id=answers,at=stopping,duration_s=100"},
       EndReason::kArmFault,
       "whether the brake holds at node 3 (z)"},
  };
}

// What comes while the drives stop, and together.
std::vector<Case> others(const Plan& plan) {
  const std::string mover = mover_of(plan, 2);
  return {
      {"another master while the drives stop",
       {"forged-force:at=free,time_s=0.3,force_N=80,duration_s=0.01"},
       EndReason::kForceFault,
       "",
       [](WholeRun& run) {
         static CanBus* other = nullptr;
         if (run.controller().record().sequence == 1) other = &run.bus().attach();
         if (other != nullptr && stops(run.controller().state())) {
           (void)other->send({.id = 0x201, .length = 6, .data = {0x0F, 0, 1, 0, 0, 0}});
         }
       }},
      {"the bus goes while the drives stop",
       {"forged-force:at=free,time_s=0.3,force_N=80,duration_s=0.01",
        "interface-down:at=stopping,duration_s=100"},
       EndReason::kForceFault,
       "nobody could watch whether a brake holds"},
      {"a node restarts while the drives stop",
       {"emergency:node=1,code=0x3210,at=step:2", "node-reset:node=2,at=stopping"},
       EndReason::kArmFault,
       "node 1"},
      {"a frozen drive whose heartbeat is lost",
       {"frozen-drive:" + mover + ",at=step:2",
        "drop:" + mover + ",id=heartbeat,at=step:2,duration_s=100"},
       EndReason::kFollowingError,
       "node "},
      {"an encoder jumps as a force is felt",
       {"encoder-jump:node=1,at=step:2,time_s=0.2,jump_m=0.05",
        "forged-force:at=step:2,time_s=0.2,force_N=80,duration_s=0.01"},
       EndReason::kEncoderJump,
       "node 1"},
      {"the executor's bus goes while a drive keeps power",
       {"interface-down:at=step:2,duration_s=100", "keeps-power:node=3"},
       EndReason::kArmFault,
       "nobody could watch",
       nullptr,
       true},
  };
}

void expect_named_and_safe(const Case& one) {
  SCOPED_TRACE(one.name);
  WholeRun::Options options = with_faults(one.faults);
  options.start = std::string("4");
  Keeper keeper;
  WholeRun run(gantry_cell(), box_task(), box_plan("4"), options, &keeper);
  ASSERT_TRUE(run.prepare());
  for (int i = 0; i < 60'000; ++i) {
    if (one.meddle) one.meddle(run);
    if (!run.cycle()) break;
  }
  EXPECT_TRUE(run.controller().finished());
  run.leave_alone(2.0);
  const WholeRun::Result result = run.result();
  std::printf("%s: %s\n", one.name, result.reason.c_str());
  EXPECT_EQ(result.ending.reason, one.reason) << result.reason;
  EXPECT_NE(result.reason.find(one.said), std::string::npos) << result.reason;
  EXPECT_TRUE(keeper.whole) << "a cycle has no record";
  EXPECT_EQ(keeper.count, static_cast<std::uint64_t>(result.cycles));
  EXPECT_EQ(keeper.last.end_reason, static_cast<std::uint8_t>(one.reason));
  const auto in_brakes = [](const sim::DriveTruth& drive) { return drive.brake_engaged; };
  EXPECT_TRUE(one.powered ||
              std::all_of(result.truth.drives.begin(), result.truth.drives.end(), in_brakes));
}

TEST(TwoFaults, TheFirstIsTheRunsNameAndTheArmIsLeftInItsBrakesAndNothingIsLost) {
  const Plan& plan = box_plan("4");
  for (const Case& one : cases(plan)) expect_named_and_safe(one);
  for (const Case& one : others(plan)) expect_named_and_safe(one);
}

}  // namespace
}  // namespace tenon::tests

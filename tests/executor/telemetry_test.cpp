// What goes out over LCM, decoded with the generated types.

#include "executor/telemetry/telemetry.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <lcm/lcm-cpp.hpp>
#include <memory>
#include <nlohmann/json.hpp>

#include "executor/telemetry/recorder.h"
#include "executor/telemetry/run_result.h"
#include "executor/telemetry/setup_message.h"
#include "lcmtypes/tenon/cycle_state_t.hpp"
#include "lcmtypes/tenon/run_setup_t.hpp"
#include "lcmtypes/tenon/run_status_t.hpp"
#include "lcmtypes/tenon/run_summary_t.hpp"
#include "lcmtypes/tenon/step_event_t.hpp"
#include "shared/base/error.h"
#include "shared/system/lcm_url.h"
#include "tests/executor/bench.h"

namespace tenon::executor {
namespace {

// Runs touch_and_slide_plan() and publishes it to the outputs, summary included.
RunResult published_run(TelemetryOutputs outputs) {
  const auto recorder = std::make_unique<Recorder>();
  Bench bench(touch_and_slide_plan(), {}, hand_made_cell(), Vector3::Zero(), recorder.get());
  bench.arm.walls.push_back({0, +1, 0.13});
  Telemetry telemetry(std::move(outputs), hand_made_cell(), &bench.controller.runner(), *recorder);
  recorder->add(telemetry);
  bench.run([&] { recorder->drain(); });
  recorder->drain();
  const RunResult result = gather_result(bench.controller, bench.runner, 0, "");
  telemetry.publish_summary(result, bench.controller.record());
  EXPECT_EQ(telemetry.failures(), 0U);
  return result;
}

TEST(Telemetry, TheLogHoldsEveryCycleEveryStepAndTheSummary) {
  const std::filesystem::path file =
      std::filesystem::path(testing::TempDir()) / "tenon_telemetry_test.lcmlog";
  std::vector<std::string> warnings;
  const RunResult result = published_run(open_telemetry("none", file, warnings));
  EXPECT_TRUE(warnings.empty());

  lcm::LogFile log(file.string(), "r");
  ASSERT_TRUE(log.good());
  std::uint64_t cycles = 0;
  std::vector<tenon::step_event_t> steps;
  std::vector<tenon::run_summary_t> summaries;
  while (const lcm::LogEvent* event = log.readNextEvent()) {
    if (event->channel == kCycleChannel) {
      tenon::cycle_state_t m;
      ASSERT_GT(m.decode(event->data, 0, event->datalen), 0);
      EXPECT_EQ(m.sequence, static_cast<std::int64_t>(cycles));
      EXPECT_EQ(m.joint_count, 3);
      EXPECT_EQ(m.motion_ns, static_cast<std::int64_t>(cycles + 1) * kCycle_ns);
      ++cycles;
    } else if (event->channel == kStepChannel) {
      ASSERT_GT(steps.emplace_back().decode(event->data, 0, event->datalen), 0);
    } else if (event->channel == kRunChannel) {
      ASSERT_GT(summaries.emplace_back().decode(event->data, 0, event->datalen), 0);
    }
  }
  EXPECT_EQ(cycles, result.statistics.cycles);
  ASSERT_EQ(steps.size(), 2U);
  EXPECT_EQ(steps[0].outcome, 1);
  EXPECT_EQ(steps[0].signature, 2);
  EXPECT_NEAR(steps[0].travelled[0], 0.03, 5e-4);
  EXPECT_EQ(steps[1].successor, 254);
  ASSERT_EQ(summaries.size(), 1U);
  EXPECT_EQ(summaries[0].exit_code, 0);
  EXPECT_EQ(summaries[0].plan, "hand-made");
  EXPECT_EQ(summaries[0].sequence, static_cast<std::int64_t>(result.statistics.cycles));
  std::filesystem::remove(file);
}

// The plan's numbers stand in hand_made.cpp: +x 0.1 m that ends in a contact, then +y.
TEST(Telemetry, ALogBeginsWithWhatTheRunIsMeasuredByAndTellsItEachSecond) {
  const std::filesystem::path file =
      std::filesystem::path(testing::TempDir()) / "tenon_telemetry_setup_test.lcmlog";
  std::vector<std::string> warnings;
  const RunResult result = published_run(open_telemetry("none", file, warnings));
  lcm::LogFile log(file.string(), "r");
  ASSERT_TRUE(log.good());
  std::vector<tenon::run_setup_t> setups;
  std::vector<tenon::run_status_t> statuses;
  std::string first;
  while (const lcm::LogEvent* event = log.readNextEvent()) {
    if (first.empty()) first = event->channel;
    if (event->channel == kSetupChannel) {
      ASSERT_GT(setups.emplace_back().decode(event->data, 0, event->datalen), 0);
    } else if (event->channel == kStatusChannel) {
      ASSERT_GT(statuses.emplace_back().decode(event->data, 0, event->datalen), 0);
    }
  }
  std::filesystem::remove(file);
  EXPECT_EQ(first, kSetupChannel);
  const auto seconds = static_cast<std::size_t>(result.duration_s);
  EXPECT_GE(setups.size(), seconds);
  EXPECT_LE(setups.size(), seconds + 2);
  EXPECT_GE(statuses.size(), 9 * seconds);
  const Plan plan = touch_and_slide_plan();
  const tenon::run_setup_t& m = setups.at(0);
  EXPECT_EQ(m.plan, plan.task_name);
  EXPECT_EQ(m.cycle_s, 0.002);
  ASSERT_EQ(m.joint_count, 3);
  EXPECT_EQ(m.joint_upper.at(1), hand_made_cell().robot.joints[1].upper);
  ASSERT_EQ(m.step_count, 2);
  EXPECT_NEAR(m.displacement.at(0).at(0), plan.steps[0].displacement[0], 1e-12);
  EXPECT_EQ(m.force_on_N.at(1), plan.parameter_sets[0].thresholds.force_on_N);
  EXPECT_EQ(statuses.at(0).awaited_step, -1);
  EXPECT_EQ(statuses.at(0).bus_known, 0);
}

TEST(Telemetry, TheBusIsToldByWhatGrewSinceTheLastStatus) {
  CanBusTraffic before;
  before.nominal_bits = 1000;
  before.status.received = 5;
  CanBusTraffic now = before;
  now.nominal_bits += 50'000;
  now.worst_bits = 60'000;
  now.status.sent = 200;
  now.status.send_failures = 3;
  tenon::run_status_t m{};
  tell_bus(now, before, 0.1, 1'000'000, m);
  EXPECT_NEAR(m.bus_load, 0.5, 1e-12);
  EXPECT_NEAR(m.bus_load_worst, 0.6, 1e-12);
  EXPECT_NEAR(m.frame_rate_hz, 2000.0, 1e-9);
  EXPECT_EQ(m.send_failures, 3);
  tell_bus(now, before, 0.0, 1'000'000, m = {});
  EXPECT_EQ(m.bus_load, 0.0);
}

struct Inbox {
  static void cycle(const lcm::ReceiveBuffer* /*b*/, const std::string& /*c*/,
                    const tenon::cycle_state_t* m, Inbox* inbox) {
    inbox->last = *m;
    ++inbox->cycles;
  }
  static void step(const lcm::ReceiveBuffer* /*b*/, const std::string& /*c*/,
                   const tenon::step_event_t* /*m*/, Inbox* inbox) {
    ++inbox->steps;
  }
  tenon::cycle_state_t last{};
  std::uint64_t cycles = 0;
  int steps = 0;
};

TEST(Telemetry, ASubscriberGetsWhatTheControllerDid) {
  const auto queue = std::make_shared<lcm::LCM>("memq://");
  ASSERT_TRUE(queue->good());
  Inbox inbox;
  queue->subscribeFunction(kCycleChannel, &Inbox::cycle, &inbox)->setQueueCapacity(0);
  queue->subscribeFunction(kStepChannel, &Inbox::step, &inbox)->setQueueCapacity(0);
  const RunResult result = published_run({queue, nullptr});
  while (queue->handleTimeout(0) > 0) {
  }
  EXPECT_EQ(inbox.cycles, result.statistics.cycles);
  EXPECT_EQ(inbox.steps, 2);
  EXPECT_EQ(inbox.last.state, static_cast<int>(State::kFinished));
  EXPECT_EQ(inbox.last.end_reason, static_cast<int>(EndReason::kPlanDone));
  EXPECT_NEAR(inbox.last.pose_position_m[1], 0.04, 5e-4);
}

TEST(Telemetry, AFullRingDropsAndCounts) {
  const auto recorder = std::make_unique<Recorder>();
  for (int i = 0; i < 5000; ++i) recorder->record({});
  EXPECT_EQ(recorder->dropped(), 5000U - 4096U);
}

TEST(Telemetry, ALogThatCannotBeWrittenIsBadInput) {
  std::vector<std::string> warnings;
  EXPECT_THROW((void)open_telemetry("none", "/nonexistent/run.lcmlog", warnings), InputError);
}

TEST(LcmUrl, ASlipOfThePenIsNoMissingRoute) {
  for (const char* good :
       {"udpm://239.255.76.67:7667?ttl=0", "udpm://", "udpm://:7000", "memq://", "udpm://239.1.2.3",
        "udpm://?recv_buf_size=65536&ttl=1", "file://run.lcmlog", "file://run.lcmlog?speed=0.5",
        "file://run.lcmlog?start_timestamp=1700000000000000&speed=4"}) {
    EXPECT_NO_THROW(check_lcm_url(good)) << good;
  }
  for (const char* bad :
       {"", "upd://239.255.76.67:7667", "udpm:239.255.76.67:7667", "239.255.76.67",
        "udpm://10.0.0.1:7667", "udpm://239.255.76.67:0", "udpm://239.255.76.67:7x",
        "udpm://239.255.76:7667", "file://", "memq://x", "udpm://host:7667",
        "udpm://239.255.76.67:7667?tll=0", "udpm://239.255.76.67:7667?ttl=256",
        "udpm://239.255.76.67:7667?ttl=", "udpm://239.255.76.67:7667?ttl=0&x",
        "file://run.lcmlog?sped=4", "file://run.lcmlog?speed=4&mode=r",
        "file://run.lcmlog?start_timestamp=1.5", "file://run.lcmlog?start_timestamp="}) {
    EXPECT_THROW(check_lcm_url(bad), InputError) << bad;
    std::vector<std::string> warnings;
    EXPECT_THROW((void)open_telemetry(bad, "", warnings), InputError) << bad;
  }
}

// LCM's file provider does not tell what a full disk cost.
TEST(LcmUrl, ALogFileIsNoPlaceToPublishTo) {
  std::vector<std::string> warnings;
  try {
    (void)open_telemetry("file://run.lcmlog?mode=w", "", warnings);
    ADD_FAILURE() << "opened";
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find("--log run.lcmlog"), std::string::npos)
        << error.what();
  }
}

TEST(RunResult, TheJsonTellsStepsReasonAndCycle) {
  Bench bench(touch_and_slide_plan());
  bench.arm.walls.push_back({0, +1, 0.13});
  bench.run();
  RunResult result = gather_result(bench.controller, bench.runner, 7, "");
  result.arm_counters = {{"late_frames", 3}};
  const auto json = nlohmann::json::parse(to_json(result, bench.controller.cell()));
  EXPECT_EQ(json.at("status"), "done");
  EXPECT_EQ(json.at("reason"), "plan_done");
  EXPECT_EQ(json.at("exit_code"), 0);
  ASSERT_EQ(json.at("steps").size(), 2U);
  EXPECT_EQ(json["steps"][0].at("outcome"), "contact");
  EXPECT_EQ(json["steps"][0].at("signature"), "-x");
  EXPECT_EQ(json["steps"][0].at("next"), 1);
  EXPECT_EQ(json["steps"][1].at("next"), "done");
  EXPECT_EQ(json.at("cycle").at("records_dropped"), 7);
  EXPECT_EQ(json.at("cycle").at("cycles"), result.statistics.cycles);
  EXPECT_EQ(json.at("arm").at("late_frames"), 3);
}

TEST(RunResult, WhatWasLostIsCountedAndNamedWhileTheArmsWorkIsDone) {
  RunResult result;
  result.exit_code = 0;
  EXPECT_EQ(result.losses(), "");
  EXPECT_EQ(result.exit_status(), 0);
  result.bus.send_failures = 2;
  result.unpublished = 5;
  EXPECT_EQ(result.losses(), "5 messages not published; 2 CAN frames not sent");
  EXPECT_EQ(result.exit_status(), 0);
  result.records = {{"can_log", "a", 3, 0, ""}, {"log", "b", 3, 4, "No space left on device"}};
  EXPECT_EQ(result.losses(),
            "--log b: 4 of 7 records lost (No space left on device); 5 messages not published; "
            "2 CAN frames not sent");
  EXPECT_EQ(result.exit_status(), 1);
  const auto json = nlohmann::json::parse(to_json(result, hand_made_cell()));
  EXPECT_EQ(json.at("status"), "done");
  EXPECT_EQ(json.at("exit_code"), 1);
  EXPECT_EQ(json.at("bus").at("send_failures"), 2);
  EXPECT_EQ(json.at("unpublished"), 5);
  EXPECT_EQ(json.at("records")[1].at("lost"), 4);
}

// Whoever makes a run again that a machine without time has ended has to know what ended it.
TEST(RunResult, WhatOfTheArmEndedARunOrItsBeingHeldIsNamed) {
  const auto arm_fault = [](EndReason reason, Hold hold, ArmFaultKind kind) {
    RunResult result;
    result.reason = reason;
    result.hold = hold;
    result.arm_fault = kind;
    return nlohmann::json::parse(to_json(result, hand_made_cell())).value("arm_fault", "none");
  };
  const ArmFaultKind silent = ArmFaultKind::kBusSilent;
  EXPECT_EQ(arm_fault(EndReason::kArmFault, Hold::kNone, silent), "bus_silent");
  EXPECT_EQ(arm_fault(EndReason::kBrakeFailed, Hold::kRefused, silent), "bus_silent");
  EXPECT_EQ(arm_fault(EndReason::kBrakeFailed, Hold::kLost, silent), "bus_silent");
  EXPECT_EQ(arm_fault(EndReason::kBrakeFailed, Hold::kHeld, silent), "none");
  // Its drives were not enabled, and no fault of the arm kept them so.
  EXPECT_EQ(arm_fault(EndReason::kBrakeFailed, Hold::kRefused, ArmFaultKind::kNone), "none");
}

TEST(RunResult, AnArmThatNeverDisabledIsNoSuccess) {
  Plan plan = hand_made_plan();
  plan.steps.push_back(hand_made_step(1, 0.01, {{Outcome::kReached, kSuccessorDone}}));
  Bench bench(plan);
  bench.arm.never_disables = true;
  bench.run();
  const RunResult result = gather_result(bench.controller, bench.runner, 0, "");
  EXPECT_EQ(result.exit_code, 1);
  EXPECT_EQ(result.reason, EndReason::kNotDisabled);
  EXPECT_NE(result.message.find("has not said that it is off within 3 s"), std::string::npos)
      << result.message;
}

TEST(RunResult, AStepIsOneLineForPeople) {
  StepReport report;
  report.step = 3;
  report.commanded[0] = 0.1;
  report.result.outcome = Outcome::kContact;
  report.result.signature.bits = ContactSignature::bit(0, -1);
  report.result.travelled[0] = 0.0312;
  report.result.peak_force_N = 6.84;
  report.result.duration_ns = 840'000'000;
  EXPECT_EQ(step_line(report),
            "step  3: +x 0.100 m -> contact (holds -x) after 0.0312 m, 6.8 N, 0.84 s");
}

}  // namespace
}  // namespace tenon::executor

// The dashboard without a terminal: messages in, lines of glyphs out.

#include "executor/monitor/dashboard.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "executor/faults/end_reason.h"
#include "executor/monitor/recording.h"
#include "executor/monitor/run_model.h"
#include "executor/states/state_machine.h"
#include "executor/telemetry/telemetry.h"
#include "shared/motion/contact_signature.h"
#include "tests/support/full_disk.h"
#include "tests/support/scratch_folder.h"

namespace tenon::executor {
namespace {

using testing::HasSubstr;

constexpr std::int64_t kSecond_ns = 1'000'000'000;

template <typename Message>
void take(RunModel& model, const char* channel, const Message& message, std::int64_t now_ns) {
  std::vector<std::uint8_t> bytes(static_cast<std::size_t>(message.getEncodedSize()));
  message.encode(bytes.data(), 0, static_cast<int>(bytes.size()));
  model.take(channel, bytes, now_ns);
}

tenon::run_setup_t one_step() {
  tenon::run_setup_t m{};
  m.cycle_s = 0.002;
  m.force_fault_N = 60.0;
  m.torque_fault_Nm = 10.0;
  m.compliant_axes = 0x3F;
  m.plan = "peg";
  m.joint_count = 1;
  m.joint_names = "lift\n";
  m.joint_linear = {1};
  m.joint_lower = {0.0};
  m.joint_upper = {1.0};
  m.step_count = 1;
  m.displacement = {{0.0, 0.0, -0.1, 0.0, 0.0, 0.0}};
  m.expected = {1 << static_cast<int>(Outcome::kContact)};
  m.expected_from = {0.02};
  m.expected_to = {0.06};
  m.force_on_N = {6.0};
  m.torque_on_Nm = {0.6};
  m.timeout_s = {10.0};
  m.trigger_mask = {0xFFF};
  m.sensed_axes = {0x3F};
  return m;
}

tenon::cycle_state_t cycle(std::int64_t sequence, int step) {
  tenon::cycle_state_t m{};
  m.sequence = sequence;
  m.motion_ns = 2'000'000 * sequence;
  m.state = static_cast<std::int8_t>(State::kRunning);
  m.step = static_cast<std::int16_t>(step);
  m.pose_orientation_wxyz[0] = 1.0;
  m.joint_count = 1;
  m.joint_position = {0.5};
  m.joint_commanded = {0.5};
  m.joints_fresh = 1;
  return m;
}

/// One step, half a second on its way down, now.
struct Seen {
  Seen() {
    take(model, kSetupChannel, one_step(), 0);
    take(model, kCycleChannel, cycle(0, -1), 0);
    take(model, kCycleChannel, cycle(1, 0), 0);
  }
  [[nodiscard]] std::vector<Line> lines(double later_s = 0.0) const {
    View at = view;
    at.now_ns = static_cast<std::int64_t>(later_s * kSecond_ns);
    return dashboard(model, at);
  }
  [[nodiscard]] std::string text(double later_s = 0.0) const {
    std::string all;
    for (const Line& line : lines(later_s)) all += text_of(line) + "\n";
    return all;
  }
  /// Of the first glyph of the row in which it stands.
  [[nodiscard]] Style style_of(const std::string& row, double later_s = 0.0) const {
    for (const Line& line : lines(later_s)) {
      const auto at = text_of(line).find(row);
      if (at != std::string::npos) return line[at].style;
    }
    ADD_FAILURE() << row << " is nowhere in\n" << text(later_s);
    return Style::kNormal;
  }
  void feel(double force_x_N, std::uint16_t signature = 0) {
    auto m = cycle(2, 0);
    m.wrench[0] = force_x_N;
    m.signature = static_cast<std::int16_t>(signature);
    take(model, kCycleChannel, m, 0);
  }
  RunModel model;
  View view{.width = 40, .height = 40};
};

TEST(Dashboard, EveryLineIsAsWideAsTheScreenAtAnySize) {
  Seen seen;
  seen.feel(1e300);
  for (const int width : {0, 1, 2, 20, 39, 40, 41, 79, 80, 149, 150, 200, 300}) {
    for (const int height : {0, 1, 2, 5, 24, 100}) {
      seen.view.width = width;
      seen.view.height = height;
      const auto lines = seen.lines(5.0);
      ASSERT_EQ(lines.size(), static_cast<std::size_t>(height));
      for (const Line& line : lines) ASSERT_EQ(line.size(), static_cast<std::size_t>(width));
    }
  }
}

TEST(Dashboard, AForceIsShownByItsShareOfTheThreshold) {
  Seen seen;
  seen.feel(2.9);
  EXPECT_THAT(seen.text(), HasSubstr("x     +2.9 N "));
  EXPECT_THAT(seen.text(), HasSubstr("  48 %"));
  EXPECT_EQ(seen.style_of("+2.9 N"), Style::kGood);
  seen.feel(-4.3);
  EXPECT_EQ(seen.style_of("-4.3 N"), Style::kWarn);
  seen.feel(6.5);
  EXPECT_EQ(seen.style_of("+6.5 N"), Style::kBad);
  EXPECT_THAT(seen.text(), HasSubstr(" 108 % ON!"));
  seen.feel(6.5, ContactSignature::bit(0, +1));
  EXPECT_EQ(seen.style_of("+6.5 N"), Style::kContact);
  EXPECT_THAT(seen.text(), HasSubstr(" 108 % +x"));
}

TEST(Dashboard, WhatATriggerDoesNotWatchIsNoWarning) {
  Seen seen;
  auto setup = one_step();
  setup.sequence = 1;
  setup.trigger_mask = {static_cast<std::int16_t>(~ContactSignature::bit(0, +1))};
  take(seen.model, kSetupChannel, setup, 0);
  seen.feel(5.9);
  EXPECT_EQ(seen.style_of("+5.9 N"), Style::kDim);
  seen.feel(-5.9);
  EXPECT_EQ(seen.style_of("-5.9 N"), Style::kWarn);
}

TEST(Dashboard, AStepsWayIsMeasuredAlongItsDisplacement) {
  Seen seen;
  auto m = cycle(251, 0);
  m.pose_position_m[2] = -0.0425;
  m.pose_position_m[0] = 0.3;  // across
  take(seen.model, kCycleChannel, m, 0);
  EXPECT_THAT(seen.text(), HasSubstr("step 0 (1 of 1): -z 0.1 m"));
  EXPECT_THAT(seen.text(), HasSubstr("expects contact"));
  EXPECT_THAT(seen.text(), HasSubstr("after 0.0200 to 0.0600 m"));
  EXPECT_THAT(seen.text(), HasSubstr("+0.0425 m"));
  EXPECT_THAT(seen.text(), HasSubstr("0.5 s of at most 10 s"));
}

TEST(Dashboard, TheWorstStandsFirst) {
  Seen seen;
  EXPECT_EQ(seen.lines()[0][0].style, Style::kGoodBanner);
  EXPECT_EQ(text_of(seen.lines(2.5)[0]), "STALE: no cycle for 2.5 s; what is shown");
  EXPECT_EQ(seen.lines(2.5)[0][0].style, Style::kBadBanner);
  EXPECT_EQ(seen.style_of("lift", 2.5), Style::kDim);
  auto m = cycle(3, 0);
  m.end_reason = static_cast<std::int8_t>(EndReason::kForceFault);
  take(seen.model, kCycleChannel, m, 0);
  EXPECT_THAT(text_of(seen.lines(2.5)[0]), HasSubstr("FAULT force_fault"));
  EXPECT_THAT(text_of(seen.lines(2.5)[1]), HasSubstr("STALE"));
  tenon::run_summary_t summary{};
  summary.exit_code = 1;
  summary.end_reason = m.end_reason;
  summary.message = "too hard\x1B[2J";
  take(seen.model, kRunChannel, summary, 0);
  EXPECT_THAT(text_of(seen.lines(2.5)[0]), HasSubstr("FAILED: too hard\\x1B[2J"));
  EXPECT_EQ(seen.text(2.5).find("STALE"), std::string::npos) << "an end is no gap";
}

std::string joined(const std::vector<Line>& lines) {
  std::string text;
  for (const Line& line : lines) {
    text += text_of(line);
    text.erase(text.find_last_not_of(' ') + 1);
    text += ' ';
  }
  return text;
}

// Its end says what nobody watches any more, and what may still move.
TEST(Dashboard, AFaultsMessageIsWholeWhereTheWindowHasRoomForIt) {
  Seen seen;
  tenon::run_summary_t summary{};
  summary.exit_code = 1;
  summary.message =
      "node 2 gave no feedback for 3 cycles while 2 are allowed; check bus load and wiring; after "
      "the stop nobody could watch whether the brake holds; the arm did not confirm that it is "
      "disabled: take its power before anybody reaches into the cell";
  take(seen.model, kRunChannel, summary, 0);
  for (const int height : {50, 30, 24, 20}) {
    seen.view.height = height;
    EXPECT_THAT(joined(seen.lines()), HasSubstr(summary.message)) << height << " rows";
  }
  EXPECT_THAT(joined(seen.lines()), HasSubstr("q quit"));
}

TEST(Dashboard, ALogThatBreaksOffSaysSoAtItsEnd) {
  Seen seen;
  seen.view.source = "file://run.lcmlog";
  seen.view.source_ended = true;
  EXPECT_EQ(seen.style_of("END of file://run.lcmlog"), Style::kWarnBanner);
  seen.view.source_lacks = "run.lcmlog: breaks off within a message; what stands before is shown";
  EXPECT_EQ(seen.style_of("END, not whole: run.lcmlog: breaks off"), Style::kBadBanner);
}

TEST(Dashboard, ANewRunForgetsTheOld) {
  Seen seen;
  tenon::run_summary_t summary{};
  summary.message = "old";
  take(seen.model, kRunChannel, summary, 0);
  EXPECT_THAT(seen.text(), HasSubstr("DONE: old"));
  take(seen.model, kSetupChannel, one_step(), kSecond_ns);
  take(seen.model, kCycleChannel, cycle(0, -1), kSecond_ns);
  EXPECT_EQ(seen.text(1.0).find("DONE: old"), std::string::npos);
  EXPECT_THAT(seen.text(1.0), HasSubstr("LIVE: running"));
}

// Joined late, the old run's setup missed; then the new run is told as it begins.
TEST(Dashboard, ANewRunsLimitsAreKnownFromItsFirstCycle) {
  Seen seen;
  seen.model = {};
  take(seen.model, kCycleChannel, cycle(5000, 0), 0);
  take(seen.model, kSetupChannel, one_step(), kSecond_ns);
  take(seen.model, kCycleChannel, cycle(0, 0), kSecond_ns);
  EXPECT_THAT(seen.text(1.0), HasSubstr("plan peg"));
}

TEST(Dashboard, AJointNearItsLimitAndOneThatIsSilentAreSaid) {
  Seen seen;
  auto m = cycle(2, 0);
  m.joint_position = {0.985};
  take(seen.model, kCycleChannel, m, 0);
  EXPECT_EQ(seen.style_of("+0.9850 m"), Style::kBad);
  m.sequence = 3;
  m.joints_fresh = 0;
  m.motion_ns += 250'000'000;
  take(seen.model, kCycleChannel, m, 0);
  EXPECT_THAT(seen.text(), HasSubstr("NO ANSWER for 0.25 s"));
}

TEST(Dashboard, AnOldLogIsShownWithoutItsLimits) {
  RunModel model;
  take(model, kCycleChannel, cycle(0, 0), 0);
  std::string text;
  for (const Line& line : dashboard(model, {.width = 80, .height = 30}))
    text += text_of(line) + "\n";
  EXPECT_THAT(text, HasSubstr("limits and plan unknown: no TENON_SETUP"));
  EXPECT_THAT(text, HasSubstr("x     +0.0 N"));
}

TEST(Dashboard, ASmallWindowSaysWhatItHides) {
  Seen seen;
  seen.view.height = 8;
  EXPECT_THAT(seen.text(), HasSubstr("lines more: make the window higher"));
}

TEST(Styled, LinesBreakBetweenWordsAndNeverBeyondTheWidth) {
  const auto lines = wrapped("one two-and-a-half three", 9, 9);
  std::vector<std::string> texts;
  for (const Line& line : lines) texts.push_back(text_of(line));
  EXPECT_EQ(texts, (std::vector<std::string>{"one", "two-and-a", "-half", "three"}));
  EXPECT_EQ(wrapped("one two three", 4, 2).size(), 2U);
}

TEST(Recording, HasItsNameOnlyOnceItIsWholeAndWritesOverNothing) {
  const tests::ScratchFolder folder;
  const std::vector<std::uint8_t> message(100, 7);
  for (const char* name : {"tenon-1.lcmlog", "tenon-1-2.lcmlog"}) {
    Recording recording(folder.path());
    EXPECT_EQ(recording.begin("1").text, "");
    EXPECT_EQ(recording.add(5, "A", message).text, "");
    EXPECT_FALSE(std::filesystem::exists(folder.path() / name));
    const auto said = recording.end();
    EXPECT_FALSE(said.bad);
    EXPECT_THAT(said.text, HasSubstr("recorded 1 messages: "));
    EXPECT_THAT(said.text, HasSubstr(name));
    EXPECT_EQ(std::filesystem::file_size(folder.path() / name), 28U + 1U + 100U);
  }
  EXPECT_EQ(folder.names().size(), 2U);
}

TEST(Recording, AFullDiskEndsItAndIsSaid) {
  const tests::ScratchFolder folder;
  Recording recording(folder.path());
  EXPECT_EQ(recording.begin("1").text, "");
  const tests::FullDisk full(10'000);
  const std::vector<std::uint8_t> message(1000, 7);
  Recording::Said said;
  for (int i = 0; i < 100 && said.text.empty(); ++i) said = recording.add(i, "A", message);
  EXPECT_TRUE(said.bad);
  EXPECT_THAT(said.text, HasSubstr("RECORDING ENDED: File too large; 9 of "));
  EXPECT_FALSE(recording.on());
}

TEST(Recording, AFolderThatIsNoneIsSaid) {
  Recording recording("/nonexistent");
  const auto said = recording.begin("1");
  EXPECT_TRUE(said.bad);
  EXPECT_FALSE(recording.on());
}

}  // namespace
}  // namespace tenon::executor

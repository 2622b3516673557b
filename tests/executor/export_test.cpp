// A run's log as files for other tools: values and their texts, the container's bytes, what happens
// in words. Whole files are read by tests/interop, which shares nothing with this.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <limits>
#include <map>
#include <nlohmann/json.hpp>
#include <sstream>
#include <string>
#include <vector>

#include "executor/export/export_log.h"
#include "executor/export/mcap_run.h"
#include "executor/export/mcap_writer.h"
#include "executor/export/run_events.h"
#include "executor/export/value.h"
#include "executor/faults/end_reason.h"
#include "executor/record/channels.h"
#include "executor/states/state_machine.h"
#include "executor/telemetry/event_log.h"
#include "shared/base/error.h"
#include "shared/base/text.h"
#include "shared/plan/transition.h"
#include "tests/support/full_disk.h"
#include "tests/support/scratch_folder.h"

namespace tenon::executor {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using tests::ScratchFolder;

std::string csv_of(const Value& value) {
  std::string text;
  add_csv(value, text);
  return text;
}

std::string json_of(const Value& value) {
  std::string text;
  add_json(value, text);
  return text;
}

std::string hex_of(std::string_view bytes) {
  std::string text;
  for (const char c : bytes)
    text += format("%02x", static_cast<unsigned>(static_cast<unsigned char>(c)));
  return text;
}

template <typename Message>
void log_message(EventLog& log, const char* channel, const Message& message) {
  std::vector<std::uint8_t> bytes(static_cast<std::size_t>(message.getEncodedSize()));
  message.encode(bytes.data(), 0, static_cast<int>(bytes.size()));
  log.add(message.utime, channel, bytes);
}

tenon::cycle_state_t cycle_at(std::int64_t sequence, State state) {
  tenon::cycle_state_t cycle{};
  cycle.utime = 1'700'000'000'000'000 + 2000 * sequence;
  cycle.sequence = sequence;
  cycle.monotonic_ns = 5'000'000'000 + 2'000'000 * sequence;
  cycle.state = static_cast<std::int8_t>(state);
  cycle.step = -1;
  cycle.wrench[0] = 1.5;
  cycle.joint_count = 1;
  cycle.joint_position = {0.25};
  cycle.joint_commanded = {0.5};
  return cycle;
}

/// The text of each field of the rows, by the head's names; of fields that hold no comma.
std::vector<std::map<std::string, std::string>> rows_of(const std::string& text) {
  std::vector<std::vector<std::string>> lines;
  std::istringstream in(text);
  for (std::string line; std::getline(in, line);) {
    lines.emplace_back();
    std::istringstream fields(line.substr(0, line.find('\r')));
    for (std::string field; std::getline(fields, field, ',');) lines.back().push_back(field);
  }
  std::vector<std::map<std::string, std::string>> rows;
  for (std::size_t i = 1; i < lines.size(); ++i) {
    rows.emplace_back();
    for (std::size_t j = 0; j < std::min(lines[0].size(), lines[i].size()); ++j)
      rows.back()[lines[0][j]] = lines[i][j];
  }
  return rows;
}

TEST(ExportValue, EveryNumberComesBackFromItsText) {
  for (const double number : {0.0, -0.1, 1.0 / 3.0, 5e-324, 1.7976931348623157e308, 123456789.0}) {
    EXPECT_EQ(std::strtod(csv_of(number).c_str(), nullptr), number);
    EXPECT_EQ(nlohmann::json::parse(json_of(number)).get<double>(), number);
  }
  EXPECT_EQ(csv_of(std::int64_t{-9'223'372'036'854'775'807}), "-9223372036854775807");
  EXPECT_EQ(csv_of(true), "true");
  EXPECT_EQ(seconds(6'000'000), 0.006);
}

TEST(ExportValue, WhatIsNoNumberIsNotKnown) {
  EXPECT_FALSE(is_known(std::numeric_limits<double>::quiet_NaN()));
  EXPECT_FALSE(is_known(std::numeric_limits<double>::infinity()));
  EXPECT_FALSE(is_known({}));
  EXPECT_TRUE(is_known(0.0));
  EXPECT_EQ(csv_of(std::numeric_limits<double>::quiet_NaN()), "");
  EXPECT_EQ(csv_of({}), "");
}

TEST(ExportValue, TextsAreQuotedWhereTheyHaveToBe) {
  EXPECT_EQ(csv_of(std::string("-x +z")), "-x +z");
  EXPECT_EQ(csv_of(std::string("a, \"b\"")), "\"a, \"\"b\"\"\"");
  EXPECT_EQ(csv_of(std::string("a\nb")), "\"a\nb\"");
  EXPECT_EQ(json_of(std::string("a\n\"b\"")), R"("a\n\"b\"")");
  EXPECT_EQ(nlohmann::json::parse(json_of(std::string("\xFF"))).get<std::string>(), "\xEF\xBF\xBD");
}

// As https://mcap.dev/spec has them; the checksums are zlib's.
TEST(McapWriter, AHeaderASchemaAndAChannelAreTheseBytes) {
  std::string file;
  McapWriter writer([&](std::string_view bytes) { file += bytes; }, "t 1");
  EXPECT_EQ(writer.add_channel({"/a", "A", "{}"}), 0);
  EXPECT_EQ(hex_of(file),
            "894d434150300d0a"
            "010b00000000000000"
            "00000000"
            "03000000742031"
            "031b00000000000000"
            "0100"
            "0100000041"
            "0a0000006a736f6e736368656d61"
            "020000007b7d"
            "041600000000000000"
            "0000"
            "0100"
            "020000002f61"
            "040000006a736f6e"
            "00000000");
}

TEST(McapWriter, ChannelsOfOneSchemaShareItAndMessagesAreNumberedEach) {
  std::string file;
  McapWriter writer([&](std::string_view bytes) { file += bytes; }, "t");
  const std::uint16_t a = writer.add_channel({"/a", "S", "{}"});
  const std::uint16_t b = writer.add_channel({"/b", "S", "{}"});
  EXPECT_NE(a, b);
  EXPECT_EQ(file.find("jsonschema"), file.rfind("jsonschema"));
  writer.add(a, 7, "{}");
  writer.add(b, 5, "{}");
  writer.add(b, 9, "{}");
  EXPECT_EQ(writer.messages(), 3U);
  const std::size_t before = file.size();
  writer.finish("m", {});
  // The chunk: opcode, length, from the earliest time to the latest.
  EXPECT_EQ(hex_of(file.substr(before, 1)), "06");
  EXPECT_EQ(hex_of(file.substr(before + 9, 16)),
            "0500000000000000"
            "0900000000000000");
  EXPECT_EQ(hex_of(file.substr(file.size() - 8)), "894d434150300d0a");
}

TEST(RunEvents, EachIsToldOnceByWhatTellsItFirst) {
  RunEvents events(std::vector<JointName>{{"x", "_m"}});
  const auto texts = [](const std::vector<RunEvent>& told) {
    std::vector<std::string> all;
    for (const RunEvent& event : told) all.push_back(event.text);
    return all;
  };
  EXPECT_THAT(texts(events.of(cycle_at(0, State::kWaiting))), ElementsAre("waiting"));
  EXPECT_THAT(texts(events.of(cycle_at(1, State::kWaiting))), IsEmpty());
  tenon::cycle_state_t ending = cycle_at(2, State::kStopping);
  ending.end_reason = static_cast<std::int8_t>(EndReason::kForceFault);
  const std::vector<RunEvent> told = events.of(ending);
  EXPECT_THAT(texts(told), ElementsAre("stopping", "ends: force fault"));
  EXPECT_EQ(told[1].level, EventLevel::kError);
  EXPECT_THAT(texts(events.of(ending)), IsEmpty());

  tenon::run_status_t status{};
  status.awaited_step = 3;
  status.pace = 0.0;
  status.slipped_joint = 0;
  status.slipped = 0.004;
  status.bus_known = 1;
  EXPECT_THAT(
      texts(events.of(status)),
      ElementsAre("waits before step 3", "paused",
                  "the brake of joint x does not hold: it moved by 0.004 m", "the bus is down"));
  EXPECT_THAT(texts(events.of(status)), IsEmpty());
  status.pace = 1.0;
  EXPECT_THAT(texts(events.of(status)), ElementsAre("goes on"));

  tenon::step_event_t step{};
  step.step = 2;
  step.outcome = 1;
  step.signature = 2;
  EXPECT_THAT(texts(events.of(step)), ElementsAre("step 2: contact, holds -x"));
  step.deviation = static_cast<std::int8_t>(Deviation::kContactMissing);
  step.deviation_index = 4;
  EXPECT_THAT(texts(events.of(step))[0], HasSubstr("contact +z"));
  step.deviation = static_cast<std::int8_t>(Deviation::kTravelOutside);
  EXPECT_THAT(texts(events.of(step))[0], HasSubstr("along ry outside what validation saw"));
}

class ExportLogTest : public testing::Test {
 protected:
  [[nodiscard]] std::filesystem::path file(const char* name) const { return folder.path() / name; }
  [[nodiscard]] Exported exported(std::optional<std::size_t> run = {}) const {
    return export_log({file("run.lcmlog"), file("run.csv"), file("run.mcap"), run, "1.2.3"});
  }

  ScratchFolder folder;
};

TEST_F(ExportLogTest, WhatMeansNothingInAStateIsEmptyAndWhatCameTwiceIsLeftOut) {
  {
    EventLog log(file("run.lcmlog"));
    log_message(log, kCycleChannel, cycle_at(0, State::kWaiting));
    log_message(log, kCycleChannel, cycle_at(1, State::kTaring));
    log_message(log, kCycleChannel, cycle_at(1, State::kTaring));
    log_message(log, kCycleChannel, cycle_at(2, State::kRunning));
  }
  const Exported told = exported();
  EXPECT_THAT(told.missing, ElementsAre(HasSubstr("1 messages came twice or late")));
  EXPECT_THAT(told.notes, ElementsAre(HasSubstr("ends before the run does"),
                                      HasSubstr("does not name the joints")));
  auto rows = rows_of(folder.get("run.csv"));
  ASSERT_EQ(rows.size(), 3U);
  EXPECT_EQ(rows[0]["joint_0"], "");
  EXPECT_EQ(rows[1]["joint_0"], "0.25");
  EXPECT_EQ(rows[1]["joint_0_commanded"], "");
  EXPECT_EQ(rows[1]["force_x_N"], "");
  EXPECT_EQ(rows[2]["force_x_N"], "1.5");
  EXPECT_EQ(rows[2]["joint_0_commanded"], "0.5");
  EXPECT_EQ(rows[2]["time_s"], "0.004");
  EXPECT_EQ(rows[2]["log_time_us"], "1700000000004000");
  EXPECT_EQ(rows[2]["step"], "");
  EXPECT_EQ(rows[2]["event"], "running");
}

// No plan, no steps, no thresholds; and joints by their names.
TEST_F(ExportLogTest, ALogOfAnIdentificationIsWrittenToo) {
  {
    EventLog log(file("run.lcmlog"));
    tenon::run_setup_t setup{};
    setup.robot = "arm";
    setup.joint_count = 1;
    setup.joint_names = "shoulder";
    setup.joint_linear = {0};
    setup.joint_lower = {-1.0};
    setup.joint_upper = {2.0};
    log_message(log, kSetupChannel, setup);
    log_message(log, kCycleChannel, cycle_at(0, State::kRunning));
    tenon::run_summary_t summary{};
    summary.message = "measured";
    summary.end_reason = static_cast<std::int8_t>(EndReason::kMeasured);
    summary.monotonic_ns = 5'000'000'000;
    log_message(log, kRunChannel, summary);
  }
  const Exported told = exported();
  EXPECT_THAT(told.missing, IsEmpty());
  EXPECT_THAT(told.notes, IsEmpty());
  auto rows = rows_of(folder.get("run.csv"));
  ASSERT_EQ(rows.size(), 1U);
  EXPECT_EQ(rows[0]["joint_shoulder_rad"], "0.25");
  EXPECT_EQ(rows[0]["joint_shoulder_commanded_rad"], "0.5");
  EXPECT_EQ(rows[0]["contact_from_N"], "");
  EXPECT_EQ(rows[0]["event"], "running; done: measured");
  EXPECT_THAT(folder.get("run.mcap"), HasSubstr(R"("joint_shoulder_upper_rad":2)"));
}

// Of what anybody sends, clocks and numbers included.
TEST_F(ExportLogTest, WhateverTheMessagesSayFilesComeOfIt) {
  constexpr std::int64_t kLeast = std::numeric_limits<std::int64_t>::min();
  constexpr std::int64_t kMost = std::numeric_limits<std::int64_t>::max();
  {
    EventLog log(file("run.lcmlog"));
    tenon::cycle_state_t cycle = cycle_at(0, State::kRunning);
    cycle.utime = kLeast;
    cycle.monotonic_ns = kLeast;
    log_message(log, kCycleChannel, cycle);
    cycle = cycle_at(1, static_cast<State>(77));
    cycle.monotonic_ns = kMost;
    cycle.step = 300;
    cycle.phase = -5;
    cycle.arm_state = 99;
    cycle.end_reason = -3;
    cycle.wrench[1] = std::numeric_limits<double>::quiet_NaN();
    cycle.pose_position_m[0] = std::numeric_limits<double>::infinity();
    cycle.joint_count = 0;
    cycle.joint_position.clear();
    cycle.joint_commanded.clear();
    log_message(log, kCycleChannel, cycle);
    tenon::step_event_t step{};
    step.outcome = 100;
    step.deviation = 100;
    step.successor = -1;
    log_message(log, kStepChannel, step);
    tenon::run_summary_t summary{};
    summary.message = "a\x1B[2J, \"b\"\n\xFF";
    log_message(log, kRunChannel, summary);
  }
  EXPECT_THAT(exported().missing, IsEmpty());
  auto rows = rows_of(folder.get("run.csv"));
  ASSERT_EQ(rows.size(), 2U);
  EXPECT_EQ(rows[1]["force_y_N"], "");
  EXPECT_EQ(rows[1]["state_number"], "77");
  EXPECT_THAT(folder.get("run.csv"),
              HasSubstr("step 0: ?, holds none; done: a\\x1B[2J, \"\"b\"\""));
  EXPECT_THAT(folder.get("run.mcap"), HasSubstr("tenon 1.2.3"));
}

TEST_F(ExportLogTest, AFullDiskLeavesNoFileAndIsNoFaultOfTheInput) {
  {
    EventLog log(file("run.lcmlog"));
    for (int i = 0; i < 2000; ++i) log_message(log, kCycleChannel, cycle_at(i, State::kRunning));
  }
  std::string said;
  {
    const tests::FullDisk full_disk(100'000);
    try {
      (void)exported();
    } catch (const InputError& error) {
      ADD_FAILURE() << error.what();
    } catch (const std::runtime_error& error) {
      said = error.what();
    }
  }
  EXPECT_THAT(said, HasSubstr("cannot be written: File too large"));
  EXPECT_EQ(folder.names(), std::vector<std::string>{"run.lcmlog"});
  EXPECT_THAT(exported().written, ElementsAre(HasSubstr("run.csv: 2000 cycles, 4.00 s"),
                                              HasSubstr("run.mcap: 2000 cycles")));
}

}  // namespace
}  // namespace tenon::executor

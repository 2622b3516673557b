// The drive's state machine against CiA 402's own table, over every statusword.

#include <gtest/gtest.h>

#include <array>
#include <map>

#include "hw/cia402/drive_state.h"
#include "hw/cia402/enabling.h"

namespace tenon::hw::cia402 {
namespace {

TEST(Statusword, EveryWordDecodesToTheOneRowThatItMatches) {
  struct Row {
    unsigned mask, value;
    DriveState state;
  };
  constexpr std::array<Row, 8> kRows{{{0x4F, 0x00, DriveState::kNotReadyToSwitchOn},
                                      {0x4F, 0x40, DriveState::kSwitchOnDisabled},
                                      {0x6F, 0x21, DriveState::kReadyToSwitchOn},
                                      {0x6F, 0x23, DriveState::kSwitchedOn},
                                      {0x6F, 0x27, DriveState::kOperationEnabled},
                                      {0x6F, 0x07, DriveState::kQuickStopActive},
                                      {0x4F, 0x0F, DriveState::kFaultReactionActive},
                                      {0x4F, 0x08, DriveState::kFault}}};
  for (unsigned word = 0; word <= 0xFFFF; ++word) {
    DriveState expected = DriveState::kUnknown;
    int matches = 0;
    for (const Row& row : kRows) {
      if ((word & row.mask) == row.value) {
        expected = row.state;
        ++matches;
      }
    }
    ASSERT_LE(matches, 1);
    ASSERT_EQ(decode_statusword(static_cast<std::uint16_t>(word)), expected) << word;
  }
}

TEST(Statusword, WordsAsDrivesSendThem) {
  EXPECT_EQ(decode_statusword(0x0250), DriveState::kSwitchOnDisabled);
  EXPECT_EQ(decode_statusword(0x0231), DriveState::kReadyToSwitchOn);
  EXPECT_EQ(decode_statusword(0x0233), DriveState::kSwitchedOn);
  EXPECT_EQ(decode_statusword(0x1237), DriveState::kOperationEnabled);
  EXPECT_EQ(decode_statusword(0x0217), DriveState::kQuickStopActive);
  EXPECT_EQ(decode_statusword(0x021F), DriveState::kFaultReactionActive);
  EXPECT_EQ(decode_statusword(0x0218), DriveState::kFault);
}

struct Expectation {
  DriveState state;
  std::uint16_t enabled, disabled, quick_stop;
};
// Literal controlwords, for all states.
constexpr std::array<Expectation, 9> kExpected{{
    {DriveState::kUnknown, 0x00, 0x00, 0x00},
    {DriveState::kNotReadyToSwitchOn, 0x00, 0x00, 0x00},
    {DriveState::kSwitchOnDisabled, 0x06, 0x00, 0x00},
    {DriveState::kReadyToSwitchOn, 0x07, 0x00, 0x00},
    {DriveState::kSwitchedOn, 0x0F, 0x06, 0x00},
    {DriveState::kOperationEnabled, 0x0F, 0x07, 0x02},
    {DriveState::kQuickStopActive, 0x0F, 0x00, 0x02},
    {DriveState::kFaultReactionActive, 0x00, 0x00, 0x00},
    {DriveState::kFault, 0x80, 0x00, 0x00},
}};

TEST(Enabling, ControlwordForEveryStateAndRequest) {
  for (const Expectation& row : kExpected) {
    EXPECT_EQ(next_controlword(row.state, ArmRequest::kEnabled, 0, false), row.enabled);
    EXPECT_EQ(next_controlword(row.state, ArmRequest::kDisabled, 0, false), row.disabled);
    EXPECT_EQ(next_controlword(row.state, ArmRequest::kQuickStop, 0, false), row.quick_stop);
  }
}

TEST(Enabling, ADriveHasFollowedOnceNothingIsLeftToCommand) {
  for (const Expectation& row : kExpected) {
    const DriveState state = row.state;
    const bool off = state == DriveState::kSwitchOnDisabled || state == DriveState::kFault;
    EXPECT_EQ(has_followed(state, ArmRequest::kEnabled), state == DriveState::kOperationEnabled);
    EXPECT_EQ(has_followed(state, ArmRequest::kDisabled), off);
    EXPECT_EQ(has_followed(state, ArmRequest::kQuickStop),
              off || state == DriveState::kQuickStopActive);
  }
}

TEST(Enabling, FaultIsResetByRisingEdgesOnly) {
  std::uint16_t controlword = 0x0F;
  for (const int expected : {0x80, 0x00, 0x80, 0x00}) {
    controlword = next_controlword(DriveState::kFault, ArmRequest::kEnabled, controlword, false);
    EXPECT_EQ(controlword, expected);
  }
}

TEST(Enabling, InterpolatedPositionNeedsBitFourOnlyOnceEnabled) {
  EXPECT_EQ(next_controlword(DriveState::kOperationEnabled, ArmRequest::kEnabled, 0x0F, true),
            0x1F);
  EXPECT_EQ(next_controlword(DriveState::kSwitchedOn, ArmRequest::kEnabled, 0x07, true), 0x0F);
}

/// The drive's side of the standard's transitions 2..16, without fault.
DriveState drive_after(DriveState state, std::uint16_t controlword) {
  const std::map<std::pair<DriveState, unsigned>, DriveState> transitions{
      {{DriveState::kSwitchOnDisabled, 0x06}, DriveState::kReadyToSwitchOn},
      {{DriveState::kReadyToSwitchOn, 0x07}, DriveState::kSwitchedOn},
      {{DriveState::kReadyToSwitchOn, 0x00}, DriveState::kSwitchOnDisabled},
      {{DriveState::kSwitchedOn, 0x0F}, DriveState::kOperationEnabled},
      {{DriveState::kSwitchedOn, 0x06}, DriveState::kReadyToSwitchOn},
      {{DriveState::kSwitchedOn, 0x00}, DriveState::kSwitchOnDisabled},
      {{DriveState::kOperationEnabled, 0x07}, DriveState::kSwitchedOn},
      {{DriveState::kOperationEnabled, 0x02}, DriveState::kQuickStopActive},
      {{DriveState::kQuickStopActive, 0x0F}, DriveState::kOperationEnabled},
      {{DriveState::kQuickStopActive, 0x00}, DriveState::kSwitchOnDisabled},
      {{DriveState::kFault, 0x80}, DriveState::kSwitchOnDisabled},
      {{DriveState::kNotReadyToSwitchOn, 0x00}, DriveState::kSwitchOnDisabled},
      {{DriveState::kFaultReactionActive, 0x00}, DriveState::kFault}};
  const auto found = transitions.find({state, controlword});
  return found != transitions.end() ? found->second : state;
}

TEST(Enabling, EveryStateReachesOperationEnabledAndBack) {
  for (const Expectation& row : kExpected) {
    if (row.state == DriveState::kUnknown) continue;
    DriveState state = row.state;
    std::uint16_t controlword = 0;
    for (int i = 0; i < 6; ++i) {
      controlword = next_controlword(state, ArmRequest::kEnabled, controlword, false);
      state = drive_after(state, controlword);
    }
    EXPECT_EQ(state, DriveState::kOperationEnabled) << to_string(row.state);
    for (int i = 0; i < 6; ++i) {
      controlword = next_controlword(state, ArmRequest::kDisabled, controlword, false);
      state = drive_after(state, controlword);
    }
    EXPECT_EQ(state, DriveState::kSwitchOnDisabled);
  }
}

}  // namespace
}  // namespace tenon::hw::cia402

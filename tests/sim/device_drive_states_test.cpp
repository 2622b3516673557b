// Every transition of CiA 402's power state machine (its numbers, 0 to 16) in modes 7 and 8, walked
// by the independent client, with the statuswords of the standard's table.

#include <gtest/gtest.h>

#include "tests/sim/device_bench.h"

namespace tenon::sim {
namespace {

// Statusword, masked by 4Fh.
constexpr int kNotReady = 0x00;
constexpr int kSwitchOnDisabled = 0x40;
constexpr int kFaultReaction = 0x0F;
constexpr int kFault = 0x08;
// Masked by 6Fh.
constexpr int kReadyToSwitchOn = 0x21;
constexpr int kSwitchedOn = 0x23;
constexpr int kOperationEnabled = 0x27;
constexpr int kQuickStopActive = 0x07;

class DriveStatesTest : public ::testing::TestWithParam<int> {
 protected:
  DriveStatesTest() { bench.configure(); }

  /// The bits that the table shows for a state: 4Fh where bit 5 is anything.
  int state() {
    const int word = bench.status();
    const int brief = word & 0x4F;
    return brief == kNotReady || brief == kSwitchOnDisabled || brief == kFaultReaction ||
                   brief == kFault
               ? brief
               : word & 0x6F;
  }
  void reach_ready() { bench.control(0x06); }
  void reach_switched_on() {
    bench.control(0x06);
    bench.control(0x07);
  }
  void fail() { bench.drive.inject({.kind = FaultKind::kEmergency, .value = 0x5000}); }

  DriveBench bench{static_cast<std::int8_t>(GetParam())};
};

INSTANTIATE_TEST_SUITE_P(Modes, DriveStatesTest, ::testing::Values(7, 8));

TEST_P(DriveStatesTest, T0AndT1RunByThemselvesAfterPowerOn) {
  bench.tell(bench.client.nmt(0x81));
  EXPECT_EQ(state(), kNotReady);
  bench.control(0x06);
  EXPECT_EQ(state(), kNotReady);
  bench.pass(5);
  EXPECT_EQ(state(), kSwitchOnDisabled);
}

TEST_P(DriveStatesTest, T2IsShutdownAlone) {
  for (const int word : {0x00, 0x02, 0x07, 0x0F, 0x80}) {
    bench.control(word);
    EXPECT_EQ(state(), kSwitchOnDisabled) << word;
  }
  bench.control(0x06);
  EXPECT_EQ(state(), kReadyToSwitchOn);
}

TEST_P(DriveStatesTest, T3IsSwitchOnAndT6ShutdownBack) {
  reach_ready();
  bench.control(0x07);
  EXPECT_EQ(state(), kSwitchedOn);
  EXPECT_TRUE(bench.drive.brake_engaged());
  bench.control(0x06);
  EXPECT_EQ(state(), kReadyToSwitchOn);
}

TEST_P(DriveStatesTest, T4OpensTheBrakeBeforeOperationIsEnabledAndT5ClosesIt) {
  reach_switched_on();
  bench.control(bench.enable_word());
  bench.pass(19);
  EXPECT_EQ(state(), kSwitchedOn) << "the brake opens for 20 ms";
  bench.pass(2);
  EXPECT_EQ(state(), kOperationEnabled);
  EXPECT_FALSE(bench.drive.brake_engaged());
  bench.control(0x07);
  bench.pass(15);
  EXPECT_EQ(state(), kSwitchedOn);
  EXPECT_TRUE(bench.drive.brake_engaged());
}

TEST_P(DriveStatesTest, T3AndT4InOneWordFromReady) {
  reach_ready();
  bench.control(bench.enable_word());
  bench.pass(25);
  EXPECT_EQ(state(), kOperationEnabled);
}

TEST_P(DriveStatesTest, AnEnablingTakenBackLeavesTheBrakeClosed) {
  for (const auto& [word, expected] :
       {std::pair(0x07, kSwitchedOn), std::pair(0x06, kReadyToSwitchOn),
        std::pair(0x00, kSwitchOnDisabled)}) {
    reach_switched_on();
    bench.control(bench.enable_word());
    bench.pass(5);
    bench.control(word);
    bench.pass(50);
    EXPECT_EQ(state(), expected);
    EXPECT_TRUE(bench.demand.brake);
    bench.control(0x00);
  }
}

TEST_P(DriveStatesTest, T7IsDisableVoltageOrQuickStopFromReady) {
  for (const int word : {0x00, 0x02}) {
    reach_ready();
    bench.control(word);
    EXPECT_EQ(state(), kSwitchOnDisabled) << word;
  }
}

TEST_P(DriveStatesTest, T8IsShutdownFromEnabled) {
  bench.enable();
  bench.control(0x06);
  EXPECT_EQ(state(), kReadyToSwitchOn) << "605Bh = 0: at once";
  EXPECT_EQ(bench.write_u16({0x605B}, 1), 0U);
  bench.enable();
  bench.run_fast();
  bench.control(0x06);
  EXPECT_EQ(state(), kOperationEnabled) << "605Bh = 1: by a ramp";
  bench.pass(120);
  EXPECT_EQ(state(), kReadyToSwitchOn);
}

TEST_P(DriveStatesTest, T9IsDisableVoltageFromEnabled) {
  bench.enable();
  bench.control(0x00);
  EXPECT_EQ(state(), kSwitchOnDisabled);
  EXPECT_TRUE(bench.drive.brake_engaged());
}

TEST_P(DriveStatesTest, T10IsDisableVoltageOrQuickStopFromSwitchedOn) {
  for (const int word : {0x00, 0x02}) {
    reach_switched_on();
    bench.control(word);
    EXPECT_EQ(state(), kSwitchOnDisabled) << word;
  }
}

TEST_P(DriveStatesTest, T11IsQuickStopAndT12FollowsAtStandstillOrByDisableVoltage) {
  EXPECT_EQ(bench.write_u16({0x605A}, 2), 0U);
  bench.enable();
  bench.run_fast();
  bench.control(0x02);
  EXPECT_EQ(state(), kQuickStopActive);
  bench.control(0x0F);
  EXPECT_EQ(state(), kQuickStopActive) << "with 605Ah = 2 there is no way back";
  bench.pass(120);
  EXPECT_EQ(state(), kSwitchOnDisabled);
  bench.enable();
  bench.control(0x02);
  bench.control(0x00);
  EXPECT_EQ(state(), kSwitchOnDisabled);
}

TEST_P(DriveStatesTest, T13ReactsToAFaultByARampAndT14EndsInFault) {
  bench.enable();
  bench.run_fast();
  fail();
  EXPECT_EQ(state(), kFaultReaction);
  bench.control(0x00);
  EXPECT_EQ(state(), kFaultReaction) << "no command counts";
  bench.pass(120);
  EXPECT_EQ(state(), kFault);
  EXPECT_TRUE(bench.drive.brake_engaged());
  EXPECT_EQ(bench.value({0x603F}), 0x5000U);
}

TEST_P(DriveStatesTest, T13ComesFromEveryState) {
  const std::vector<std::vector<int>> ways = {{},
                                              {0x06},
                                              {0x06, 0x07},
                                              {0x06, 0x07, bench.enable_word()},
                                              {0x06, 0x07, bench.enable_word(), 0x02}};
  for (const std::vector<int>& way : ways) {
    for (const int word : way) {
      bench.control(word);
      bench.pass(25);
    }
    fail();
    bench.pass(50);
    EXPECT_EQ(state(), kFault);
    EXPECT_EQ(bench.emergencies(), (Emergencies{{0x5000, 0x01}}));
    bench.control(0x80);
    EXPECT_EQ(state(), kSwitchOnDisabled);
    EXPECT_EQ(bench.emergencies(), (Emergencies{{0x0000, 0x00}}));
    bench.control(0x00);
  }
}

TEST_P(DriveStatesTest, T15IsTheRisingEdgeOfBitSevenAlone) {
  bench.control(0x80);  // up before the fault
  fail();
  EXPECT_EQ(state(), kFault);
  for (const int word : {0x80, 0x8F, 0x06, 0x07, 0x0F, 0x00}) {
    bench.control(word);
    EXPECT_EQ(state(), kFault) << std::hex << word;
  }
  bench.control(0x80);
  EXPECT_EQ(state(), kSwitchOnDisabled);
  EXPECT_EQ(bench.value({0x603F}), 0U);
  EXPECT_EQ(bench.value({0x1001}), 0U);
}

TEST_P(DriveStatesTest, T16ReturnsFromAQuickStopThatHolds) {
  for (const int option : {5, 6}) {
    EXPECT_EQ(bench.write_u16({0x605A}, option), 0U);
    bench.enable();
    bench.run_fast();
    bench.control(0x02);
    EXPECT_EQ(state(), kQuickStopActive);
    bench.control(0x0F);
    EXPECT_EQ(state(), kQuickStopActive) << "not before it stands";
    bench.pass(300);
    EXPECT_EQ(state(), kQuickStopActive);
    EXPECT_FALSE(bench.drive.brake_engaged());
    EXPECT_EQ(bench.write_u16({0x605A}, 2), 0U);
    bench.control(bench.enable_word());
    EXPECT_EQ(state(), kQuickStopActive) << "the option as it is now decides";
    EXPECT_EQ(bench.write_u16({0x605A}, option), 0U);
    bench.control(bench.enable_word());
    EXPECT_EQ(state(), kOperationEnabled);
    bench.control(0x00);
  }
}

TEST_P(DriveStatesTest, QuickStopWithOptionZeroSwitchesOff) {
  EXPECT_EQ(bench.write_u16({0x605A}, 0), 0U);
  bench.enable();
  bench.control(0x02);
  EXPECT_EQ(state(), kSwitchOnDisabled);
}

TEST_P(DriveStatesTest, TheModeChangesOnlyWithoutPower) {
  EXPECT_EQ(bench.value({0x6061}), static_cast<std::uint64_t>(GetParam()));
  EXPECT_EQ(bench.write_u8({0x6060}, 15 - GetParam()), 0x06090030U) << "the mode it lacks";
  EXPECT_EQ(bench.write_u8({0x6060}, 0), 0U);
  EXPECT_EQ(bench.value({0x6061}), 0U);
  EXPECT_EQ(bench.write_u8({0x6060}, GetParam()), 0U);
  bench.enable();
  EXPECT_EQ(bench.write_u8({0x6060}, 0), 0x08000022U);
  EXPECT_EQ(bench.value({0x6061}), static_cast<std::uint64_t>(GetParam()));
}

/// 6007h, and where an enabled drive ends when its master's heartbeat is lost.
class LostMasterTest : public ::testing::TestWithParam<std::tuple<int, int, int>> {};

INSTANTIATE_TEST_SUITE_P(Options, LostMasterTest,
                         ::testing::Combine(::testing::Values(7, 8), ::testing::Values(0, 1, 2, 3),
                                            ::testing::Values(0, 1)));

TEST_P(LostMasterTest, DoesWhatItsOptionSays) {
  const auto [mode, option, stopped_by_nmt] = GetParam();
  DriveBench bench(static_cast<std::int8_t>(mode));
  bench.configure();
  EXPECT_EQ(bench.write_u16({0x6007}, option), 0U);
  EXPECT_EQ(bench.write_u32({0x1016, 1}, 0x007F0064), 0U);
  bench.tell(CanopenClient::heartbeat(127));
  bench.enable();
  bench.run(25, 200);
  EXPECT_EQ(bench.long_state(), kOperationEnabled);
  bench.emergencies();
  if (stopped_by_nmt == 1) {
    bench.tell(bench.client.nmt(0x02));
  } else {
    bench.pass(26);  // 101 ms since the heartbeat
    EXPECT_EQ(bench.emergencies(), (Emergencies{{0x8130, 0x11}}));
  }
  switch (option) {
    case 0:
      EXPECT_EQ(bench.drive.state(), DriveState::kOperationEnabled);
      break;
    case 1:
      bench.pass(150);
      EXPECT_EQ(bench.drive.state(), DriveState::kFault);
      EXPECT_EQ(bench.drive.error_code(), 0x8130);
      break;
    case 2:
      EXPECT_EQ(bench.drive.state(), DriveState::kSwitchOnDisabled);
      break;
    default:
      EXPECT_EQ(bench.drive.state(), DriveState::kQuickStopActive);
      bench.pass(150);
      EXPECT_EQ(bench.drive.state(), DriveState::kSwitchOnDisabled);
      EXPECT_TRUE(bench.drive.brake_engaged());
      break;
  }
}

TEST(LostMasterTest, AFaultThatItCausedIsClearedByItsResetAndNotByTheNextHeartbeat) {
  DriveBench bench;
  bench.configure();
  EXPECT_EQ(bench.write_u16({0x6007}, 1), 0U);
  EXPECT_EQ(bench.write_u32({0x1016, 1}, 0x007F0064), 0U);
  bench.tell(CanopenClient::heartbeat(127));
  bench.enable();
  bench.pass(200);
  EXPECT_EQ(bench.emergencies(), (Emergencies{{0x8130, 0x11}})) << "said once";
  bench.tell(CanopenClient::heartbeat(127));
  EXPECT_EQ(bench.value({0x1001}), 0x11U);
  EXPECT_TRUE(bench.emergencies().empty());
  bench.control(0x80);
  EXPECT_EQ(bench.emergencies(), (Emergencies{{0x0000, 0x00}}));
}

}  // namespace
}  // namespace tenon::sim

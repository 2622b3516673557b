// NMT, boot-up, heartbeats in both directions, and what a node does not have, walked by the
// independent client.

#include <gtest/gtest.h>

#include "tests/sim/device_bench.h"

namespace tenon::sim {
namespace {

using States = std::vector<std::uint8_t>;

TEST(DeviceNmtTest, ADeviceBootsIntoPreOperationalAndSaysSoOnce) {
  DriveBench drive;
  EXPECT_EQ(drive.heartbeats(), States{0x00});
  EXPECT_EQ(drive.value({0x1000}), 0x00020192U);
  drive.sync(3);
  EXPECT_TRUE(drive.pdos(0x185).empty()) << "no PDO before operational";
  SensorBench sensor;
  EXPECT_EQ(sensor.heartbeats(), States{0x00});
  EXPECT_EQ(sensor.value({0x1000}), 0x00000194U);
}

// from   0x01 start   0x80 pre-op   0x02 stop   0x82 reset comm.   0x81 reset node
TEST(DeviceNmtTest, EveryCommandLeadsFromEveryStateWhereTheStandardSays) {
  struct Command {
    std::uint8_t code;
    std::uint8_t state;  ///< in the heartbeat after it
    bool boots;
  };
  const std::vector<Command> commands = {{0x01, 0x05, false},
                                         {0x80, 0x7F, false},
                                         {0x02, 0x04, false},
                                         {0x82, 0x7F, true},
                                         {0x81, 0x7F, true}};
  for (const Command& from : commands) {
    for (const Command& to : commands) {
      for (const bool everybody : {false, true}) {
        DriveBench bench;
        EXPECT_EQ(bench.write_u16({0x1017}, 10), 0U);
        EXPECT_EQ(bench.write_u32({0x1010, 1}, 0x65766173), 0U);  // survives the resets
        bench.tell(bench.client.nmt(from.code));
        bench.pass(20);
        EXPECT_EQ(bench.heartbeats().back(), from.state);
        bench.tell(everybody ? CanopenClient::nmt_all(to.code) : bench.client.nmt(to.code));
        const States said = bench.heartbeats();
        EXPECT_EQ(said, to.boots ? States{0x00} : States{});
        bench.pass(20);
        EXPECT_EQ(bench.heartbeats().back(), to.state)
            << std::hex << int{from.code} << " then " << int{to.code};
      }
    }
  }
}

TEST(DeviceNmtTest, CommandsForOthersUnknownOnesAndMutilatedOnesChangeNothing) {
  DriveBench bench;
  bench.start();
  for (const Bytes& bytes :
       {Bytes{0x02, 0x06}, Bytes{0x03, 0x05}, Bytes{0x02}, Bytes{}, Bytes{0x02, 0x05, 0x00}}) {
    bench.tell({0x000, bytes});
    EXPECT_EQ(bench.node().state(), NmtState::kOperational);
  }
}

TEST(DeviceNmtTest, StoppedAnswersNoSdoAndSendsNoPdoAndNoEmergency) {
  DriveBench bench;
  bench.start();
  bench.emergencies();
  bench.tell(bench.client.nmt(0x02));
  bench.pdos(0x185);
  EXPECT_EQ(bench.read_abort({0x1000}), 0x05040000U) << "the client's own time-out";
  bench.sync(3);
  bench.tell({0x205, {0x06}});  // too short, were it listening
  EXPECT_TRUE(bench.pdos(0x185).empty());
  EXPECT_TRUE(bench.emergencies().empty());
  bench.tell(bench.client.nmt(0x80));
  EXPECT_EQ(bench.value({0x1000}), 0x00020192U);
  EXPECT_TRUE(bench.client.complaints.empty());
}

TEST(DeviceNmtTest, ATransferThatAStopInterruptsIsNotTakenUpAgain) {
  DriveBench bench;
  bench.tell({0x605, {0x40, 0x08, 0x10, 0, 0, 0, 0, 0}});  // by hand, the client asks nothing
  bench.client.complaints.clear();
  bench.tell(bench.client.nmt(0x02));
  bench.tell(bench.client.nmt(0x80));
  std::vector<CanFrame> frames;
  CanFrame segment;
  segment.id = 0x605;
  segment.length = 8;
  segment.data = {0x60};
  bench.node().receive(segment, bench.now_ns);
  bench.node().take(frames);
  ASSERT_EQ(frames.size(), 1U);
  EXPECT_EQ(frames[0].data, (std::array<std::uint8_t, 8>{0x80, 0, 0, 0, 0x01, 0x00, 0x04, 0x05}));
}

TEST(DeviceNmtTest, HeartbeatsKeepTheirPeriodAndStopAtZero) {
  SensorBench bench;
  bench.heartbeats();
  EXPECT_EQ(bench.write_u16({0x1017}, 50), 0U);
  bench.pass(500);
  EXPECT_EQ(bench.heartbeats().size(), 10U);
  EXPECT_EQ(bench.write_u16({0x1017}, 0), 0U);
  bench.pass(500);
  EXPECT_TRUE(bench.heartbeats().empty());
}

/// 1029h:01 and the NMT state after a lost heartbeat.
class HeartbeatLossTest : public ::testing::TestWithParam<std::pair<int, NmtState>> {};

// master  ──hb─────hb──────────(silence)──────────hb
// device                    101 ms: 8130h          0000h
TEST_P(HeartbeatLossTest, IsAnEmergencyAndWhatTheErrorBehaviourSays) {
  SensorBench bench;
  EXPECT_EQ(bench.write_u8({0x1029, 1}, GetParam().first), 0U);
  EXPECT_EQ(bench.write_u32({0x1016, 1}, 0x007F0064), 0U);
  bench.start();
  bench.pass(1000);
  EXPECT_TRUE(bench.emergencies().empty()) << "watching begins with the first heartbeat";
  bench.tell(CanopenClient::heartbeat(127));
  bench.tell(CanopenClient::heartbeat(126));  // somebody else's
  bench.pass(100);
  EXPECT_TRUE(bench.emergencies().empty());
  bench.pass(1);
  EXPECT_EQ(bench.emergencies(), (Emergencies{{0x8130, 0x11}}));
  EXPECT_EQ(bench.node().state(), GetParam().second);
  bench.pass(1000);
  EXPECT_TRUE(bench.emergencies().empty()) << "said once";
  if (GetParam().second == NmtState::kStopped) return;
  EXPECT_EQ(bench.value({0x1001}), 0x11U);
  bench.tell(CanopenClient::heartbeat(127));
  EXPECT_EQ(bench.emergencies(), (Emergencies{{0x0000, 0x00}}));
  EXPECT_EQ(bench.value({0x1001}), 0x00U);
}

INSTANTIATE_TEST_SUITE_P(Behaviours, HeartbeatLossTest,
                         ::testing::Values(std::pair(0, NmtState::kPreOperational),
                                           std::pair(1, NmtState::kOperational),
                                           std::pair(2, NmtState::kStopped)));

TEST(DeviceNmtTest, NodeGuardingDoesNotExist) {
  DriveBench bench;
  bench.start();
  bench.heartbeats();
  bench.tell({0x705, {}, true});  // a guarding request is a remote frame
  EXPECT_TRUE(bench.heartbeats().empty());
  EXPECT_EQ(bench.read_abort({0x100C}), 0x06020000U);
  EXPECT_EQ(bench.read_abort({0x100D}), 0x06020000U);
}

}  // namespace
}  // namespace tenon::sim

// PDOs of the drive: mapping step by step with each refusal, transmission types, inhibit and event
// timers, remote requests, deadlines, the SYNC counter and window, walked by the independent
// client.

#include <gtest/gtest.h>

#include "tests/sim/device_bench.h"

namespace tenon::sim {
namespace {

constexpr std::uint32_t kWrongState = 0x08000022;
constexpr std::uint32_t kNotMappable = 0x06040041;
constexpr std::uint32_t kTooLong = 0x06040042;

/// TPDO 2 with these entries, a transmission type, valid as 285h.
void map_tpdo2(DriveBench& bench, const std::vector<std::uint32_t>& entries, int type) {
  EXPECT_EQ(bench.write_u32({0x1801, 1}, 0x80000285), 0U);
  EXPECT_EQ(bench.write_u8({0x1A01, 0}, 0), 0U);
  std::uint8_t sub = 0;
  for (const std::uint32_t entry : entries) EXPECT_EQ(bench.write_u32({0x1A01, ++sub}, entry), 0U);
  EXPECT_EQ(bench.write_u8({0x1A01, 0}, sub), 0U);
  EXPECT_EQ(bench.write_u8({0x1801, 2}, type), 0U);
  EXPECT_EQ(bench.write_u32({0x1801, 1}, 0x00000285), 0U);
}

/// RPDO 2: target position, 305h.
void map_rpdo2(DriveBench& bench, int type) {
  EXPECT_EQ(bench.write_u32({0x1401, 1}, 0x80000305), 0U);
  EXPECT_EQ(bench.write_u8({0x1601, 0}, 0), 0U);
  EXPECT_EQ(bench.write_u32({0x1601, 1}, 0x607A0020), 0U);
  EXPECT_EQ(bench.write_u8({0x1601, 0}, 1), 0U);
  EXPECT_EQ(bench.write_u8({0x1401, 2}, type), 0U);
  EXPECT_EQ(bench.write_u32({0x1401, 1}, 0x00000305), 0U);
}

TEST(DevicePdoTest, TheDefaultsAreTheProfilesWords) {
  DriveBench bench;
  EXPECT_EQ(bench.value({0x1400, 1}), 0x00000205U);
  EXPECT_EQ(bench.value({0x1600, 1}), 0x60400010U);
  EXPECT_EQ(bench.value({0x1800, 1}), 0x00000185U);
  EXPECT_EQ(bench.value({0x1A00, 1}), 0x60410010U);
  for (std::uint16_t pdo = 1; pdo <= 3; ++pdo) {
    const auto rpdo = static_cast<std::uint16_t>(0x1400 + pdo);
    const auto tpdo = static_cast<std::uint16_t>(0x1800 + pdo);
    EXPECT_EQ(bench.value({rpdo, 1}), 0x80000205U + 0x100U * pdo);
    EXPECT_EQ(bench.value({tpdo, 1}), 0x80000185U + 0x100U * pdo);
  }
  bench.start();
  bench.pass(1);
  EXPECT_EQ(bench.pdos(0x185), (std::vector<Bytes>{{0x50, 0x02}})) << "on change, and first";
  bench.tell({0x205, {0x06, 0x00}});
  bench.pass(1);
  EXPECT_EQ(bench.pdos(0x185), (std::vector<Bytes>{{0x31, 0x02}}));
}

// bit 31 set ──> sub 0 = 0 ──> entries ──> sub 0 = n ──> bit 31 clear
TEST(DevicePdoTest, EachStepOfAMappingIsRefusedOutOfItsOrder) {
  DriveBench bench;
  // Valid: neither count nor entry nor identifier.
  EXPECT_EQ(bench.write_u8({0x1A00, 0}, 0), kWrongState);
  EXPECT_EQ(bench.write_u32({0x1A00, 1}, 0x60640020), kWrongState);
  EXPECT_EQ(bench.write_u32({0x1800, 1}, 0x00000186), kWrongState);
  EXPECT_EQ(bench.write_u32({0x1800, 1}, 0x00000185), 0U) << "the same is no change";
  EXPECT_EQ(bench.write_u32({0x1800, 1}, 0x40000185), 0U) << "bit 30 is no identifier";
  // Invalid, but counted: no entry.
  EXPECT_EQ(bench.write_u32({0x1800, 1}, 0x80000185), 0U);
  EXPECT_EQ(bench.write_u32({0x1A00, 1}, 0x60640020), kWrongState);
  EXPECT_EQ(bench.write_u8({0x1A00, 0}, 0), 0U);
  // Entries one by one.
  EXPECT_EQ(bench.write_u32({0x1A00, 1}, 0x60400010), kNotMappable) << "what is received";
  EXPECT_EQ(bench.write_u32({0x1A00, 1}, 0x60650020), kNotMappable) << "a setting";
  EXPECT_EQ(bench.write_u32({0x1A00, 1}, 0x10080020), kNotMappable) << "a text";
  EXPECT_EQ(bench.write_u32({0x1A00, 1}, 0x00050008), 0x06020000U) << "no dummy to send";
  EXPECT_EQ(bench.write_u32({0x1A00, 1}, 0x6FFF0010), 0x06020000U);
  EXPECT_EQ(bench.write_u32({0x1A00, 1}, 0x60640120), 0x06090011U);
  EXPECT_EQ(bench.write_u32({0x1A00, 1}, 0x60640010), 0x06070010U) << "16 bits of 32";
  EXPECT_EQ(bench.write_u32({0x1A00, 9}, 0x60640020), 0x06090011U) << "eight entries at most";
  EXPECT_EQ(bench.write_u32({0x1A00, 1}, 0x60640020), 0U);
  EXPECT_EQ(bench.write_u32({0x1A00, 2}, 0x606C0020), 0U);
  EXPECT_EQ(bench.write_u32({0x1A00, 3}, 0x60410010), 0U);
  // The count.
  EXPECT_EQ(bench.write_u8({0x1A00, 0}, 3), kTooLong) << "80 bits";
  EXPECT_EQ(bench.write_u8({0x1A00, 0}, 4), kNotMappable) << "the fourth is empty";
  EXPECT_EQ(bench.write_u8({0x1A00, 0}, 9), kTooLong);
  EXPECT_EQ(bench.write_u8({0x1A00, 0}, 2), 0U);
  // Identifiers that no PDO may take.
  for (const std::uint32_t id :
       {0x000U, 0x07FU, 0x101U, 0x180U, 0x581U, 0x601U, 0x67FU, 0x6E0U, 0x701U, 0x77FU}) {
    EXPECT_EQ(bench.write_u32({0x1800, 1}, id), 0x06090030U) << std::hex << id;
  }
  EXPECT_EQ(bench.write_u32({0x1800, 1}, 0x20000185), 0x06090030U) << "29 bits";
  EXPECT_EQ(bench.write_u32({0x1800, 1}, 0x00000195), 0U);
  EXPECT_EQ(bench.write_u8({0x1800, 2}, 1), 0U);
  bench.start();
  bench.sync();
  EXPECT_EQ(bench.pdos(0x195), (std::vector<Bytes>{Bytes(8, 0)}));
  EXPECT_TRUE(bench.pdos(0x185).empty());
}

TEST(DevicePdoTest, ReservedTransmissionTypesAreRefused) {
  DriveBench bench;
  for (const int type : {0, 1, 240, 254, 255}) EXPECT_EQ(bench.write_u8({0x1800, 2}, type), 0U);
  for (const int type : {241, 251, 252, 253}) {
    EXPECT_EQ(bench.write_u8({0x1800, 2}, type), 0x06090030U) << type;
    EXPECT_EQ(bench.write_u8({0x1400, 2}, type), 0x06090030U) << type;
  }
}

TEST(DevicePdoTest, SynchronousTypesSendWithEveryNthSync) {
  for (const int every : {1, 2, 7, 240}) {
    DriveBench bench;
    map_tpdo2(bench, {0x60410010}, every);
    bench.start();
    bench.sync(every - 1);
    EXPECT_EQ(bench.pdos(0x285).size(), 0U) << every;
    bench.sync();
    EXPECT_EQ(bench.pdos(0x285).size(), 1U) << every;
    bench.sync(3 * every);
    EXPECT_EQ(bench.pdos(0x285).size(), 3U) << every;
  }
}

TEST(DevicePdoTest, TypeZeroSendsWithTheSyncAfterAChange) {
  DriveBench bench;
  map_tpdo2(bench, {0x60410010}, 0);
  bench.start();
  bench.sync(3);
  EXPECT_EQ(bench.pdos(0x285).size(), 1U) << "the first is a change";
  bench.control(0x06);
  EXPECT_EQ(bench.pdos(0x285).size(), 0U) << "not before the SYNC";
  bench.sync(3);
  EXPECT_EQ(bench.pdos(0x285), (std::vector<Bytes>{{0x31, 0x02}}));
}

// change ──0 ms── sent ── changes ── (inhibited for 10 ms) ── sent
TEST(DevicePdoTest, EventDrivenTypesSendOnChangeNoFasterThanTheInhibitTime) {
  for (const int type : {254, 255}) {
    DriveBench bench;
    EXPECT_EQ(bench.write_u16({0x1801, 3}, 100), 0U);  // 10 ms
    map_tpdo2(bench, {0x60410010}, type);
    bench.start();
    bench.pass(1);
    EXPECT_EQ(bench.pdos(0x285).size(), 1U);
    bench.control(0x06);
    bench.control(0x07);
    bench.pass(9);
    EXPECT_EQ(bench.pdos(0x285).size(), 0U);
    bench.pass(1);
    EXPECT_EQ(bench.pdos(0x285), (std::vector<Bytes>{{0x33, 0x02}})) << "the latest, once";
    bench.pass(100);
    EXPECT_EQ(bench.pdos(0x285).size(), 0U);
  }
}

TEST(DevicePdoTest, TheEventTimerRepeatsWithoutAChange) {
  DriveBench bench;
  map_tpdo2(bench, {0x60410010}, 255);
  EXPECT_EQ(bench.write_u16({0x1801, 5}, 20), 0U);
  bench.start();
  bench.pass(101);
  EXPECT_EQ(bench.pdos(0x285).size(), 6U);  // the first and five repetitions
}

TEST(DevicePdoTest, ARemoteFrameIsAnsweredUnlessBit30ForbidsIt) {
  DriveBench bench;
  map_tpdo2(bench, {0x60410010}, 240);
  bench.tell({0x285, {}, true});
  EXPECT_EQ(bench.pdos(0x285).size(), 0U) << "not before operational";
  bench.start();
  bench.tell({0x285, {}, true});
  EXPECT_EQ(bench.pdos(0x285), (std::vector<Bytes>{{0x50, 0x02}}));
  EXPECT_EQ(bench.write_u32({0x1801, 1}, 0x40000285), 0U);
  bench.tell({0x285, {}, true});
  EXPECT_EQ(bench.pdos(0x285).size(), 0U);
  bench.tell({0x305, {}, true});
  EXPECT_TRUE(bench.emergencies().empty()) << "a remote frame is no RPDO";
}

TEST(DevicePdoTest, ASynchronousTargetActsWithTheNextSyncAndAnEventDrivenOneAtOnce) {
  DriveBench bench;
  map_rpdo2(bench, 1);
  bench.start();
  bench.tell({0x305, {0x10, 0x27, 0, 0}});
  EXPECT_EQ(bench.value({0x607A}), 0U);
  bench.sync();
  EXPECT_EQ(bench.value({0x607A}), 10000U);
  EXPECT_EQ(bench.write_u8({0x1401, 2}, 255), 0U);
  bench.tell({0x305, {0x11, 0x27, 0, 0}});
  EXPECT_EQ(bench.value({0x607A}), 10001U);
}

TEST(DevicePdoTest, AShortPdoIsIgnoredAndSaidOnceUntilAGoodOneOfTheSameComes) {
  DriveBench bench;
  map_rpdo2(bench, 255);
  bench.start();
  bench.tell({0x305, {1, 2, 3}});
  EXPECT_EQ(bench.emergencies(), (Emergencies{{0x8210, 0x11}}));
  bench.tell({0x305, {}});
  bench.tell({0x205, {0x06, 0x00}});  // the other RPDO is good, this one still is not
  EXPECT_TRUE(bench.emergencies().empty());
  EXPECT_EQ(bench.value({0x607A}), 0U);
  EXPECT_EQ(bench.value({0x1001}), 0x11U);
  bench.tell({0x305, {1, 0, 0, 0, 9, 9}});  // longer than mapped: the first four count
  EXPECT_EQ(bench.emergencies(), (Emergencies{{0x0000, 0x00}}));
  EXPECT_EQ(bench.value({0x607A}), 1U);
}

// RPDO ──10 ms── RPDO ──────────(none)────────── RPDO
//                        21 ms: 8250h, 6007h      0000h
TEST(DevicePdoTest, AnRpdoThatMissesItsDeadlineIsAnEmergencyAndALostMaster) {
  DriveBench bench;
  bench.configure();
  EXPECT_EQ(bench.write_u16({0x6007}, 3), 0U);
  map_rpdo2(bench, 1);
  EXPECT_EQ(bench.write_u16({0x1401, 5}, 20), 0U);
  bench.enable();
  bench.pass(100);
  EXPECT_TRUE(bench.emergencies().empty()) << "watching begins with the first";
  bench.tell({0x305, {0, 0, 0, 0}});
  bench.pass(20);
  EXPECT_TRUE(bench.emergencies().empty());
  bench.pass(1);
  EXPECT_EQ(bench.emergencies(), (Emergencies{{0x8250, 0x11}}));
  EXPECT_EQ(bench.long_state(), 0x07) << "quick stop by 6007h";
  bench.pass(100);
  EXPECT_EQ(bench.short_state(), 0x40);
  EXPECT_TRUE(bench.emergencies().empty());
  bench.tell({0x305, {0, 0, 0, 0}});
  bench.pass(1);
  EXPECT_EQ(bench.emergencies(), (Emergencies{{0x0000, 0x00}}));
}

// 1007h = 1 ms:  SYNC ── 0.5 ms: taken ── SYNC ── 1.5 ms: dropped ── SYNC
TEST(DevicePdoTest, ASynchronousRpdoOutsideTheSyncWindowIsDropped) {
  DriveBench bench;
  EXPECT_EQ(bench.write_u32({0x1007}, 1000), 0U);
  map_rpdo2(bench, 1);
  bench.start();
  bench.sync();
  bench.pass(0.5);
  bench.tell({0x305, {1, 0, 0, 0}});
  bench.pass(1.5);
  bench.sync();
  EXPECT_EQ(bench.value({0x607A}), 1U);
  bench.pass(1.5);
  bench.tell({0x305, {2, 0, 0, 0}});
  bench.sync();
  EXPECT_EQ(bench.value({0x607A}), 1U);
}

TEST(DevicePdoTest, ACountedSyncStartsAPdoAtItsStartValue) {
  DriveBench bench;
  EXPECT_EQ(bench.write_u8({0x1019}, 4), 0U);
  EXPECT_EQ(bench.write_u8({0x1801, 6}, 241), 0x06090031U);
  EXPECT_EQ(bench.write_u8({0x1801, 6}, 3), 0U);
  map_tpdo2(bench, {0x60410010}, 2);
  EXPECT_EQ(bench.write_u8({0x1801, 6}, 2), kWrongState) << "the PDO is valid";
  bench.start();
  std::vector<std::uint8_t> with;
  for (std::uint8_t i = 0; i < 12; ++i) {
    const auto counter = static_cast<std::uint8_t>(i % 4 + 1);
    bench.tell(CanopenClient::sync(counter));
    if (!bench.pdos(0x285).empty()) with.push_back(counter);
  }
  // 3 counts as the first, so 4 is the second of two, then every other.
  EXPECT_EQ(with, (std::vector<std::uint8_t>{4, 2, 4, 2, 4}));
}

TEST(DevicePdoTest, ASyncOfTheWrongLengthIsAnEmergencyAndNoSync) {
  DriveBench bench;
  map_tpdo2(bench, {0x60410010}, 1);
  bench.start();
  bench.tell(CanopenClient::sync(1));
  EXPECT_EQ(bench.emergencies(), (Emergencies{{0x8240, 0x11}}));
  EXPECT_TRUE(bench.pdos(0x285).empty());
  bench.sync();
  EXPECT_EQ(bench.emergencies(), (Emergencies{{0x0000, 0x00}}));
  EXPECT_EQ(bench.pdos(0x285).size(), 1U);
}

TEST(DevicePdoTest, TheSyncMayHaveAnotherIdentifier) {
  DriveBench bench;
  map_tpdo2(bench, {0x60410010}, 1);
  EXPECT_EQ(bench.write_u32({0x1005}, 0x601), 0x06090030U);
  EXPECT_EQ(bench.write_u32({0x1005}, 0x090), 0U);
  bench.start();
  bench.sync();
  EXPECT_TRUE(bench.pdos(0x285).empty());
  bench.tell({0x090, {}});
  EXPECT_EQ(bench.pdos(0x285).size(), 1U);
}

TEST(DevicePdoTest, DummyEntriesLeaveRoomForAnotherDrivesTarget) {
  DriveBench bench;
  EXPECT_EQ(bench.write_u8({0x1601, 0}, 0), 0U);
  EXPECT_EQ(bench.write_u32({0x1601, 1}, 0x00040010), 0x06070010U) << "a dummy has its length";
  EXPECT_EQ(bench.write_u32({0x1601, 1}, 0x00040020), 0U);
  EXPECT_EQ(bench.write_u32({0x1601, 2}, 0x607A0020), 0U);
  EXPECT_EQ(bench.write_u8({0x1601, 0}, 2), 0U);
  EXPECT_EQ(bench.write_u32({0x1401, 1}, 0x00000300), 0U);
  bench.start();
  bench.tell({0x300, {0xFF, 0xFF, 0xFF, 0xFF, 0xFE, 0xFF, 0xFF, 0xFF}});
  EXPECT_EQ(bench.signed_value({0x607A}), -2);
}

}  // namespace
}  // namespace tenon::sim

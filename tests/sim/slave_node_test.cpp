// A slave node, frame by frame: NMT, heartbeats, PDO mapping and the instant at which a PDO acts.

#include "sim/cell/canopen/slave_node.h"

#include <gtest/gtest.h>

#include "tests/sim/literal_client.h"

namespace tenon::sim {
namespace {

using Texts = std::vector<std::string>;
constexpr std::int64_t kMillisecond = 1'000'000;

/// A device of two objects: 2100h i32 that it receives, 2101h u16 that it sends.
class PlainDevice final : public NodeApplication {
 public:
  PlainDevice() {
    using enum DataType;
    node.dictionary().add(
        object_id(0x2100),
        {.type = kI32, .access = Access::kReadWrite, .mappable = Mappable::kReceive});
    node.dictionary().add(object_id(0x2101), {.type = kU16, .mappable = Mappable::kTransmit});
    node.dictionary().add(object_id(0x2102), {.type = kU8, .access = Access::kReadWrite});
    node.power_on(0);
  }

  void on_reset(std::int64_t /*now_ns*/) override { ++resets; }
  void on_sample() override {}
  void on_sync() override { seen_at_sync.push_back(node.dictionary().value(object_id(0x2100))); }
  void on_connection_lost() override { ++connections_lost; }

  /// What the node says to a frame at a time.
  Texts tell(const CanFrame& frame, std::int64_t now_ns = 0) {
    node.receive(frame, now_ns);
    return said();
  }
  Texts said() {
    std::vector<CanFrame> frames;
    node.take(frames);
    return texts_of(frames);
  }
  Texts at(std::int64_t now_ns) {
    node.advance(now_ns);
    return said();
  }
  /// The abort code of a write, "" where it was accepted.
  std::string write(int index, int sub, std::uint32_t value, int command) {
    const Texts answer = tell(
        frame_of(0x605, {command, index & 0xFF, index >> 8, sub, static_cast<int>(value & 0xFF),
                         static_cast<int>(value >> 8 & 0xFF), static_cast<int>(value >> 16 & 0xFF),
                         static_cast<int>(value >> 24 & 0xFF)}));
    return answer.back().substr(4, 2) == "60" ? "" : answer.back().substr(12);
  }
  std::string write_u8(int index, int sub, std::uint32_t value) {
    return write(index, sub, value, 0x2F);
  }
  std::string write_u32(int index, int sub, std::uint32_t value) {
    return write(index, sub, value, 0x23);
  }
  void map_receive_pdo(std::uint8_t transmission_type) {
    EXPECT_EQ(write_u32(0x1400, 1, 0x80000205), "");
    EXPECT_EQ(write_u8(0x1600, 0, 0), "");
    EXPECT_EQ(write_u32(0x1600, 1, 0x21000020), "");
    EXPECT_EQ(write_u8(0x1600, 0, 1), "");
    EXPECT_EQ(write_u8(0x1400, 2, transmission_type), "");
    EXPECT_EQ(write_u32(0x1400, 1, 0x00000205), "");
  }
  void start() { EXPECT_EQ(tell(frame_of(0x000, {0x01, 0x05})), Texts{}); }

  SlaveNode node{{.node = 5,
                  .name = "plain",
                  .receive_pdos = {{0x80000205, 255, {}}},
                  .transmit_pdos = {{0x00000185, 1, {0x21010010}}}},
                 *this};
  int resets = 0;
  int connections_lost = 0;
  std::vector<std::int64_t> seen_at_sync;
};

const CanFrame kSyncFrame = frame_of(0x080, {});

TEST(SlaveNodeTest, BootsUpIntoPreOperational) {
  PlainDevice device;
  EXPECT_EQ(device.said(), Texts{"705#00"});
  EXPECT_EQ(device.node.state(), NmtState::kPreOperational);
  EXPECT_EQ(device.resets, 1);
}

TEST(SlaveNodeTest, ObeysNmtForItselfAndForAll) {
  PlainDevice device;
  static_cast<void>(device.said());
  device.tell(frame_of(0x000, {0x01, 0x06}));
  EXPECT_EQ(device.node.state(), NmtState::kPreOperational);
  device.tell(frame_of(0x000, {0x01, 0x05}));
  EXPECT_EQ(device.node.state(), NmtState::kOperational);
  device.tell(frame_of(0x000, {0x80, 0x00}));
  EXPECT_EQ(device.node.state(), NmtState::kPreOperational);
  device.tell(frame_of(0x000, {0x02, 0x05}));
  EXPECT_EQ(device.node.state(), NmtState::kStopped);
  EXPECT_EQ(device.connections_lost, 1);
  // Stopped: no SDO.
  EXPECT_EQ(device.tell(frame_of(0x605, {0x40, 0x00, 0x10, 0, 0, 0, 0, 0})), Texts{});
  EXPECT_EQ(device.tell(frame_of(0x000, {0x82, 0x05})), Texts{"705#00"});
  EXPECT_EQ(device.resets, 1);
  EXPECT_EQ(device.tell(frame_of(0x000, {0x81, 0x05})), Texts{"705#00"});
  EXPECT_EQ(device.resets, 2);
}

TEST(SlaveNodeTest, AResetRestoresTheDefaults) {
  PlainDevice device;
  device.map_receive_pdo(1);
  EXPECT_EQ(device.write_u32(0x2100, 0, 7), "");
  device.tell(frame_of(0x000, {0x82, 0x05}));
  EXPECT_EQ(device.node.dictionary().value(object_id(0x1400, 1)), 0x80000205);
  EXPECT_EQ(device.node.dictionary().value(object_id(0x2100)), 7);
  device.tell(frame_of(0x000, {0x81, 0x05}));
  EXPECT_EQ(device.node.dictionary().value(object_id(0x2100)), 0);
}

TEST(SlaveNodeTest, ProducesHeartbeatsWithItsState) {
  PlainDevice device;
  static_cast<void>(device.said());
  EXPECT_EQ(device.at(1 * kMillisecond), Texts{});
  EXPECT_EQ(device.write(0x1017, 0, 100, 0x2B), "");
  EXPECT_EQ(device.at(2 * kMillisecond), Texts{"705#7F"});
  EXPECT_EQ(device.at(101 * kMillisecond), Texts{});
  device.start();
  EXPECT_EQ(device.at(102 * kMillisecond), Texts{"705#05"});
  EXPECT_EQ(device.at(202 * kMillisecond), Texts{"705#05"});
}

// master   ──hb(0)────hb(250)──────────────────────(silence)
// device                                  551 ms: EMCY 8130h, pre-operational
TEST(SlaveNodeTest, AWatchedHeartbeatThatStopsIsAnEmergencyAndEndsOperational) {
  PlainDevice device;
  static_cast<void>(device.said());
  EXPECT_EQ(device.write_u32(0x1016, 1, 0x007F012C), "");
  device.start();
  // Watching starts with the first heartbeat.
  EXPECT_EQ(device.at(10'000 * kMillisecond), (Texts{}));
  device.tell(frame_of(0x77F, {0x05}), 10'000 * kMillisecond);
  device.tell(frame_of(0x77F, {0x05}), 10'250 * kMillisecond);
  EXPECT_EQ(device.at(10'550 * kMillisecond), Texts{});
  EXPECT_EQ(device.at(10'551 * kMillisecond), Texts{"085#3081110000000000"});
  EXPECT_EQ(device.node.state(), NmtState::kPreOperational);
  EXPECT_EQ(device.connections_lost, 1);
  EXPECT_EQ(device.at(20'000 * kMillisecond), Texts{});
  // It is back: the error is taken back.
  EXPECT_EQ(device.tell(frame_of(0x77F, {0x05}), 20'001 * kMillisecond),
            Texts{"085#0000000000000000"});
}

TEST(SlaveNodeTest, AMappingChangesOnlyInTheStandardsOrder) {
  PlainDevice device;
  const std::string wrong_state = "22000008";
  // TPDO1 is valid: neither count nor identifier may change.
  EXPECT_EQ(device.write_u8(0x1A00, 0, 0), wrong_state);
  EXPECT_EQ(device.write_u32(0x1800, 1, 0x00000186), wrong_state);
  EXPECT_EQ(device.write_u32(0x1800, 1, 0x80000185), "");
  // Invalid now, but its entries are counted.
  EXPECT_EQ(device.write_u32(0x1A00, 1, 0x21010010), wrong_state);
  EXPECT_EQ(device.write_u8(0x1A00, 0, 0), "");
  EXPECT_EQ(device.write_u32(0x1A00, 1, 0x21000020), "41000406");  // received, not sent
  EXPECT_EQ(device.write_u32(0x1A00, 1, 0x21020008), "41000406");  // not mappable
  EXPECT_EQ(device.write_u32(0x1A00, 1, 0x60FF0010), "00000206");  // no object
  EXPECT_EQ(device.write_u32(0x1A00, 1, 0x21010110), "11000906");  // no sub-index
  EXPECT_EQ(device.write_u32(0x1A00, 1, 0x21010008), "10000706");  // wrong length
  for (int sub = 1; sub <= 5; ++sub) EXPECT_EQ(device.write_u32(0x1A00, sub, 0x21010010), "");
  EXPECT_EQ(device.write_u8(0x1A00, 0, 5), "42000406");  // 80 bits
  EXPECT_EQ(device.write_u8(0x1A00, 0, 6), "41000406");  // an empty entry
  EXPECT_EQ(device.write_u8(0x1A00, 0, 4), "");
  EXPECT_EQ(device.write_u8(0x1800, 2, 241), "30000906");          // reserved type
  EXPECT_EQ(device.write_u32(0x1800, 1, 0x00000601), "30000906");  // an SDO's identifier
  EXPECT_EQ(device.write_u32(0x1800, 1, 0x00000186), "");
  device.start();
  static_cast<void>(device.said());
  EXPECT_EQ(device.tell(kSyncFrame), Texts{"186#0000000000000000"});
}

// SYNC            RPDO 7         SYNC          SYNC
// sees 0          waits          sees 7
TEST(SlaveNodeTest, ASynchronousPdoActsOnTheNextSync) {
  PlainDevice device;
  device.map_receive_pdo(1);
  device.start();
  device.tell(kSyncFrame);
  device.tell(frame_of(0x205, {7, 0, 0, 0}));
  EXPECT_EQ(device.node.dictionary().value(object_id(0x2100)), 0);
  device.tell(kSyncFrame);
  EXPECT_EQ(device.seen_at_sync, (std::vector<std::int64_t>{0, 7}));
}

TEST(SlaveNodeTest, AnEventDrivenPdoActsAtOnce) {
  PlainDevice device;
  device.map_receive_pdo(255);
  device.start();
  device.tell(frame_of(0x205, {0xFE, 0xFF, 0xFF, 0xFF}));
  EXPECT_EQ(device.node.dictionary().value(object_id(0x2100)), -2);
}

TEST(SlaveNodeTest, APdoOutsideOperationalIsIgnored) {
  PlainDevice device;
  device.map_receive_pdo(255);
  device.tell(frame_of(0x205, {7, 0, 0, 0}));
  EXPECT_EQ(device.node.dictionary().value(object_id(0x2100)), 0);
  static_cast<void>(device.said());
  EXPECT_EQ(device.tell(kSyncFrame), Texts{});
}

TEST(SlaveNodeTest, AShortPdoIsIgnoredAndReportedOnce) {
  PlainDevice device;
  device.map_receive_pdo(255);
  device.start();
  EXPECT_EQ(device.tell(frame_of(0x205, {7, 0, 0})), Texts{"085#1082110000000000"});
  EXPECT_EQ(device.tell(frame_of(0x205, {7, 0, 0})), Texts{});
  EXPECT_EQ(device.node.dictionary().value(object_id(0x2100)), 0);
  EXPECT_EQ(device.tell(frame_of(0x205, {7, 0, 0, 0})), Texts{"085#0000000000000000"});
  EXPECT_EQ(device.node.dictionary().value(object_id(0x2100)), 7);
}

TEST(SlaveNodeTest, ADummyEntrySkipsItsBits) {
  PlainDevice device;
  EXPECT_EQ(device.write_u8(0x1600, 0, 0), "");
  EXPECT_EQ(device.write_u32(0x1600, 1, 0x00040020), "");
  EXPECT_EQ(device.write_u32(0x1600, 2, 0x21000020), "");
  EXPECT_EQ(device.write_u8(0x1600, 0, 2), "");
  EXPECT_EQ(device.write_u32(0x1400, 1, 0x00000301), "");
  device.start();
  device.tell(frame_of(0x301, {1, 1, 1, 1, 9, 0, 0, 0}));
  EXPECT_EQ(device.node.dictionary().value(object_id(0x2100)), 9);
}

TEST(SlaveNodeTest, ATransmitPdoComesWithEveryNthSync) {
  PlainDevice device;
  device.node.dictionary().set(object_id(0x2101), 0x1234);
  EXPECT_EQ(device.write_u8(0x1800, 2, 3), "");
  device.start();
  EXPECT_EQ(device.tell(kSyncFrame), Texts{});
  EXPECT_EQ(device.tell(kSyncFrame), Texts{});
  EXPECT_EQ(device.tell(kSyncFrame), Texts{"185#3412"});
  EXPECT_EQ(device.tell(kSyncFrame), Texts{});
}

TEST(SlaveNodeTest, AnEventDrivenTransmitPdoComesOnChangeAndByItsTimer) {
  PlainDevice device;
  EXPECT_EQ(device.write_u8(0x1800, 2, 255), "");
  EXPECT_EQ(device.write(0x1800, 5, 50, 0x2B), "");
  device.start();
  static_cast<void>(device.said());
  EXPECT_EQ(device.at(1 * kMillisecond), Texts{"185#0000"});
  EXPECT_EQ(device.at(2 * kMillisecond), Texts{});
  device.node.dictionary().set(object_id(0x2101), 1);
  EXPECT_EQ(device.at(3 * kMillisecond), Texts{"185#0100"});
  EXPECT_EQ(device.at(52 * kMillisecond), Texts{});
  EXPECT_EQ(device.at(53 * kMillisecond), Texts{"185#0100"});
}

}  // namespace
}  // namespace tenon::sim

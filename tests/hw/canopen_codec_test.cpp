// Every frame of the master against literal bytes of CiA 301.

#include <gtest/gtest.h>

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "hw/canopen/emergency.h"
#include "hw/canopen/heartbeat.h"
#include "hw/canopen/heartbeat_watch.h"
#include "hw/canopen/nmt.h"
#include "hw/canopen/object_value.h"
#include "hw/canopen/pdo.h"
#include "hw/canopen/sdo.h"
#include "hw/canopen/sdo_client.h"
#include "hw/canopen/sync.h"
#include "shared/base/error.h"

namespace tenon::hw::canopen {
namespace {

/// A frame out of "601#4041600000000000".
CanFrame golden(const std::string& text) {
  CanFrame frame;
  frame.id = static_cast<std::uint32_t>(std::stoul(text.substr(0, 3), nullptr, 16));
  for (std::size_t at = 4; at < text.size(); at += 2) {
    frame.data[frame.length++] =
        static_cast<std::uint8_t>(std::stoul(text.substr(at, 2), nullptr, 16));
  }
  return frame;
}

TEST(Nmt, CommandsAreTheLiteralFrames) {
  EXPECT_EQ(nmt_frame(0x01, 3), golden("000#0103"));
  EXPECT_EQ(nmt_frame(0x02, 3), golden("000#0203"));
  EXPECT_EQ(nmt_frame(0x80, 0), golden("000#8000"));
  EXPECT_EQ(nmt_frame(0x81, 127), golden("000#817F"));
  EXPECT_EQ(nmt_frame(0x82, 1), golden("000#8201"));
}

TEST(Sync, HasNoData) { EXPECT_EQ(sync_frame(), golden("080#")); }

TEST(HeartbeatCodec, RoundTripsAndRefusesOthers) {
  EXPECT_EQ(heartbeat_frame({127, 0x05}), golden("77F#05"));
  EXPECT_EQ(decode_heartbeat(golden("703#00")), (Heartbeat{3, 0x00}));
  EXPECT_EQ(decode_heartbeat(golden("704#7F")), (Heartbeat{4, 0x7F}));
  EXPECT_FALSE(decode_heartbeat(golden("700#05")));
  EXPECT_FALSE(decode_heartbeat(golden("780#05")));
  EXPECT_FALSE(decode_heartbeat(golden("703#0500")));
  CanFrame extended = golden("703#05");
  extended.extended = true;
  EXPECT_FALSE(decode_heartbeat(extended));
}

TEST(HeartbeatWatch, NamesTheNodeThatIsSilentForTooLong) {
  HeartbeatWatch watch;
  watch.add(1);
  watch.add(2);
  watch.restart(1000);
  EXPECT_EQ(watch.state(1), HeartbeatWatch::kNotSeen);
  EXPECT_TRUE(watch.process({1, 0x05}, 1200));
  EXPECT_FALSE(watch.process({9, 0x05}, 1200));
  EXPECT_FALSE(watch.silent(1300, 300));
  EXPECT_EQ(watch.silent(1301, 300), std::uint8_t{2});
  EXPECT_EQ(watch.state(1), 0x05);
}

TEST(EmergencyCodec, DecodesCodeRegisterAndVendorBytes) {
  const auto emergency = decode_emergency(golden("083#118620AABBCCDDEE"));
  ASSERT_TRUE(emergency);
  EXPECT_EQ(emergency->node, 3);
  EXPECT_EQ(emergency->code, 0x8611);
  EXPECT_EQ(emergency->error_register, 0x20);
  EXPECT_EQ(emergency->vendor, (std::array<std::uint8_t, 5>{0xAA, 0xBB, 0xCC, 0xDD, 0xEE}));
  EXPECT_FALSE(is_warning(*emergency));
  EXPECT_STREQ(emergency_text(0x8611), "following error");
}

TEST(EmergencyCodec, ACodeThatNoStandardNamesGetsNoWords) {
  EXPECT_STREQ(emergency_text(0x3210), "DC link over-voltage");
  EXPECT_STREQ(emergency_text(0x8240), "SYNC of wrong length");
  EXPECT_EQ(emergency_text(0x3299), nullptr);
  EXPECT_EQ(emergency_text(0x8699), nullptr);
  EXPECT_EQ(emergency_text(0xFF01), nullptr);
}

TEST(EmergencyCodec, SyncAndShortFramesAreNone) {
  EXPECT_FALSE(decode_emergency(golden("080#1186200000000000")));
  EXPECT_FALSE(decode_emergency(golden("083#118620")));
  EXPECT_FALSE(decode_emergency(golden("100#1186200000000000")));
}

TEST(EmergencyCodec, LostFramesAndTheEndOfAnErrorAreWarnings) {
  EXPECT_TRUE(is_warning(*decode_emergency(golden("081#0000000000000000"))));
  EXPECT_TRUE(is_warning(*decode_emergency(golden("081#1081110000000000"))));
  EXPECT_TRUE(is_warning(*decode_emergency(golden("081#2081110000000000"))));
  EXPECT_FALSE(is_warning(*decode_emergency(golden("081#3081110000000000"))));
}

TEST(SdoFrames, AreTheLiteralBytes) {
  const std::vector<std::uint8_t> data{0x64, 0x00, 0x01, 0x02};
  const std::span<const std::uint8_t> bytes(data);
  const SdoAddress producer{1, 0x1017, 0};
  EXPECT_EQ(sdo_download_expedited({1, 0x6060, 0}, std::vector<std::uint8_t>{8}),
            golden("601#2F60600008000000"));
  EXPECT_EQ(sdo_download_expedited(producer, bytes.first(2)), golden("601#2B17100064000000"));
  EXPECT_EQ(sdo_download_expedited(producer, bytes.first(3)), golden("601#2717100064000100"));
  EXPECT_EQ(sdo_download_expedited({5, 0x1016, 1}, bytes), golden("605#2316100164000102"));
  EXPECT_EQ(sdo_download_segmented({2, 0x1008, 0}, 10), golden("602#210810000A000000"));
  EXPECT_EQ(sdo_download_segment(2, false, false, std::vector<std::uint8_t>(7, 0x41)),
            golden("602#0041414141414141"));
  EXPECT_EQ(sdo_download_segment(2, true, true, std::vector<std::uint8_t>(3, 0x42)),
            golden("602#1942424200000000"));
  EXPECT_EQ(sdo_upload({3, 0x6041, 0}), golden("603#4041600000000000"));
  EXPECT_EQ(sdo_upload_segment(3, false), golden("603#6000000000000000"));
  EXPECT_EQ(sdo_upload_segment(3, true), golden("603#7000000000000000"));
  EXPECT_EQ(sdo_abort({3, 0x6041, 2}, 0x05040000), golden("603#8041600200000405"));
}

using State = SdoClient::State;

TEST(SdoClient, ExpeditedUploadOfEachSize) {
  const std::vector<std::pair<std::string, std::vector<std::uint8_t>>> answers{
      {"583#4F41600011223344", {0x11}},
      {"583#4B41600011223344", {0x11, 0x22}},
      {"583#4741600011223344", {0x11, 0x22, 0x33}},
      {"583#4341600011223344", {0x11, 0x22, 0x33, 0x44}},
      {"583#4241600011223344", {0x11, 0x22, 0x33, 0x44}}};
  for (const auto& [answer, expected] : answers) {
    SdoClient client;
    EXPECT_EQ(client.start_upload({3, 0x6041, 0}, 0), golden("603#4041600000000000"));
    EXPECT_FALSE(client.process(golden(answer), 0));
    EXPECT_EQ(client.state(), State::kDone);
    EXPECT_EQ(std::vector<std::uint8_t>(client.data().begin(), client.data().end()), expected);
  }
}

TEST(SdoClient, SegmentedUploadAlternatesTheToggle) {
  SdoClient client;
  EXPECT_EQ(client.start_upload({4, 0x1008, 0}, 0), golden("604#4008100000000000"));
  EXPECT_EQ(client.process(golden("584#4108100009000000"), 0), golden("604#6000000000000000"));
  EXPECT_EQ(client.process(golden("584#0047616E74727920"), 0), golden("604#7000000000000000"));
  EXPECT_FALSE(client.process(golden("584#1B33210000000000"), 0));  // last, 2 bytes
  EXPECT_EQ(client.state(), State::kDone);
  EXPECT_EQ(std::string(client.data().begin(), client.data().end()), "Gantry 3!");
}

TEST(SdoClient, SegmentedDownloadCarriesSevenBytesASegment) {
  SdoClient client;
  const std::string name = "tenon-arm";
  const std::vector<std::uint8_t> bytes(name.begin(), name.end());
  EXPECT_EQ(client.start_download({2, 0x1008, 0}, bytes, 0), golden("602#2108100009000000"));
  EXPECT_EQ(client.process(golden("582#6008100000000000"), 0), golden("602#0074656E6F6E2D61"));
  EXPECT_EQ(client.process(golden("582#2000000000000000"), 0), golden("602#1B726D0000000000"));
  EXPECT_FALSE(client.process(golden("582#3000000000000000"), 0));
  EXPECT_EQ(client.state(), State::kDone);
}

TEST(SdoClient, WrongToggleIsAborted) {
  SdoClient client;
  (void)client.start_upload({4, 0x1008, 0}, 0);
  (void)client.process(golden("584#4108100009000000"), 0);
  EXPECT_EQ(client.process(golden("584#1047616E74727920"), 0), golden("604#8008100000000305"));
  EXPECT_EQ(client.state(), State::kAborted);
  EXPECT_EQ(client.abort_code(), 0x05030000u);
}

TEST(SdoClient, AbortOfTheNodeIsKept) {
  SdoClient client;
  (void)client.start_download({1, 0x6060, 0}, std::vector<std::uint8_t>{9}, 0);
  EXPECT_FALSE(client.process(golden("581#8060600030000906"), 0));
  EXPECT_EQ(client.state(), State::kAborted);
  EXPECT_EQ(client.abort_code(), 0x06090030u);
  EXPECT_STREQ(sdo_abort_text(client.abort_code()), "value out of range");
}

TEST(SdoClient, AnswersThatAreNotItsOwnAreIgnored) {
  SdoClient client;
  (void)client.start_upload({3, 0x6041, 0}, 0);
  for (const char* other : {"584#4B41600011220000", "583#4B42600011220000", "583#4B41600111220000",
                            "583#4B41600011", "603#4B41600011220000"}) {
    EXPECT_FALSE(client.process(golden(other), 0)) << other;
    EXPECT_EQ(client.state(), State::kBusy) << other;
  }
}

TEST(SdoClient, SilenceEndsInTimeoutAndAnAbort) {
  SdoClient client(1000);
  (void)client.start_upload({3, 0x6041, 0}, 5000);
  EXPECT_FALSE(client.update(5999));
  EXPECT_EQ(client.update(6000), golden("603#8041600000000405"));
  EXPECT_EQ(client.state(), State::kTimedOut);
}

// It would renew the time for an answer for ever.
TEST(SdoClient, AnEmptySegmentThatIsNotTheLastIsAborted) {
  SdoClient client;
  (void)client.start_upload({4, 0x1018, 1}, 0);
  (void)client.process(golden("584#4118100104000000"), 0);
  EXPECT_EQ(client.process(golden("584#0E00000000000000"), 0), golden("604#8018100101000405"));
  EXPECT_EQ(client.state(), State::kAborted);
  EXPECT_EQ(client.abort_code(), 0x05040001u);

  // The last one may be: an object without bytes.
  (void)client.start_upload({4, 0x1008, 0}, 0);
  (void)client.process(golden("584#4108100000000000"), 0);
  EXPECT_FALSE(client.process(golden("584#0F00000000000000"), 0));
  EXPECT_EQ(client.state(), State::kDone);
  EXPECT_EQ(client.data().size(), 0U);
}

//  request 0 -> answers of one byte each, every 999 ns, each in time -> 10000: silence
TEST(SdoClient, ATransferThatTricklesEndsInTimeout) {
  SdoClient client(1000);
  (void)client.start_upload({4, 0x1008, 0}, 0);
  (void)client.process(golden("584#4108100000040000"), 0);
  std::int64_t now_ns = 0;
  for (bool toggle = false; client.state() == State::kBusy && now_ns < 100'000; toggle = !toggle) {
    now_ns += 999;
    if (client.update(now_ns)) break;
    (void)client.process(golden(toggle ? "584#1C41000000000000" : "584#0C41000000000000"), now_ns);
  }
  EXPECT_EQ(client.state(), State::kTimedOut);
  EXPECT_EQ(now_ns, 10'989);  // the first look after the bound
}

TEST(SdoClient, UploadThatNeverEndsIsAborted) {
  SdoClient client;
  (void)client.start_upload({4, 0x1008, 0}, 0);
  (void)client.process(golden("584#4108100009000000"), 0);
  bool toggle = false;
  for (int i = 0; i < 1000 && client.state() == State::kBusy; ++i, toggle = !toggle) {
    (void)client.process(golden(toggle ? "584#1041414141414141" : "584#0041414141414141"), 0);
  }
  EXPECT_EQ(client.state(), State::kAborted);
  EXPECT_EQ(client.abort_code(), 0x05040005u);
}

TEST(PdoConfiguration, LooksSwitchesOffMapsAndSwitchesOnInThisOrder) {
  using Action = ObjectSetting::Action;
  std::vector<ObjectSetting> settings;
  append_pdo(settings, {PdoConfiguration::Direction::kTransmit,
                        1,
                        0x190,
                        kEverySync,
                        {{0x6041, 0, 16}, {0x6064, 0, 32}, {0x6077, 0, 16}}});
  struct Expected {
    Action action;
    std::uint32_t object;
    std::uint32_t value;
  };
  const std::vector<Expected> expected{{Action::kCompare, 0x1A0000, 3},
                                       {Action::kCompare, 0x1A0001, 0x60410010},
                                       {Action::kCompare, 0x1A0002, 0x60640020},
                                       {Action::kCompare, 0x1A0003, 0x60770010},
                                       {Action::kWrite, 0x180001, 0xC0000190},
                                       {Action::kWrite, 0x180002, 1},
                                       {Action::kWriteIfOther, 0x1A0000, 0},
                                       {Action::kWriteIfOther, 0x1A0001, 0x60410010},
                                       {Action::kWriteIfOther, 0x1A0002, 0x60640020},
                                       {Action::kWriteIfOther, 0x1A0003, 0x60770010},
                                       {Action::kWriteIfOther, 0x1A0000, 3},
                                       {Action::kWrite, 0x180001, 0x40000190}};
  ASSERT_EQ(settings.size(), expected.size());
  for (std::size_t i = 0; i < expected.size(); ++i) {
    EXPECT_EQ(settings[i].action, expected[i].action) << i;
    EXPECT_EQ(settings[i].object(), expected[i].object) << i;
    EXPECT_EQ(settings[i].value, expected[i].value) << i;
  }
}

TEST(ObjectValue, BytesOfEachType) {
  using Bytes = std::vector<std::uint8_t>;
  EXPECT_EQ(object_bytes("u16", "0x1234"), (Bytes{0x34, 0x12}));
  EXPECT_EQ(object_bytes("i8", "-1"), (Bytes{0xFF}));
  EXPECT_EQ(object_bytes("i32", "-2"), (Bytes{0xFE, 0xFF, 0xFF, 0xFF}));
  EXPECT_EQ(object_bytes("str", "ab"), (Bytes{0x61, 0x62}));
  EXPECT_THROW((void)object_bytes("u8", "256"), InputError);
  EXPECT_THROW((void)object_bytes("u8", "-1"), InputError);
  EXPECT_THROW((void)object_bytes("u8", "1x"), InputError);
  EXPECT_THROW((void)object_bytes("float", "1"), InputError);
  EXPECT_EQ(object_text(Bytes{0xFF, 0xFF}), "0xFFFF = 65535 or -1 (2 bytes)");
  EXPECT_EQ(object_text(Bytes{'T', 'e', 'n', 'o', 'n'}), "\"Tenon\"");
}

}  // namespace
}  // namespace tenon::hw::canopen

// Serial adapters over a pty, what opens a bus and what refuses to, the kernel's error frames, and
// the log of what passed. Bounded waits, no assertion on time.

#include <fcntl.h>
#include <gtest/gtest.h>
#include <linux/can/error.h>
#include <stdlib.h>
#include <unistd.h>

#include <array>
#include <fstream>
#include <memory>
#include <sstream>
#include <string>

#include "hw/can/candump_log.h"
#include "hw/can/endpoints.h"
#include "hw/can/open_bus.h"
#include "hw/can/recording_bus.h"
#include "hw/can/slcan_stream.h"
#include "hw/can/socketcan_errors.h"
#include "shared/base/error.h"
#include "sim/cell/bus/virtual_bus.h"
#include "tests/hw/loopback.h"
#include "tests/support/refusal.h"

namespace tenon::hw {
namespace {

TEST(SlcanOverSerial, OpensTheChannelAndExchangesFramesOverAPty) {
  const int adapter = ::posix_openpt(O_RDWR | O_NOCTTY | O_NONBLOCK);
  ASSERT_GE(adapter, 0);
  ASSERT_EQ(::grantpt(adapter), 0);
  ASSERT_EQ(::unlockpt(adapter), 0);
  {
    const auto bus = open_bus(std::string("slcan:") + ::ptsname(adapter), 500'000);
    EXPECT_EQ(bus->send({0x201, false, false, 2, {0x0F, 0x00}}), SendResult::kSent);
    bus->flush();
    // A pty hands over what was written in pieces of its own choosing.
    const std::string expected = "C\rS6\rO\rt20120F00\r";
    std::array<char, 256> buffer{};
    ssize_t count = 0;
    std::string opening;
    for (int tries = 0; tries < 100'000 && opening.size() < expected.size(); ++tries) {
      count = ::read(adapter, buffer.data(), buffer.size());
      if (count > 0) opening.append(buffer.data(), static_cast<std::size_t>(count));
    }
    EXPECT_EQ(opening, expected);
    const std::string answer = "\r\r\r\at1902ABCD\r";
    ASSERT_EQ(::write(adapter, answer.data(), answer.size()), static_cast<ssize_t>(answer.size()));
    ReceivedFrame received;
    ASSERT_TRUE(receive_soon(*bus, received));
    EXPECT_EQ(received.frame, (CanFrame{0x190, false, false, 2, {0xAB, 0xCD}}));
    EXPECT_EQ(bus->status().error_frames, 1u);
  }
  ::close(adapter);
}

TEST(SlcanStream, LineThatWasCutByAFullDeviceIsFinishedAndLaterOnesAreDropped) {
  const int adapter = ::posix_openpt(O_RDWR | O_NOCTTY | O_NONBLOCK);
  ASSERT_EQ(::grantpt(adapter), 0);
  ASSERT_EQ(::unlockpt(adapter), 0);
  {
    SlcanStream stream;
    stream.adopt(open_serial(::ptsname(adapter)));
    const std::string line = "T1ABCDEF08A1A2A3A4A5A6A7A\r";  // 26: no power of two divides it
    bool taken = true;
    for (int i = 0; i < 10'000 && taken; ++i) {
      taken = stream.stage(line);
      if (i % 50 == 49) stream.flush();
    }
    ASSERT_FALSE(taken);
    EXPECT_GT(stream.dropped(), 0u);
    std::string text;
    std::array<char, 4096> buffer{};
    for (int i = 0; i < 100; ++i) {
      const ssize_t count = ::read(adapter, buffer.data(), buffer.size());
      if (count > 0) text.append(buffer.data(), static_cast<std::size_t>(count));
      stream.flush();
    }
    ASSERT_TRUE(stream.stage("t0800\r"));
    stream.flush();
    const ssize_t count = ::read(adapter, buffer.data(), buffer.size());
    ASSERT_GT(count, 0);
    text.append(buffer.data(), static_cast<std::size_t>(count));
    std::size_t at = 0;
    while (text.compare(at, line.size(), line) == 0) at += line.size();
    EXPECT_GT(at, line.size());
    EXPECT_EQ(text.substr(at), "t0800\r");
  }
  ::close(adapter);
}

std::string opening_refusal(const std::string& uri) {
  return tests::refusal([&] { (void)open_bus(uri, 1'000'000); });
}

TEST(OpenBus, RefusesWhatItCannotOpenInOneLineThatNamesIt) {
  for (const char* uri :
       {"", "can0", "slcan:ttyACM0", "slcan://", "slcan://127.0.0.1", "slcan://127.0.0.1:x",
        "slcan://127.0.0.1:70000", "slcan:/dev/nothing", "slcan-listen://127.0.0.1:-1",
        "socketcan:", "socketcan:none0", "socketcan:a-name-that-is-too-long"}) {
    const std::string message = opening_refusal(uri);
    EXPECT_NE(message, "accepted") << uri;
    EXPECT_NE(message.find(uri), std::string::npos) << uri << " -> " << message;
    EXPECT_EQ(message.find('\n'), std::string::npos);
  }
  const auto server = open_bus("slcan-listen://127.0.0.1:0", 1'000'000);
  const std::string taken = "slcan-listen://127.0.0.1:" + std::to_string(listening_port(*server));
  EXPECT_NE(opening_refusal(taken).find("cannot listen"), std::string::npos);
}

TEST(OpenBus, RefusesABitrateThatSlcanCannotSet) {
  Loopback loopback;
  EXPECT_THROW(
      (void)open_bus("slcan://127.0.0.1:" + std::to_string(listening_port(*loopback.server)),
                     123'456),
      InputError);
}

TEST(SocketcanErrors, BusOffPassiveAndOverrunsAreDecoded) {
  CanBusStatus status;
  apply_error_frame(CAN_ERR_CRTL, {0, CAN_ERR_CRTL_TX_PASSIVE}, status);
  EXPECT_TRUE(status.error_passive);
  apply_error_frame(CAN_ERR_CRTL, {0, CAN_ERR_CRTL_ACTIVE}, status);
  EXPECT_FALSE(status.error_passive);
  apply_error_frame(CAN_ERR_CRTL, {0, CAN_ERR_CRTL_RX_OVERFLOW}, status);
  EXPECT_EQ(status.overruns, 1u);
  apply_error_frame(CAN_ERR_BUSOFF, {}, status);
  EXPECT_TRUE(status.bus_off);
  apply_error_frame(CAN_ERR_RESTARTED, {}, status);
  EXPECT_FALSE(status.bus_off);
  EXPECT_EQ(status.error_frames, 5u);
}

TEST(CandumpLog, LinesAreCandumps) {
  const CanFrame setpoint{0x201, false, false, 4, {0x0F, 0x00, 0x01, 0x02}};
  EXPECT_EQ(candump_line({setpoint, 1'500'000'000}, "can0"), "(1.500000) can0 201#0F000102");
  EXPECT_EQ(candump_line({{0x12345, true, false, 1, {0xFF}}, 1'999}, "can1"),
            "(0.000001) can1 00012345#FF");
  EXPECT_EQ(candump_line({{0x080, false, false, 0, {}}, 0}, "can0"), "(0.000000) can0 080#");
  EXPECT_EQ(candump_line({{0x201, false, true, 6, {}}, 0}, "can0"), "(0.000000) can0 201#R6");
}

std::int64_t fixed_clock() noexcept { return 2'000'000'000; }

TEST(RecordingBus, EveryFrameThatPassedIsInTheLog) {
  sim::VirtualBus bus{{.bitrate_bps = 0}};
  CanBus& end = bus.attach();
  CanBus& other = bus.attach();
  const auto ring = std::make_unique<CanRecordRing>();
  RecordingBus recording(end, *ring, &fixed_clock);
  EXPECT_EQ(recording.send(frame_of(0x201, 1)), SendResult::kSent);
  bus.advance(3'000'000'000);
  EXPECT_EQ(other.send(frame_of(0x190, 2)), SendResult::kSent);
  ReceivedFrame received;
  EXPECT_TRUE(recording.receive(received));
  EXPECT_FALSE(recording.receive(received));
  bus.set_up(false);
  EXPECT_EQ(recording.send(frame_of(0x202, 1)), SendResult::kDown);
  EXPECT_FALSE(recording.status().up);

  const std::string file = testing::TempDir() + "tenon_candump_test.log";
  {
    CandumpLog log(file);
    const RecordReport report = log.close(*ring);
    EXPECT_TRUE(report.whole());
    EXPECT_EQ(report.written, 2U);
  }
  std::stringstream text;
  text << std::ifstream(file).rdbuf();
  EXPECT_EQ(text.str(), "(2.000000) can0 201#01\n(3.000000) can0 190#02\n");
  ::unlink(file.c_str());
  EXPECT_THROW(CandumpLog("/nowhere/run.log"), InputError);
}

TEST(RecordingBus, AFlushReachesTheBusBelow) {
  Loopback loopback;
  const auto client = loopback.connect();
  const auto ring = std::make_unique<CanRecordRing>();
  RecordingBus recording(*client, *ring);
  EXPECT_EQ(recording.send(frame_of(0x201, 7)), SendResult::kSent);
  ReceivedFrame received;
  EXPECT_FALSE(loopback.server->receive(received)) << "the client gathers what a cycle sends";
  recording.flush();
  ASSERT_TRUE(receive_soon(*loopback.server, received));
  EXPECT_EQ(received.frame, frame_of(0x201, 7));
}

TEST(CandumpLog, TellsTimesSince1970) {
  const auto ring = std::make_unique<CanRecordRing>();
  ring->push({frame_of(0x201, 1), 2'500'000'000});
  const std::string file = testing::TempDir() + "tenon_candump_unix_test.log";
  EXPECT_TRUE(CandumpLog(file, {"can1", "can2"}, 1'700'000'000'000'000'000).close(*ring).whole());
  std::stringstream text;
  text << std::ifstream(file).rdbuf();
  EXPECT_EQ(text.str(), "(1700000002.500000) can1 201#01\n");
  ::unlink(file.c_str());
}

TEST(CandumpLog, WhatItsRingHasLostItTells) {
  const auto ring = std::make_unique<CanRecordRing>();
  for (std::size_t i = 0; i < CanRecordRing::capacity() + 3; ++i) ring->push({});
  const std::string file = testing::TempDir() + "tenon_candump_loss_test.log";
  const RecordReport report = CandumpLog(file).close(*ring);
  EXPECT_EQ(loss_text(report),
            "--can-log " + file + ": 3 of 32771 records lost (written too slowly)");
  ::unlink(file.c_str());
}

}  // namespace
}  // namespace tenon::hw

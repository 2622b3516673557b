// Beside the programs that everybody uses: candump, cansend, cangen.

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <map>
#include <memory>
#include <sstream>
#include <string>
#include <vector>

#include "hw/can/candump_log.h"
#include "hw/can/recording_bus.h"
#include "hw/can/socketcan_bus.h"
#include "sim/cell/lockstep/foreign_link.h"
#include "tests/socketcan/box_run.h"
#include "tests/socketcan/interfaces.h"
#include "tests/support/whole_run.h"

namespace tenon::socketcan {
namespace {

using hw::SocketcanBus;

TEST(CanUtils, WhatCansendSendsIsReceived) {
  const VirtualInterface vcan("vcan0");
  SocketcanBus bus("vcan0", kMbit_bps, 1);
  run("cansend vcan0 201#0F0001020304");
  run("cansend vcan0 00012345#FF");
  run("cansend vcan0 181#R");
  const std::vector<CanFrame> expected = {
      {0x201, false, false, 6, {0x0F, 0x00, 0x01, 0x02, 0x03, 0x04}},
      {0x12345, true, false, 1, {0xFF}},
      {0x181, false, true, 0, {}},
  };
  EXPECT_EQ(drain(bus), expected);
}

/// candump says nothing until it hears something: sends until it does, and then a last frame, after
/// which it has heard all.
bool listens(Beside& candump) {
  const auto heard = [&candump] {
    const std::string text = candump.process().out();
    return text.find("7FF#02\n") != std::string::npos;
  };
  for (int i = 0; i < 1000 && candump.process().out().empty(); ++i) run("cansend vcan0 7FF#01");
  run("cansend vcan0 7FF#02");
  return candump.process().wait_until(heard);
}

/// "201#0F00" and the like by identifier, in order. Times are each program's own, and so is the
/// order of frames of which one is sent while the other is on its way.
std::map<std::string, std::vector<std::string>> by_identifier(const std::string& log) {
  std::map<std::string, std::vector<std::string>> frames;
  std::istringstream lines(log);
  for (std::string time, interface, frame; lines >> time >> interface >> frame;) {
    EXPECT_EQ(interface, "vcan0");
    frames[frame.substr(0, frame.find('#'))].push_back(frame);
  }
  return frames;
}

TEST(CanUtils, CandumpAndOurLogAgreeFrameByFrame) {
  const VirtualInterface vcan("vcan0");
  Beside candump("candump -L -r 16000000 vcan0");
  ASSERT_TRUE(listens(candump));
  const std::size_t before = candump.process().out().size();

  SocketcanBus master("vcan0", kMbit_bps, 5);
  SocketcanBus devices("vcan0", kMbit_bps, 5);
  const auto ring = std::make_unique<hw::CanRecordRing>();
  hw::RecordingBus recording(master, *ring);
  BoxRun run(recording, devices);
  ASSERT_TRUE(run.lockstep().prepare()) << run.lockstep().result().reason;
  for (int i = 0; i < 300; ++i) ASSERT_TRUE(run.lockstep().cycle());

  const tests::ScratchFolder scratch;
  hw::CandumpLog(scratch.path() / "ours.log", {"vcan0", "vcan1"}).drain(*ring);
  const std::string ours = scratch.get("ours.log");
  const auto frames = static_cast<std::size_t>(std::count(ours.begin(), ours.end(), '\n'));
  ASSERT_GT(frames, 300U * 9U) << "SYNC, three commands, three answers, two of the sensor";
  ASSERT_TRUE(candump.process().wait_until([&] {
    const std::string text = candump.process().out().substr(before);
    return static_cast<std::size_t>(std::count(text.begin(), text.end(), '\n')) >= frames;
  }));
  EXPECT_EQ(by_identifier(candump.process().out().substr(before)), by_identifier(ours));
}

/// Frames that came while a program ran.
std::uint64_t read_until_end(Beside& program, CanBus& bus) {
  std::uint64_t frames = 0;
  (void)program.process().wait_until([&] {
    for (ReceivedFrame received; bus.receive(received);) ++frames;
    return false;
  });
  return frames;
}

TEST(CanUtils, CangensFloodIsReceivedOrCounted) {
  constexpr std::uint64_t kMany = 5000;
  const VirtualInterface vcan("vcan0");
  SocketcanBus bus("vcan0", kMbit_bps, 1);
  Beside cangen("cangen vcan0 -g 0 -I 222 -L 8 -n " + std::to_string(kMany));
  std::uint64_t received = read_until_end(cangen, bus);
  EXPECT_EQ(cangen.process().wait(), 0);
  run("cansend vcan0 111#");  // brings the count of what was lost at the end
  received += drain(bus).size();
  EXPECT_EQ(received + bus.status().overruns, kMany + 1);
}

TEST(Sja1000CanUtils, CangensFloodCrossesTheBusOrIsCounted) {
  constexpr std::uint64_t kMany = 2000;
  const Controllers controllers;
  SocketcanBus bus("can1", kMbit_bps, 1);
  Beside cangen("cangen can0 -g 0 -p 100 -I 222 -L 8 -n " + std::to_string(kMany));
  std::uint64_t received = read_until_end(cangen, bus);
  EXPECT_EQ(cangen.process().wait(), 0);
  run("cansend can0 111#");
  received += drain(bus).size();
  // An overrun of the controller is one report of any number of frames.
  EXPECT_LE(received + bus.status().overruns, kMany + 1);
  EXPECT_EQ(received == kMany + 1, bus.status().overruns == 0);
}

}  // namespace
}  // namespace tenon::socketcan

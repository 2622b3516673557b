// Fault specifications as people write them, and the decorator that carries bus faults out on a bus
// that is not ours.

#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <utility>
#include <vector>

#include "sim/cell/bus/virtual_bus.h"
#include "sim/cell/faults/bus_faults.h"
#include "sim/cell/faults/fault_spec.h"
#include "sim/cell/faults/faulty_bus.h"
#include "sim/cell/faults/frame_sender.h"
#include "tests/sim/literal_client.h"
#include "tests/support/refusal.h"

namespace tenon::sim {
namespace {

// --- specifications ------------------------------------------------------------------------------

TEST(FaultSpec, EveryKeyIsRead) {
  const Fault fault = parse_fault("drop:node=3,time_s=2,duration_s=0.5,probability=0.1,seed=7");
  EXPECT_EQ(fault.kind, FaultKind::kDrop);
  EXPECT_EQ(fault.node, 3);
  EXPECT_EQ(fault.time_s, 2.0);
  EXPECT_EQ(fault.duration_s, 0.5);
  EXPECT_EQ(fault.probability, 0.1);
  EXPECT_EQ(fault.seed, 7U);
  EXPECT_EQ(parse_fault("interface-down").kind, FaultKind::kInterfaceDown);
  EXPECT_EQ(parse_fault("delay:delay_s=0.003").value, 0.003);
  EXPECT_EQ(parse_fault("emergency:node=1,code=0x3210").value, 0x3210);
  EXPECT_EQ(parse_fault("encoder-jump:node=1,jump_m=-0.002").value, -0.002);
  EXPECT_EQ(parse_fault("encoder-jump:node=1,jump_rad=0.1").value, 0.1);
  EXPECT_EQ(parse_fault("torque-loss:node=2,share=0").value, 0.0);
  EXPECT_EQ(parse_fault("slow-brake:node=2,brake_s=0.05").value, 0.05);
}

TEST(FaultSpec, AFaultMayWaitForAPhaseAndMeanSomeFramesAlone) {
  EXPECT_FALSE(parse_fault("drop:node=3").at.has_value());
  EXPECT_EQ(parse_fault("brake-failure:node=3,at=sliding").at, FaultPhase::kSliding);
  EXPECT_EQ(parse_fault("drop:at=stopping,time_s=0.1").at, FaultPhase::kStopping);
  EXPECT_EQ(parse_fault("drop:at=step:4").at_step, 4);
  EXPECT_FALSE(parse_fault("drop:at=step:4").at.has_value());
  EXPECT_FALSE(parse_fault("drop:at=stopping").at_step.has_value());
  EXPECT_EQ(parse_fault("drop:node=3").frames, FrameKind::kAny);
  EXPECT_EQ(parse_fault("drop:id=rpdo").frames, FrameKind::kSetpoints);
  const Fault one = parse_fault("delay:delay_s=0.001,id=0x191");
  EXPECT_EQ(one.frames, FrameKind::kOne);
  EXPECT_EQ(one.cob_id, 0x191U);
}

std::string refusal(const std::string& text) {
  return tests::refusal([&] { (void)parse_fault(text); });
}

TEST(FaultSpec, WhatIsWrongIsSaidInOneLineWithItsBound) {
  const std::pair<const char*, const char*> wrong[] = {
      {"", "no kind ''"},
      {"explode", "no kind 'explode'"},
      {"drop:", "has no value"},
      {"drop:node", "'node' has no value"},
      {"drop:nod=3", "no key 'nod'; drop takes node, time_s"},
      {"drop:node=128", "node = '128', must be a whole number in [0, 127]"},
      {"drop:node=-1", "must be a whole number"},
      {"drop:node=3,node=4", "node stands there twice"},
      {"drop:node=3,", "has no value"},
      {"drop:time_s=-1", "time_s = '-1', must be a number in [0, 1e+06]"},
      {"drop:time_s=nan", "time_s"},
      {"drop:probability=0", "probability"},
      {"drop:probability=1.5", "probability = '1.5', must be a number in [1e-09, 1]"},
      {"drop:delay_s=1", "no key 'delay_s'"},
      {"drop:seed=x", "seed = 'x'"},
      {"delay:node=1", "delay_s is missing"},
      {"delay:delay_s=0", "delay_s = '0', must be a number in [1e-06, 10]"},
      {"node-reset:time_s=1", "node is missing"},
      {"node-reset:node=0", "must be a whole number in [1, 127]"},
      {"emergency:node=1", "code is missing"},
      {"emergency:node=1,code=70000", "code = '70000', must be a whole number in [1, 65535]"},
      {"torque-loss:node=1,share=1", "share"},
      {"drop:at=home",
       "at = 'home', must be one of enabling, free, sliding, contact, stopping, step:N"},
      {"drop:at=step:", "at = '', must be a whole number in [0, 253]"},
      {"drop:at=step:-1", "at = '-1', must be a whole number in [0, 253]"},
      {"drop:at=step:254", "at = '254', must be a whole number in [0, 253]"},
      {"drop:id=tpdo",
       "id = 'tpdo', must be one of any, sync, heartbeat, emcy, answers, rpdo, sdo"},
      {"drop:id=0x800", "must be a whole number in [0, 2047]"},
      {"bus-off:id=rpdo", "no key 'id'"},
  };
  for (const auto& [text, expected] : wrong) {
    const std::string message = refusal(text);
    EXPECT_NE(message.find(expected), std::string::npos) << text << " -> " << message;
    EXPECT_NE(message.find("--fault help"), std::string::npos) << message;
    EXPECT_EQ(message.find('\n'), std::string::npos);
  }
}

TEST(FaultSpec, HelpNamesEveryKindInALineAndItsExamplesAreGood) {
  const std::string help = fault_help();
  for (int kind = 0; kind <= static_cast<int>(FaultKind::kFrozenEffort); ++kind) {
    const std::string name = to_string(static_cast<FaultKind>(kind));
    const std::size_t at = help.find("\n" + name + " ");
    ASSERT_NE(at, std::string::npos) << name;
    const std::string line = help.substr(at + 1, help.find('\n', at + 1) - at - 1);
    const std::string example = line.substr(line.rfind("; ") + 2);
    EXPECT_EQ(parse_fault(example).kind, static_cast<FaultKind>(kind)) << line;
  }
}

// --- who sends -----------------------------------------------------------------------------------

CanFrame frame_of(std::uint32_t id, std::vector<std::uint8_t> data = {1, 2}) {
  CanFrame frame{id, false, false, static_cast<std::uint8_t>(data.size()), {}};
  std::copy(data.begin(), data.end(), frame.data.begin());
  return frame;
}

TEST(FrameSender, KnowsThePredefinedIdentifiers) {
  const FrameSender sender(127);
  for (const std::uint32_t id : {0x000u, 0x080u, 0x203u, 0x303u, 0x503u, 0x603u, 0x77Fu}) {
    EXPECT_EQ(sender.node_of(frame_of(id)), 127) << id;
  }
  for (const std::uint32_t id : {0x083u, 0x183u, 0x283u, 0x383u, 0x483u, 0x583u, 0x703u}) {
    EXPECT_EQ(sender.node_of(frame_of(id)), 3) << id;
  }
}

TEST(FrameSender, OverhearsWhichIdentifierAMasterGivesToANode) {
  FrameSender sender(127);
  // Node 3: 1800h:1 = 191h, after it had been switched off.
  sender.overhear(frame_of(0x603, {0x23, 0x00, 0x18, 0x01, 0x91, 0x01, 0x00, 0xC0}));
  EXPECT_EQ(sender.node_of(frame_of(0x191)), 0x11);
  sender.overhear(frame_of(0x603, {0x23, 0x00, 0x18, 0x01, 0x91, 0x01, 0x00, 0x40}));
  EXPECT_EQ(sender.node_of(frame_of(0x191)), 3);
  // What a node takes the master sends.
  sender.overhear(frame_of(0x603, {0x23, 0x00, 0x14, 0x01, 0x92, 0x01, 0x00, 0x00}));
  EXPECT_EQ(sender.node_of(frame_of(0x192)), 127);
}

TEST(FrameSender, KnowsWhatAFrameIsByWhatItHasOverheard) {
  FrameSender sender(127);
  EXPECT_EQ(sender.kind_of(frame_of(0x080)), FrameKind::kSync);
  EXPECT_EQ(sender.kind_of(frame_of(0x083)), FrameKind::kEmergency);
  EXPECT_EQ(sender.kind_of(frame_of(0x183)), FrameKind::kAnswers);
  EXPECT_EQ(sender.kind_of(frame_of(0x203)), FrameKind::kSetpoints);
  EXPECT_EQ(sender.kind_of(frame_of(0x583)), FrameKind::kSdo);
  EXPECT_EQ(sender.kind_of(frame_of(0x603)), FrameKind::kSdo);
  EXPECT_EQ(sender.kind_of(frame_of(0x77F)), FrameKind::kHeartbeat);
  EXPECT_EQ(sender.kind_of(frame_of(0x000)), FrameKind::kAny);
  EXPECT_TRUE(sender.is_for(frame_of(0x203), 3));
  // Nodes 3 and 4 both take their targets from 203h (1400h:1), and 3 answers as 291h.
  sender.overhear(frame_of(0x603, {0x23, 0x00, 0x14, 0x01, 0x03, 0x02, 0x00, 0x00}));
  sender.overhear(frame_of(0x604, {0x23, 0x00, 0x14, 0x01, 0x03, 0x02, 0x00, 0x00}));
  sender.overhear(frame_of(0x603, {0x23, 0x00, 0x18, 0x01, 0x13, 0x02, 0x00, 0x00}));
  EXPECT_TRUE(sender.is_for(frame_of(0x203), 3));
  EXPECT_TRUE(sender.is_for(frame_of(0x203), 4));
  EXPECT_FALSE(sender.is_for(frame_of(0x203), 5));
  EXPECT_EQ(sender.kind_of(frame_of(0x213)), FrameKind::kAnswers);
}

// --- the decorator -------------------------------------------------------------------------------

/// The devices' side behind faults, and what a master on the wire sees.
struct Decorated {
  explicit Decorated(const std::vector<std::string>& specs)
      : devices(bus.attach()), master(bus.attach()), faulty(devices, parse(specs), 127, 0) {}

  static std::vector<Fault> parse(const std::vector<std::string>& specs) {
    std::vector<Fault> faults;
    for (const std::string& spec : specs) faults.push_back(parse_fault(spec));
    return faults;
  }
  static std::vector<CanFrame> drain(CanBus& end) {
    std::vector<CanFrame> frames;
    for (ReceivedFrame received; end.receive(received);) frames.push_back(received.frame);
    return frames;
  }

  VirtualBus bus{{.bitrate_bps = 0}};
  CanBus& devices;
  CanBus& master;
  FaultyBus faulty;
};

constexpr std::int64_t kMillisecond_ns = 1'000'000;

TEST(FaultyBus, MayLoseSomeFramesOfANodeAlone) {
  Decorated line({"drop:node=3,duration_s=1,id=heartbeat", "drop:node=4,duration_s=1,id=rpdo",
                  "drop:duration_s=1,id=0x305"});
  for (const std::uint32_t id : {0x703u, 0x183u, 0x704u}) {
    EXPECT_EQ(line.faulty.send(frame_of(id)), SendResult::kSent);
  }
  for (const std::uint32_t id : {0x203u, 0x204u, 0x305u, 0x306u}) {
    EXPECT_EQ(line.master.send(frame_of(id)), SendResult::kSent);
  }
  EXPECT_EQ(Decorated::drain(line.master), (std::vector{frame_of(0x183), frame_of(0x704)}));
  EXPECT_EQ(Decorated::drain(line.faulty), (std::vector{frame_of(0x203), frame_of(0x306)}));
}

TEST(BusFaultsTest, OneThatWaitsForAPhaseBeginsSoLongAfterItAndLastsFromThen) {
  FaultPhases phases;
  const std::vector<Fault> faults = {
      parse_fault("interface-down:at=free,time_s=0.1,duration_s=0.2")};
  const BusFaults bus(faults, 127, 0, &phases);
  EXPECT_FALSE(bus.down(500 * kMillisecond_ns));
  phases.begin(FaultPhase::kFree, 1000 * kMillisecond_ns);
  phases.begin(FaultPhase::kFree, 2000 * kMillisecond_ns);  // not for the first time
  EXPECT_FALSE(bus.down(1099 * kMillisecond_ns));
  EXPECT_TRUE(bus.down(1100 * kMillisecond_ns));
  EXPECT_TRUE(bus.down(1299 * kMillisecond_ns));
  EXPECT_FALSE(bus.down(1300 * kMillisecond_ns));
}

TEST(BusFaultsTest, OneThatWaitsForAStepOfThePlanBeginsSoLongAfterItsFirstTime) {
  FaultPhases phases;
  const std::vector<Fault> faults = {parse_fault("interface-down:at=step:2,time_s=0.1")};
  const BusFaults bus(faults, 127, 0, &phases);
  phases.begin_step(0, 100 * kMillisecond_ns);
  phases.begin_step(1, 200 * kMillisecond_ns);
  EXPECT_FALSE(bus.down(900 * kMillisecond_ns));
  phases.begin_step(2, 1000 * kMillisecond_ns);
  phases.begin_step(2, 2000 * kMillisecond_ns);
  EXPECT_FALSE(bus.down(1099 * kMillisecond_ns));
  EXPECT_TRUE(bus.down(1100 * kMillisecond_ns));
}

TEST(FaultyBus, WithoutFaultsFramesPassBothWays) {
  Decorated line({});
  EXPECT_EQ(line.faulty.send(frame_of(0x183)), SendResult::kSent);
  EXPECT_EQ(line.master.send(frame_of(0x203)), SendResult::kSent);
  EXPECT_EQ(Decorated::drain(line.master), std::vector<CanFrame>{frame_of(0x183)});
  EXPECT_EQ(Decorated::drain(line.faulty), std::vector<CanFrame>{frame_of(0x203)});
}

TEST(FaultyBus, AFlushReachesTheBusBelow) {
  LiteralBus bus;
  FaultyBus faulty(bus, {}, 127, 0);
  faulty.flush();
  EXPECT_EQ(bus.flushes, 1);
}

TEST(FaultyBus, DropsThatNodesFramesForAsLongAsItSays) {
  Decorated line({"drop:node=3,time_s=0.01,duration_s=0.01"});
  const auto arrives = [&](std::uint32_t id) {
    EXPECT_EQ(line.faulty.send(frame_of(id)), SendResult::kSent);
    return !Decorated::drain(line.master).empty();
  };
  EXPECT_TRUE(arrives(0x183));
  line.faulty.advance(10 * kMillisecond_ns);
  EXPECT_FALSE(arrives(0x183));
  EXPECT_TRUE(arrives(0x184)) << "another node's";
  line.faulty.advance(20 * kMillisecond_ns);
  EXPECT_TRUE(arrives(0x183));
}

TEST(FaultyBus, WithoutADurationOneFrameIsStruck) {
  Decorated line({"drop:node=127"});
  for (int i = 0; i < 3; ++i) EXPECT_EQ(line.master.send(frame_of(0x203)), SendResult::kSent);
  EXPECT_EQ(Decorated::drain(line.faulty).size(), 2u);
}

TEST(FaultyBus, DelayedFramesComeLaterInBothDirections) {
  Decorated line({"delay:delay_s=0.003,duration_s=1"});
  EXPECT_EQ(line.faulty.send(frame_of(0x183)), SendResult::kSent);
  EXPECT_EQ(line.master.send(frame_of(0x203)), SendResult::kSent);
  EXPECT_TRUE(Decorated::drain(line.master).empty());
  EXPECT_TRUE(Decorated::drain(line.faulty).empty());
  line.faulty.advance(3 * kMillisecond_ns);
  EXPECT_EQ(Decorated::drain(line.master).size(), 1u);
  EXPECT_EQ(Decorated::drain(line.faulty).size(), 1u);
}

TEST(FaultyBus, DuplicatesAndShortensFrames) {
  Decorated line({"duplicate:node=3,duration_s=1", "corrupt-length:node=127,duration_s=1"});
  EXPECT_EQ(line.faulty.send(frame_of(0x183)), SendResult::kSent);
  EXPECT_EQ(Decorated::drain(line.master).size(), 2u);
  EXPECT_EQ(line.master.send(frame_of(0x203)), SendResult::kSent);
  const auto frames = Decorated::drain(line.faulty);
  ASSERT_EQ(frames.size(), 1u);
  EXPECT_EQ(frames[0].length, 1);
}

TEST(FaultyBus, ANodeThatIsBusOffOrHasAFullQueueIsToldSo) {
  Decorated line({"bus-off:node=3", "queue-full:node=4"});
  EXPECT_EQ(line.faulty.send(frame_of(0x183)), SendResult::kDown);
  EXPECT_EQ(line.faulty.send(frame_of(0x184)), SendResult::kQueueFull);
  EXPECT_EQ(line.faulty.send(frame_of(0x185)), SendResult::kSent);
  EXPECT_EQ(Decorated::drain(line.master), std::vector<CanFrame>{frame_of(0x185)});
}

TEST(FaultyBus, AMasterThatIsBusOffIsSilenceBothWays) {
  Decorated line({"bus-off:node=127"});
  EXPECT_EQ(line.faulty.send(frame_of(0x183)), SendResult::kSent);
  EXPECT_TRUE(Decorated::drain(line.master).empty());
  EXPECT_EQ(line.master.send(frame_of(0x203)), SendResult::kSent);
  EXPECT_TRUE(Decorated::drain(line.faulty).empty());
}

TEST(FaultyBus, DownIsDownUntilItComesBack) {
  Decorated line({"interface-down:duration_s=0.01"});
  EXPECT_FALSE(line.faulty.status().up);
  EXPECT_EQ(line.faulty.send(frame_of(0x183)), SendResult::kDown);
  EXPECT_EQ(line.master.send(frame_of(0x203)), SendResult::kSent);
  EXPECT_TRUE(Decorated::drain(line.faulty).empty());
  line.faulty.advance(10 * kMillisecond_ns);
  EXPECT_TRUE(line.faulty.status().up);
  EXPECT_EQ(line.faulty.send(frame_of(0x183)), SendResult::kSent);
  EXPECT_EQ(Decorated::drain(line.master).size(), 1u);
}

TEST(BusFaults, ADevicesBusOffIsSilenceToTheDevice) {
  const std::vector<Fault> faults = {parse_fault("bus-off:node=3,time_s=2"),
                                     parse_fault("bus-off:node=127"), parse_fault("drop"),
                                     parse_fault("node-reset:node=2")};
  const auto of_devices = faults_of_devices(faults, 127);
  ASSERT_EQ(of_devices.size(), 2u);
  EXPECT_EQ(of_devices[0].kind, FaultKind::kSilentNode);
  EXPECT_EQ(of_devices[0].node, 3);
  EXPECT_EQ(of_devices[0].time_s, 2.0);
  EXPECT_EQ(of_devices[1].kind, FaultKind::kNodeReset);
}

TEST(BusFaults, ProbabilityIsThatOfEachFrame) {
  Decorated line({"drop:duration_s=1,probability=0.25,seed=11"});
  std::size_t arrived = 0;
  for (int i = 0; i < 4000; ++i) {
    EXPECT_EQ(line.faulty.send(frame_of(0x183)), SendResult::kSent);
    arrived += Decorated::drain(line.master).size();
  }
  EXPECT_NEAR(static_cast<double>(arrived), 3000.0, 4 * 27.4) << "four standard deviations";
}

}  // namespace
}  // namespace tenon::sim

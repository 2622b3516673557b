// The CANopen master of a one-axis arm under arbitrary traffic, from bring-up to cyclic operation.
// Nothing that arrives may crash it, make it report what is no number, let it forget a fault, or
// let it keep a drive enabled while it knows of one.
//
// Input: one byte (bit 0: traffic already during bring-up), then operations, each a byte and its
// arguments.

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>

#include "shared/base/bytes.h"
#include "tests/fuzz/support/must.h"
#include "tests/hw/gantry_on_bus.h"
#include "tests/support/frame_filter.h"

namespace {

using namespace tenon;
using namespace tenon::hw;
using fuzz::must;

constexpr int kOperationsMax = 400;
constexpr int kBringUpMax_ms = 700;
constexpr int kDisturbedBringUpMax_ms = 3000;
constexpr std::int64_t kMillisecond_ns = 1'000'000;

// What the master listens to; the joint is node 1, the sensor node 4.
constexpr std::array<std::uint16_t, 16> kHeard = {0x181, 0x182, 0x190, 0x191, 0x081, 0x084,
                                                  0x581, 0x584, 0x701, 0x704, 0x77F, 0x080,
                                                  0x000, 0x201, 0x182, 0x190};

Robot one_axis() {
  Robot robot = gantry_robot();
  robot.joints.resize(1);
  return robot;
}

class Bench {
 public:
  Bench()
      : gantry_(one_axis()),
        intruder_(gantry_.bus.attach()),
        filter_(gantry_.bus, [this](const CanFrame& frame, std::size_t end) {
          if (end == 0) check_sent(frame);
          return true;
        }) {}

  void run(ByteReader& in) {
    const bool disturbed = (in.read<std::uint8_t>() & 1U) != 0;
    if (!bring_up(disturbed, in)) return;
    for (int i = 0; i < kOperationsMax && in.remaining() > 0; ++i) {
      if (!operate(in)) return;
    }
  }

 private:
  bool bring_up(bool disturbed, ByteReader& in) {
    for (int i = 0; i < (disturbed ? kDisturbedBringUpMax_ms : kBringUpMax_ms); ++i) {
      if (gantry_.arm.prepare(gantry_.now_ns)) return true;
      if (gantry_.arm.state() == ArmState::kFault) {
        must(gantry_.arm.fault().kind != ArmFaultKind::kNone, "a fault has a kind");
        return false;
      }
      gantry_.step_nodes();
      pass(kMillisecond_ns);
      if (disturbed && in.remaining() > 0) disturb(in.read<std::uint8_t>(), in);
    }
    must(disturbed, "an undisturbed bring-up succeeds");
    return false;
  }

  /// False: the arm is not in operation any more.
  bool operate(ByteReader& in) {
    const auto operation = in.read<std::uint8_t>();
    switch (operation & 7U) {
      case 0:
      case 1:
        cycle(operation, in);
        return true;
      case 2:
        pass(10 * kMillisecond_ns * in.read<std::uint8_t>());
        return true;
      case 3:  // starts over after a fault
        if (gantry_.arm.state() != ArmState::kFault) return true;
        fault_ = {};
        gantry_.bus.set_up(true);
        gantry_.bus.set_bus_off(0, false);
        return bring_up(true, in);
      default:
        disturb(operation, in);
        return true;
    }
  }

  void disturb(std::uint8_t operation, ByteReader& in) {
    switch (operation & 7U) {
      case 4: {  // any frame
        CanFrame frame;
        frame.id = in.read<std::uint16_t>() & 0x7FFU;
        frame.extended = (operation & 0x80U) != 0;
        frame.remote = (operation & 0x40U) != 0;
        return inject(frame, in.read<std::uint8_t>() % 9, 1, in);
      }
      case 5:  // a frame that the master listens to, of its usual length
        return inject({.id = kHeard[operation >> 4U]}, 8, 1, in);
      case 6: {  // one of another length, or many
        const CanFrame frame{.id = kHeard[operation >> 4U]};
        const auto length = in.read<std::uint8_t>();
        return inject(frame, length % 9, length >= 0xF0 ? 600 : 1, in);
      }
      case 7:
        return turn_knob(operation);
      default:
        return;
    }
  }

  void inject(CanFrame frame, unsigned length, int times, ByteReader& in) {
    frame.length = static_cast<std::uint8_t>(length);
    for (unsigned i = 0; i < length; ++i) frame.data[i] = in.read<std::uint8_t>();
    for (int i = 0; i < times; ++i) static_cast<void>(intruder_.send(frame));
  }

  void turn_knob(std::uint8_t operation) {
    ScriptedNode& node = *gantry_.nodes[operation >> 3U & 1U];
    switch (operation >> 4U) {
      case 0:
        node.dead = !node.dead;
        break;
      case 1:
        node.heartbeats = !node.heartbeats;
        break;
      case 2:
        node.answers_sync = !node.answers_sync;
        break;
      case 3:
        node.stuck = !node.stuck;
        break;
      case 4:
        node.tears = !node.tears;
        break;
      case 5:
        node.reboot();
        break;
      case 6:
        node.statusword = 0x0218;
        break;
      case 7:
        node.samples_per_sync = 1 - node.samples_per_sync;
        break;
      case 8:
        gantry_.bus.set_up(false);
        break;
      case 9:
        gantry_.bus.set_bus_off(0, true);
        break;
      default:
        break;
    }
  }

  void cycle(std::uint8_t operation, ByteReader& in) {
    constexpr std::array<ArmRequest, 4> kRequests = {ArmRequest::kEnabled, ArmRequest::kDisabled,
                                                     ArmRequest::kQuickStop, ArmRequest::kEnabled};
    JointVector position{};
    // Also far outside of what 32 bits of counts hold, and no number at all.
    position[0] = (operation & 0x80U) != 0 ? std::numeric_limits<double>::quiet_NaN()
                                           : in.read<std::int16_t>() * 1e-4;
    if ((operation & 0x40U) != 0) position[0] *= 1e300;
    const CanopenArm::Counters before = gantry_.arm.counters();
    static_cast<void>(gantry_.cycle(kRequests[operation >> 3U & 3U], position));
    check_feedback(before);
  }

  void pass(std::int64_t time_ns) {
    gantry_.now_ns += time_ns;
    gantry_.bus.advance(gantry_.now_ns);
  }

  void check_feedback(const CanopenArm::Counters& before) {
    const ArmFeedback& feedback = gantry_.feedback;
    must(std::isfinite(feedback.position[0]) && std::isfinite(feedback.effort[0]) &&
             feedback.wrench.allFinite(),
         "feedback is made of numbers");
    must((feedback.joints_fresh & ~1U) == 0, "joints that there are not do not answer");
    const CanopenArm::Counters& now = gantry_.arm.counters();
    must(now.cycles == before.cycles + 1, "a cycle is counted once");
    must(now.unexpected_frames >= before.unexpected_frames && now.late_frames >= before.late_frames,
         "counters only grow");

    const ArmFault fault = gantry_.arm.fault();
    const bool faulty = gantry_.arm.state() == ArmState::kFault;
    must(faulty == (fault.kind != ArmFaultKind::kNone), "there is a fault exactly in fault");
    must(fault_.kind == ArmFaultKind::kNone ||
             (fault_.kind == fault.kind && fault_.node == fault.node),
         "the first fault stays");
    fault_ = fault;
  }

  void check_sent(const CanFrame& frame) const {
    must(frame.length <= 8 && frame.id <= 0x7FF && !frame.extended && !frame.remote,
         "the master sends data frames of 11 bits");
    if (frame.id != 0x201) return;
    const unsigned word = frame.data[0] | frame.data[1] * 0x100U;
    must(frame.length == 6, "a setpoint is a word and a position");
    must(gantry_.arm.state() != ArmState::kFault || (word & 0x0FU) != 0x0F,
         "no drive is told to stay enabled in fault");
  }

  GantryOnBus gantry_;
  CanBus& intruder_;
  tests::FrameFilter filter_;
  ArmFault fault_;
};

}  // namespace

// NOLINTNEXTLINE(readability-identifier-naming): libFuzzer's name
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  ByteReader in(std::span(data, size));
  Bench().run(in);
  return 0;
}

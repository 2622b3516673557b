// The CANopen master of a one-axis arm under arbitrary traffic, from bring-up to cyclic operation.
// Nothing that arrives may crash it, make it report what is no number, let it forget a fault, or
// let it keep a drive enabled while it knows of one.
//
// Input: as support/arm_bench.h has it.

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>

#include "shared/base/bytes.h"
#include "tests/fuzz/support/arm_bench.h"
#include "tests/fuzz/support/must.h"
#include "tests/hw/gantry_on_bus.h"
#include "tests/support/frame_filter.h"

namespace {

using namespace tenon;
using namespace tenon::hw;
using fuzz::kMillisecond_ns;
using fuzz::must;

// What the master listens to; the joint is node 1, the sensor node 4.
constexpr std::array<std::uint16_t, 16> kHeard = {0x181, 0x182, 0x190, 0x191, 0x081, 0x084,
                                                  0x581, 0x584, 0x701, 0x704, 0x77F, 0x080,
                                                  0x000, 0x201, 0x182, 0x190};

Robot one_axis() {
  Robot robot = gantry_robot();
  robot.joints.resize(1);
  return robot;
}

class Bench final : public fuzz::ArmBench {
 public:
  Bench()
      : gantry_(one_axis()),
        intruder_(gantry_.bus.attach()),
        filter_(gantry_.bus, [this](const CanFrame& frame, std::size_t end) {
          if (end == 0) check_command(frame);
          return true;
        }) {}

 private:
  hw::DeviceArm& arm() override { return gantry_.arm; }
  sim::VirtualBus& bus() override { return gantry_.bus; }
  CanBus& intruder() override { return intruder_; }
  std::int64_t& now_ns() override { return gantry_.now_ns; }
  [[nodiscard]] const std::array<std::uint16_t, 16>& heard() const override { return kHeard; }
  void step_devices() override { gantry_.step_nodes(); }

  void go_on(std::uint8_t /*operation*/, ByteReader& in) override {
    pass(10 * kMillisecond_ns * in.read<std::uint8_t>());
  }

  void turn_knob(std::uint8_t operation, ByteReader& /*in*/) override {
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

  void cycle(std::uint8_t operation, ByteReader& in) override {
    JointVector position{};
    // Also far outside of what 32 bits of counts hold, and no number at all.
    position[0] = (operation & 0x80U) != 0 ? std::numeric_limits<double>::quiet_NaN()
                                           : in.read<std::int16_t>() * 1e-4;
    if ((operation & 0x40U) != 0) position[0] *= 1e300;
    const CanopenArm::Counters before = gantry_.arm.counters();
    static_cast<void>(gantry_.cycle(request_of(operation), position));
    check_feedback(before);
  }

  void check_feedback(const CanopenArm::Counters& before) {
    const CanopenArm::Counters& now = gantry_.arm.counters();
    must(now.cycles == before.cycles + 1, "a cycle is counted once");
    must(now.unexpected_frames >= before.unexpected_frames && now.late_frames >= before.late_frames,
         "counters only grow");
    check(gantry_.feedback);
  }

  void check_command(const CanFrame& frame) const {
    check_sent(frame);
    if (frame.id != 0x201) return;
    const unsigned word = frame.data[0] | frame.data[1] * 0x100U;
    must(frame.length == 6, "a setpoint is a word and a position");
    must(gantry_.arm.state() != ArmState::kFault || (word & 0x0FU) != 0x0F,
         "no drive is told to stay enabled in fault");
  }

  GantryOnBus gantry_;
  CanBus& intruder_;
  tests::FrameFilter filter_;
};

}  // namespace

// NOLINTNEXTLINE(readability-identifier-naming): libFuzzer's name
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  ByteReader in(std::span(data, size));
  Bench().run(in);
  return 0;
}

// An arm of motors in MIT mode under arbitrary traffic, from bring-up to cyclic operation. Nothing
// that arrives may crash it, make it report what is no number, let it forget a fault, or let it
// switch a motor on while it knows of one.
//
// Input: as support/arm_bench.h has it.

#include "hw/mit/mit_arm.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <map>
#include <span>
#include <vector>

#include "hw/mit/motor_bring_up.h"
#include "shared/base/bytes.h"
#include "shared/config/load.h"
#include "shared/mit/robot_motors.h"
#include "sim/cell/bus/virtual_bus.h"
#include "tests/fuzz/support/arm_bench.h"
#include "tests/fuzz/support/must.h"
#include "tests/hw/scripted_node.h"
#include "tests/support/frame_filter.h"
#include "tests/support/places.h"

namespace {

using namespace tenon;
using namespace tenon::hw;
using fuzz::kMillisecond_ns;
using fuzz::must;

// What the master listens to; motors 1 to 6 answer on 11h to 16h, the sensor is node 20h.
constexpr std::array<std::uint16_t, 16> kHeard = {0x011, 0x012, 0x013, 0x014, 0x015, 0x016,
                                                  0x1A0, 0x2A0, 0x0A0, 0x5A0, 0x720, 0x7FF,
                                                  0x001, 0x080, 0x000, 0x77F};

const Cell& cell() {
  static const Cell mit6 = load_cell(tests::in_tree("hw/cells/mit6.yaml"));
  return mit6;
}

/// Motors by literal bytes, all on one end of the bus: registers in a map, off or on, and where
/// they were sent.
class ScriptedMotors {
 public:
  explicit ScriptedMotors(CanBus& bus) : bus_(bus) {
    for (const Joint& joint : cell().robot.joints) {
      Motor motor{.answers_on = mit_motor(joint).feedback_id};
      for (const auto& setting : mit::motor_settings(joint)) {
        motor.registers[setting.number] = setting.value;
      }
      motors_[joint.node] = motor;
    }
  }

  void step() {
    ReceivedFrame received;
    while (bus_.receive(received)) {
      const CanFrame& frame = received.frame;
      if (frame.length != 8 || frame.extended || frame.remote) continue;
      const bool asked = frame.id == 0x7FF;
      const auto found = motors_.find(asked ? frame.data[0] : static_cast<std::uint8_t>(frame.id));
      if (found == motors_.end() || (!asked && frame.id > 0x00F)) continue;
      asked ? answer(found->second, frame) : obey(found->first, found->second, frame);
    }
  }

  /// One of them goes into a state, loses its registers, or answers no more.
  void turn_knob(std::uint8_t operation) {
    Motor& motor = motors_[static_cast<std::uint8_t>(1 + (operation >> 3U & 3U))];
    switch (operation >> 5U) {
      case 0:
        motor.silent = !motor.silent;
        break;
      case 1:
        for (auto& [number, value] : motor.registers) value = 0;
        motor.state = 0;
        break;
      case 2:
        motor.stuck = !motor.stuck;
        break;
      default:
        motor.state = static_cast<std::uint8_t>(8U + (operation >> 5U));
        break;
    }
  }

 private:
  struct Motor {
    std::uint32_t answers_on = 0;
    std::map<std::uint8_t, std::uint32_t> registers{};
    std::uint8_t state = 0;
    std::array<std::uint8_t, 2> position{0x80, 0x00};
    bool silent = false;
    bool stuck = false;
  };

  void answer(Motor& motor, const CanFrame& frame) {
    if (motor.silent) return;
    CanFrame reply{.id = motor.answers_on, .length = 8, .data = frame.data};
    std::uint32_t& value = motor.registers[frame.data[3]];
    for (unsigned i = 0; i < 4; ++i) {
      if (frame.data[2] == 0x55) {
        value =
            (value & ~(0xFFU << 8 * i)) | static_cast<std::uint32_t>(frame.data[4 + i] << 8 * i);
      }
      reply.data[4 + i] = static_cast<std::uint8_t>(value >> 8 * i);
    }
    (void)bus_.send(reply);
  }
  void obey(std::uint8_t number, Motor& motor, const CanFrame& frame) {
    bool special = true;
    for (unsigned i = 0; i < 7; ++i) special = special && frame.data[i] == 0xFF;
    if (special && !motor.stuck) {
      if (frame.data[7] == 0xFC && motor.state == 0) motor.state = 1;
      if (frame.data[7] == 0xFD && motor.state == 1) motor.state = 0;
      if (frame.data[7] == 0xFB && motor.state > 1) motor.state = 0;
    }
    if (!special && motor.state == 1) motor.position = {frame.data[0], frame.data[1]};
    if (motor.silent) return;
    const auto first =
        static_cast<std::uint8_t>(static_cast<unsigned>(motor.state) << 4U | (number & 0xFU));
    (void)bus_.send(
        {.id = motor.answers_on,
         .length = 8,
         .data = {first, motor.position[0], motor.position[1], 0x7F, 0xF7, 0xFF, 30, 30}});
  }

  CanBus& bus_;
  std::map<std::uint8_t, Motor> motors_;
};

class Bench final : public fuzz::ArmBench {
 private:
  hw::DeviceArm& arm() override { return arm_; }
  sim::VirtualBus& bus() override { return bus_; }
  CanBus& intruder() override { return intruder_; }
  std::int64_t& now_ns() override { return now_ns_; }
  [[nodiscard]] const std::array<std::uint16_t, 16>& heard() const override { return kHeard; }

  void go_on(std::uint8_t operation, ByteReader& in) override {
    for (int i = 0; i <= operation >> 3U; ++i) cycle(0, in);
  }

  void turn_knob(std::uint8_t operation, ByteReader& in) override {
    const auto which = in.read<std::uint8_t>();
    if (which < 0xC0) return motors_.turn_knob(operation);
    switch (which & 7U) {
      case 0:
        sensor_.dead = !sensor_.dead;
        break;
      case 1:
        sensor_.heartbeats = !sensor_.heartbeats;
        break;
      case 2:
        sensor_.tears = !sensor_.tears;
        break;
      case 3:
        sensor_.reboot();
        break;
      case 4:
        bus_.set_up(false);
        break;
      case 5:
        bus_.set_bus_off(0, true);
        break;
      case 6:
        arm_.limit_force({Vector3::Zero(), 60.0});
        break;
      default:
        pass(10 * kMillisecond_ns * in.read<std::uint8_t>());
        break;
    }
  }

  void cycle(std::uint8_t operation, ByteReader& in) override {
    JointVector position = feedback_.position;
    // Also far outside of what 16 bits of counts hold, and no number at all.
    if ((operation & 0x20U) != 0) position[0] += in.read<std::int16_t>() * 1e-4;
    if ((operation & 0x40U) != 0) position[0] *= 1e300;
    if ((operation & 0x80U) != 0) position[0] = std::numeric_limits<double>::quiet_NaN();
    arm_.start_cycle(now_ns_);
    step_devices();
    static_cast<void>(arm_.receive(now_ns_ + kMillisecond_ns, feedback_));
    arm_.command(now_ns_ + kMillisecond_ns, request_of(operation), position);
    pass(kMillisecond_ns * cell().robot.cycle_us / 1000);
    check(feedback_);
  }

  void step_devices() override {
    motors_.step();
    sensor_.step(now_ns_);
    ReceivedFrame unheard;
    while (intruder_.receive(unheard)) {
    }
  }

  void check_command(const CanFrame& frame) const {
    check_sent(frame);
    if (frame.id == 0 || frame.id > 6) return;
    must(frame.length == 8, "a motor is sent eight bytes");
    bool special = true;
    for (unsigned i = 0; i < 7; ++i) special = special && frame.data[i] == 0xFF;
    must(!special || frame.data[7] != 0xFE, "no motor's zero is set");
    must(!special || frame.data[7] != 0xFC || fault().kind == ArmFaultKind::kNone,
         "no motor is switched on in fault");
  }

  sim::VirtualBus bus_{{.bitrate_bps = 0}};
  CanBus& master_{bus_.attach()};
  mit::MitArm arm_{cell(), master_};
  ScriptedMotors motors_{bus_.attach()};
  ScriptedNode sensor_{ScriptedNode::Kind::kSensor, cell().robot.sensor.node, bus_.attach()};
  CanBus& intruder_{bus_.attach()};
  tests::FrameFilter filter_{bus_, [this](const CanFrame& frame, std::size_t end) {
                               if (end == 0) check_command(frame);
                               return true;
                             }};
  ArmFeedback feedback_;
  std::int64_t now_ns_ = 1'000'000'000;
};

}  // namespace

// NOLINTNEXTLINE(readability-identifier-naming): libFuzzer's name
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  ByteReader in(std::span(data, size));
  Bench().run(in);
  return 0;
}

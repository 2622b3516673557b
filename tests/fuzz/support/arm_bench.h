#pragma once
// What the fuzzers of both arms' masters share: bring-up, then operations, each a byte and its
// arguments, and what holds whatever arrives.
//
// Input: one byte (bit 0: traffic already during bring-up), then operations. Of an operation's byte
// the lower three bits say what it is: 0, 1 a cycle; 2 as the arm's own bench has it; 3 a new
// bring-up after a fault; 4 any frame; 5 one that the master listens to, of its usual length; 6 one
// of another length, or many; 7 a knob.

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>

#include "hw/arm/device_arm.h"
#include "shared/base/bytes.h"
#include "shared/ports/arm.h"
#include "sim/cell/bus/virtual_bus.h"
#include "tests/fuzz/support/must.h"

namespace tenon::fuzz {

inline constexpr std::int64_t kMillisecond_ns = 1'000'000;

class ArmBench {
 public:
  ArmBench() = default;
  ArmBench(const ArmBench&) = delete;
  ArmBench& operator=(const ArmBench&) = delete;
  virtual ~ArmBench() = default;

  void run(ByteReader& in) {
    const bool disturbed = (in.read<std::uint8_t>() & 1U) != 0;
    if (!bring_up(disturbed, in)) return;
    for (int i = 0; i < kOperationsMax && in.remaining() > 0; ++i) {
      if (!operate(in)) return;
    }
  }

 protected:
  [[nodiscard]] virtual hw::DeviceArm& arm() = 0;
  [[nodiscard]] virtual sim::VirtualBus& bus() = 0;
  [[nodiscard]] virtual CanBus& intruder() = 0;
  [[nodiscard]] virtual std::int64_t& now_ns() = 0;
  /// Identifiers that the master listens to.
  [[nodiscard]] virtual const std::array<std::uint16_t, 16>& heard() const = 0;
  virtual void step_devices() = 0;
  virtual void cycle(std::uint8_t operation, ByteReader& in) = 0;
  virtual void go_on(std::uint8_t operation, ByteReader& in) = 0;
  virtual void turn_knob(std::uint8_t operation, ByteReader& in) = 0;

  void pass(std::int64_t time_ns) {
    now_ns() += time_ns;
    bus().advance(now_ns());
  }
  [[nodiscard]] static ArmRequest request_of(std::uint8_t operation) {
    constexpr std::array<ArmRequest, 4> kRequests = {ArmRequest::kEnabled, ArmRequest::kDisabled,
                                                     ArmRequest::kQuickStop, ArmRequest::kEnabled};
    return kRequests[operation >> 3U & 3U];
  }
  [[nodiscard]] const ArmFault& fault() const { return fault_; }

  void check(const ArmFeedback& feedback) {
    for (const JointVector* values : {&feedback.position, &feedback.effort}) {
      for (const double value : *values) must(std::isfinite(value), "feedback is made of numbers");
    }
    must(feedback.wrench.allFinite(), "and so is the wrench");
    must(feedback.joints_fresh >> arm().joint_count() == 0,
         "joints that there are not do not answer");
    must((feedback.joints_off & ~feedback.joints_fresh) == 0,
         "who is silent says nothing of power");
    const ArmFault fault = arm().fault();
    const bool faulty = arm().state() == ArmState::kFault;
    must(faulty == (fault.kind != ArmFaultKind::kNone), "there is a fault exactly in fault");
    must(fault_.kind == ArmFaultKind::kNone ||
             (fault_.kind == fault.kind && fault_.node == fault.node),
         "the first fault stays");
    fault_ = fault;
  }
  static void check_sent(const CanFrame& frame) {
    must(frame.length <= 8 && frame.id <= 0x7FF && !frame.extended && !frame.remote,
         "the master sends data frames of 11 bits");
  }

 private:
  static constexpr int kOperationsMax = 400;
  static constexpr int kBringUpMax_ms = 700;
  static constexpr int kDisturbedBringUpMax_ms = 3000;

  bool bring_up(bool disturbed, ByteReader& in) {
    for (int i = 0; i < (disturbed ? kDisturbedBringUpMax_ms : kBringUpMax_ms); ++i) {
      if (arm().prepare(now_ns())) return true;
      if (arm().state() == ArmState::kFault) {
        must(disturbed, "an undisturbed bring-up succeeds");
        must(arm().fault().kind != ArmFaultKind::kNone, "a fault has a kind");
        return false;
      }
      step_devices();
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
        go_on(operation, in);
        return true;
      case 3:  // starts over after a fault
        if (arm().state() != ArmState::kFault) return true;
        fault_ = {};
        bus().set_up(true);
        bus().set_bus_off(0, false);
        return bring_up(true, in);
      default:
        disturb(operation, in);
        return true;
    }
  }

  void disturb(std::uint8_t operation, ByteReader& in) {
    switch (operation & 7U) {
      case 4: {
        CanFrame frame;
        frame.id = in.read<std::uint16_t>() & 0x7FFU;
        frame.extended = (operation & 0x80U) != 0;
        frame.remote = (operation & 0x40U) != 0;
        return inject(frame, in.read<std::uint8_t>() % 9, 1, in);
      }
      case 5:
        return inject({.id = heard()[operation >> 4U]}, 8, 1, in);
      case 6: {
        const CanFrame frame{.id = heard()[operation >> 4U]};
        const auto length = in.read<std::uint8_t>();
        return inject(frame, length % 9, length >= 0xF0 ? 600 : 1, in);
      }
      case 7:
        return turn_knob(operation, in);
      default:
        return;
    }
  }

  void inject(CanFrame frame, unsigned length, int times, ByteReader& in) {
    frame.length = static_cast<std::uint8_t>(length);
    for (unsigned i = 0; i < length; ++i) frame.data[i] = in.read<std::uint8_t>();
    for (int i = 0; i < times; ++i) static_cast<void>(intruder().send(frame));
  }

  ArmFault fault_;
};

}  // namespace tenon::fuzz

// What the CANopen master decodes, without nodes that answer: the parts of an arm in operation, or
// its bring-up, are made in microseconds, fed frames, and thrown away. canopen_master.cpp has the
// whole of it, with nodes, at a hundredth of the runs.
//
// Input: one byte (bit 0: bring-up), then operations, each a byte and its arguments.

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include "hw/arm/arm_intake.h"
#include "hw/arm/arm_output.h"
#include "hw/arm/arm_supervision.h"
#include "hw/arm/bring_up.h"
#include "hw/arm/cob_ids.h"
#include "hw/sensors/canopen_wrench_source.h"
#include "shared/base/bytes.h"
#include "tests/fuzz/support/must.h"
#include "tests/hw/gantry_on_bus.h"

namespace {

using namespace tenon;
using namespace tenon::hw;
using fuzz::must;

constexpr int kOperationsMax = 400;
constexpr std::int64_t kMillisecond_ns = 1'000'000;
constexpr std::uint32_t kAllJoints = 0b111;

// What the master listens to; joints are nodes 1 to 3, the sensor node 4.
constexpr std::array<std::uint16_t, 16> kHeard = {0x190, 0x191, 0x192, 0x181, 0x182, 0x081,
                                                  0x084, 0x581, 0x582, 0x583, 0x584, 0x701,
                                                  0x702, 0x703, 0x704, 0x080};

/// Hands out what it is fed, and looks at what it is sent.
class FedBus final : public CanBus {
 public:
  void feed(const CanFrame& frame) { fed_.push_back(frame); }
  void set_full(bool full) { full_ = full; }

  /// To the last SDO request, for an upload `value`.
  [[nodiscard]] CanFrame answer(std::uint32_t value) const {
    CanFrame frame = request_;
    const bool upload = request_.data[0] == 0x40;
    frame.id = request_.id - 0x80U;
    frame.data[0] = upload ? 0x43 : 0x60;
    for (unsigned i = 0; i < 4; ++i) {
      frame.data[4 + i] = upload ? static_cast<std::uint8_t>(value >> 8 * i) : std::uint8_t{0};
    }
    return frame;
  }

  SendResult send(const CanFrame& frame) noexcept override {
    must(frame.length <= 8 && frame.id <= 0x7FF && !frame.extended && !frame.remote,
         "the master sends data frames of 11 bits");
    if ((frame.id & 0x780U) == 0x600) request_ = frame;
    if (full_) ++status_.send_failures;
    return full_ ? SendResult::kQueueFull : SendResult::kSent;
  }
  bool receive(ReceivedFrame& received) noexcept override {
    if (next_ == fed_.size()) return false;
    received.frame = fed_[next_++];
    return true;
  }
  void flush() noexcept override {}
  void wait(std::int64_t /*at_most_ns*/) noexcept override {}
  [[nodiscard]] CanBusStatus status() const noexcept override { return status_; }

 private:
  CanFrame request_;
  std::vector<CanFrame> fed_;
  std::size_t next_ = 0;
  bool full_ = false;
  CanBusStatus status_;
};

const Robot& robot() {
  static const Robot gantry = gantry_robot();
  return gantry;
}

std::vector<JointChannel> channels() {
  std::vector<JointChannel> all;
  for (const Joint& joint : robot().joints) all.emplace_back(joint, robot().cycle_us);
  return all;
}

CanFrame frame_of(std::uint8_t operation, ByteReader& in) {
  CanFrame frame{.id = kHeard[operation >> 4U], .length = 8};
  if ((operation & 3U) == 0) {  // any frame
    frame.id = in.read<std::uint16_t>() & 0x7FFU;
    frame.extended = (operation & 0x80U) != 0;
    frame.remote = (operation & 0x40U) != 0;
  }
  if ((operation & 3U) != 1) frame.length = in.read<std::uint8_t>() % 9;
  for (unsigned i = 0; i < frame.length; ++i) frame.data[i] = in.read<std::uint8_t>();
  return frame;
}

class Operation {
 public:
  Operation() {
    output_.begin(now_ns_);
    supervision_.begin(now_ns_);
    intake_.limit_force({Vector3::Zero(), 60.0});
  }

  void run(ByteReader& in) {
    for (int i = 0; i < kOperationsMax && in.remaining() > 0; ++i) {
      const auto operation = in.read<std::uint8_t>();
      if ((operation & 7U) == 7) {
        bus_.set_full((operation & 0x80U) != 0);
        now_ns_ += kMillisecond_ns * in.read<std::uint8_t>();
      } else if ((operation & 4U) != 0) {
        cycle(operation, in);
      } else {
        bus_.feed(frame_of(operation, in));
      }
    }
  }

 private:
  // As CanopenArm has it.
  void cycle(std::uint8_t operation, ByteReader& in) {
    constexpr std::array<ArmRequest, 4> kRequests = {ArmRequest::kEnabled, ArmRequest::kDisabled,
                                                     ArmRequest::kQuickStop, ArmRequest::kEnabled};
    const ArmRequest request = kRequests[operation >> 3U & 3U];
    JointVector position{};
    position.fill((operation & 0x80U) != 0 ? std::numeric_limits<double>::quiet_NaN()
                                           : in.read<std::int16_t>() * 1e-4);
    (void)intake_.drain(now_ns_, bus_);
    check();
    const bool was_enabled = supervision_.state() == ArmState::kEnabled;
    supervision_.check_heartbeats(now_ns_);
    if (intake_.close_cycle()) supervision_.check_feedback(intake_.feedback());
    if (was_enabled && request == ArmRequest::kEnabled) supervision_.check_setpoints(position);
    supervision_.advance(now_ns_, request);
    const bool follow = was_enabled && supervision_.state() == ArmState::kEnabled;
    if (supervision_.take_stop()) output_.send_stop();
    output_.send_setpoints(supervision_.granted(request), follow, position);
    output_.send_heartbeat(now_ns_);
    supervision_.check_sending(bus_.status());
    check();
    now_ns_ += 2 * kMillisecond_ns;
    (void)intake_.open_cycle(now_ns_, bus_);
    output_.send_sync();
    check();
  }

  void check() {
    const ArmFeedback& feedback = intake_.feedback();
    for (const JointVector* values : {&feedback.position, &feedback.effort}) {
      for (const double value : *values) must(std::isfinite(value), "feedback is made of numbers");
    }
    must(feedback.wrench.allFinite(), "and so is the wrench");
    must((feedback.joints_fresh & ~kAllJoints) == 0, "joints that there are not do not answer");
    must((feedback.joints_off & ~feedback.joints_fresh) == 0,
         "who is silent says nothing of power");
    const ArmFault& fault = supervision_.fault();
    const bool faulty = supervision_.state() == ArmState::kFault;
    must(faulty == (fault.kind != ArmFaultKind::kNone), "there is a fault exactly in fault");
    must(fault_.kind == ArmFaultKind::kNone ||
             (fault_.kind == fault.kind && fault_.node == fault.node),
         "the first fault stays");
    const bool stopped = faulty || supervision_.force_stopped_N() > 0.0;
    must(!stopped || supervision_.granted(ArmRequest::kEnabled) == ArmRequest::kQuickStop,
         "what is stopped is not enabled");
    fault_ = fault;
  }

  FedBus bus_;
  ArmCounters counters_;
  std::vector<JointChannel> joints_ = channels();
  CanopenWrenchSource source_{robot().sensor, {kForceCobId, kTorqueCobId}};
  ArmSupervision supervision_{robot(), joints_, counters_};
  ArmIntake intake_{robot(), joints_, source_, supervision_, counters_};
  ArmOutput output_{robot(), bus_, joints_, supervision_, counters_};
  ArmFault fault_;
  std::int64_t now_ns_ = 1'000'000'000;
};

void bring_up(ByteReader& in) {
  FedBus bus;
  BringUp work(robot());
  std::int64_t now_ns = 1'000'000'000;
  for (int i = 0; i < kOperationsMax && in.remaining() > 0; ++i) {
    const auto operation = in.read<std::uint8_t>();
    if ((operation & 4U) != 0) {
      now_ns += kMillisecond_ns * in.read<std::uint8_t>();
    } else if ((operation & 7U) == 3) {  // what it waits for, so often
      for (int k = 0; k <= operation >> 4U; ++k) {
        work.process(bus.answer(in.read<std::uint32_t>()), now_ns, bus);
        work.update(now_ns, bus);
      }
    } else {
      work.process(frame_of(operation, in), now_ns, bus);
    }
    work.update(now_ns, bus);
    const bool failed = work.state() == BringUp::State::kFailed;
    must(failed == (work.fault().kind != ArmFaultKind::kNone), "a failure has a name");
    if (failed || work.state() == BringUp::State::kDone) return;
  }
}

}  // namespace

// NOLINTNEXTLINE(readability-identifier-naming): libFuzzer's name
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  ByteReader in(std::span(data, size));
  if ((in.read<std::uint8_t>() & 1U) != 0) {
    bring_up(in);
  } else {
    Operation().run(in);
  }
  return 0;
}

#include "executor/export/run_events.h"

#include <utility>

#include "executor/recorded/named.h"
#include "executor/states/state_machine.h"
#include "shared/base/printable.h"
#include "shared/base/text.h"
#include "shared/motion/contact_signature.h"

namespace tenon::executor {
namespace {

/// Empty where the bus is well.
const char* bus_text(const tenon::run_status_t& m) {
  if (m.bus_known == 0) return "";
  if (m.bus_up == 0) return "the bus is down";
  if (m.bus_off != 0) return "the bus is off: its controller has given up";
  return m.error_passive != 0 ? "the bus is error passive: frames are not acknowledged" : "";
}

}  // namespace

std::vector<RunEvent> RunEvents::of(const tenon::cycle_state_t& m) {
  std::vector<RunEvent> events;
  if (std::exchange(state_, m.state) != m.state) {
    events.push_back({EventLevel::kInfo, to_string(static_cast<State>(m.state))});
  }
  if (std::exchange(end_reason_, m.end_reason) == 0 && m.end_reason != 0) {
    const auto reason = static_cast<EndReason>(m.end_reason);
    const EventLevel level = is_fault(reason) ? EventLevel::kError : EventLevel::kInfo;
    // What an arm's fault is, the end of the run says.
    events.push_back({level, "ends: " + named(reason, 0)});
  }
  return events;
}

std::vector<RunEvent> RunEvents::of(const tenon::step_event_t& m) {
  const auto bits = static_cast<std::uint16_t>(m.signature);
  std::string text = format("step %d: %s, holds %s", m.step, outcome_text(m.outcome),
                            to_string(ContactSignature{bits}).c_str());
  const std::string deviation = deviation_text(m);
  if (deviation.empty()) return {{EventLevel::kInfo, text}};
  return {{EventLevel::kError, text + "; " + deviation}};
}

std::string RunEvents::slip_text(const tenon::run_status_t& m) const {
  const auto joint = static_cast<std::size_t>(static_cast<std::uint8_t>(m.slipped_joint));
  const bool known = joint < joints_.size() && !joints_[joint].unit.empty();
  const std::string name = joint < joints_.size() ? joints_[joint].name : std::to_string(joint);
  return "the brake of joint " + name +
         format(" does not hold: it moved by %.3g %s", m.slipped,
                known ? joints_[joint].unit.c_str() + 1 : "m or rad");
}

std::vector<RunEvent> RunEvents::of(const tenon::run_status_t& m) {
  std::vector<RunEvent> events;
  if (std::exchange(awaited_step_, m.awaited_step) != m.awaited_step && m.awaited_step >= 0) {
    events.push_back({EventLevel::kInfo, format("waits before step %d", m.awaited_step)});
  }
  const bool paused = m.pace <= 0.0;
  if (std::exchange(paused_, paused) != paused) {
    events.push_back({EventLevel::kInfo, paused ? "paused" : "goes on"});
  }
  if (std::exchange(slipped_joint_, m.slipped_joint) < 0 && m.slipped_joint >= 0) {
    events.push_back({EventLevel::kError, slip_text(m)});
  }
  const std::string bus = bus_text(m);
  if (!std::exchange(bus_bad_, !bus.empty()) && !bus.empty()) {
    events.push_back({EventLevel::kError, bus});
  }
  return events;
}

std::vector<RunEvent> RunEvents::of(const tenon::run_setup_t& /*m*/) { return {}; }

std::vector<RunEvent> RunEvents::of(const tenon::run_summary_t& m) {
  const bool well = m.exit_code == 0;
  return {{well ? EventLevel::kInfo : EventLevel::kError,
           (well ? "done: " : "failed: ") + printable(m.message)}};
}

}  // namespace tenon::executor

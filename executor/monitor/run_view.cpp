#include "executor/monitor/run_view.h"

#include <cmath>
#include <optional>

#include "executor/monitor/run_model.h"
#include "executor/states/state_machine.h"
#include "executor/telemetry/telemetry.h"
#include "lcmtypes/received/received.h"
#include "lcmtypes/tenon/cycle_state_t.hpp"
#include "lcmtypes/tenon/run_summary_t.hpp"
#include "lcmtypes/tenon/step_event_t.hpp"
#include "shared/base/printable.h"
#include "shared/base/text.h"
#include "shared/motion/contact_signature.h"
#include "shared/motion/outcome.h"

namespace tenon::executor {
namespace {

constexpr std::size_t kTextMax = 400;

// Rounded to a unit, and without the sign of a zero.
double rounded(double value, double unit) { return std::round(value / unit) * unit + 0.0; }

}  // namespace

std::string RunView::take(std::string_view channel, std::span<const std::uint8_t> bytes) {
  if (channel == kCycleChannel) return shown<tenon::cycle_state_t>(bytes);
  if (channel == kStepChannel) return shown<tenon::step_event_t>(bytes);
  if (channel == kRunChannel) return shown<tenon::run_summary_t>(bytes);
  return {};
}

template <typename Message>
std::string RunView::shown(std::span<const std::uint8_t> bytes) {
  if (const std::optional<Message> message = decoded<Message>(bytes)) return show(*message);
  ++malformed_;
  return malformed_ == 1 ? "a message cannot be decoded and is left out; all are counted\n" : "";
}

std::string RunView::show(const tenon::cycle_state_t& m) {
  running_ = true;
  const auto state = static_cast<std::uint8_t>(m.state);
  if (state == state_) return {};
  state_ = state;
  return std::string(to_string(static_cast<State>(state))) + "\n";
}

std::string RunView::show(const tenon::step_event_t& m) {
  const auto way = [&](int axis) { return rounded(m.travelled[axis], 1e-4); };
  return format("step %d: %s (holds %s) after %.4f %.4f %.4f m, %.1f N, %.2f s%s\n", m.step,
                to_string(static_cast<Outcome>(m.outcome)), signature_text(m.signature).c_str(),
                way(0), way(1), way(2), m.peak_force_N, m.duration_s,
                m.deviation == 0 ? "" : ", not as planned");
}

std::string RunView::show(const tenon::run_summary_t& m) {
  running_ = false;
  const std::string message = shortened(printable(m.message), kTextMax);
  return format("%s: %s (%d steps, %lld late cycles)\n", m.exit_code == 0 ? "done" : "failed",
                message.c_str(), m.steps, static_cast<long long>(m.late_cycles));
}

}  // namespace tenon::executor

#include "executor/telemetry/run_view.h"

#include <cmath>
#include <optional>

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

std::string signature_text(std::int16_t bits) {
  return tenon::to_string(ContactSignature{static_cast<std::uint16_t>(bits)});
}

// Clocks of two runs may lie anywhere, and a time that came over the network too.
bool refresh_due(std::int64_t now_us, std::int64_t shown_us) {
  constexpr std::uint64_t kRefresh_us = 100'000;
  const auto now = static_cast<std::uint64_t>(now_us);
  const auto shown = static_cast<std::uint64_t>(shown_us);
  return now_us < shown_us || now - shown >= kRefresh_us;
}

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
  return malformed_ == 1 ? line() + "a message cannot be decoded and is left out; all are counted\n"
                         : "";
}

// Ends the line that is being refreshed.
std::string RunView::line() {
  const bool open = open_line_;
  open_line_ = false;
  return open ? "\r\033[K" : "";
}

std::string RunView::show(const tenon::cycle_state_t& m) {
  std::string text;
  const auto state = static_cast<std::uint8_t>(m.state);
  if (state != state_) {
    text = line() + to_string(static_cast<State>(state)) + "\n";
    state_ = state;
  }
  if (!terminal_ || !refresh_due(m.utime, shown_us_)) return text;
  shown_us_ = m.utime;
  const auto place = [&](int axis) { return rounded(m.pose_position_m[axis], 1e-4); };
  const auto force = [&](int axis) { return rounded(m.wrench[axis], 0.1); };
  open_line_ = true;
  return text + format(
                    "\r\033[Kstep %3d  x %+.4f %+.4f %+.4f m  f %+6.1f %+6.1f %+6.1f N  %-8s late "
                    "%d (%.0f us)",
                    m.step, place(0), place(1), place(2), force(0), force(1), force(2),
                    signature_text(m.signature).c_str(), m.late_cycles, 1e6 * m.wakeup_late_s);
}

std::string RunView::show(const tenon::step_event_t& m) {
  const auto way = [&](int axis) { return rounded(m.travelled[axis], 1e-4); };
  return line() + format("step %d: %s (holds %s) after %.4f %.4f %.4f m, %.1f N, %.2f s%s\n",
                         m.step, to_string(static_cast<Outcome>(m.outcome)),
                         signature_text(m.signature).c_str(), way(0), way(1), way(2),
                         m.peak_force_N, m.duration_s, m.deviation == 0 ? "" : ", not as planned");
}

std::string RunView::show(const tenon::run_summary_t& m) {
  const std::string message = shortened(printable(m.message), kTextMax);
  return line() + format("%s: %s (%d steps, %lld late cycles)\n",
                         m.exit_code == 0 ? "done" : "failed", message.c_str(), m.steps,
                         static_cast<long long>(m.late_cycles));
}

}  // namespace tenon::executor

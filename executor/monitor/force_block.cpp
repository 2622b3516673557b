// Forces and torques against the thresholds of contacts, and the whole against what ends the run.

#include <cmath>
#include <optional>

#include "executor/monitor/blocks.h"
#include "executor/states/state_machine.h"
#include "shared/base/text.h"
#include "shared/motion/contact_signature.h"

namespace tenon::executor {
namespace {

constexpr double kNear = 0.7;       // of the on-threshold
constexpr double kScale = 1.5;      // of the on-threshold: the bar's end
constexpr double kLimitNear = 0.5;  // of what ends the run
constexpr double kLimitClose = 0.8;

/// Of the step that runs; what a contact of an axis is decided by.
struct Trigger {
  double on = 0.0;  ///< N or Nm
  bool sensed = true;
  ContactSignature mask = kAllContacts;
};

std::optional<Trigger> trigger_of(const RunModel& model, int axis) {
  if (!model.setup || !model.cycle) return std::nullopt;
  const tenon::run_setup_t& setup = model.setup->message;
  const int step = model.move.step;
  if (step < 0 || step >= setup.step_count) return std::nullopt;
  const auto i = static_cast<std::size_t>(step);
  const auto axes = static_cast<unsigned>(setup.sensed_axes[i] & setup.compliant_axes);
  Trigger trigger;
  trigger.on = axis < 3 ? setup.force_on_N[i] : setup.torque_on_Nm[i];
  trigger.sensed = (axes >> static_cast<unsigned>(axis) & 1U) != 0;
  trigger.mask.bits = static_cast<std::uint16_t>(setup.trigger_mask[i]);
  if (!(trigger.on > 0.0)) return std::nullopt;
  return trigger;
}

struct Verdict {
  std::string narrow;
  std::string wide;
  Style style = Style::kGood;
};

Verdict verdict(int axis, double value, ContactSignature held,
                const std::optional<Trigger>& trigger) {
  const std::string name = axis_name(axis);
  if (held.sign(axis) != 0) {
    const std::string bit = (held.sign(axis) > 0 ? "+" : "-") + name;
    return {bit, "holds " + bit, Style::kContact};
  }
  if (!trigger) return {"", "", Style::kNormal};
  if (!trigger->sensed) return {"--", "not sensed", Style::kDim};
  const int sign = value < 0.0 ? -1 : +1;
  if (!trigger->mask.has(axis, sign)) return {"--", "no trigger", Style::kDim};
  const double share = std::abs(value) / trigger->on;
  if (share >= 1.0) return {"ON!", "above its threshold", Style::kBad};
  if (share >= kNear) return {"!", "near its trigger", Style::kWarn};
  return {"", "", Style::kGood};
}

const char* wrench_unit(int axis) { return axis < 3 ? "N" : "Nm"; }

Line axis_line(const RunModel& model, int axis, int width) {
  const double value = model.cycle->message.wrench[axis];
  const ContactSignature held{static_cast<std::uint16_t>(model.cycle->message.signature)};
  const std::optional<Trigger> trigger = trigger_of(model, axis);
  const Verdict tells = verdict(axis, value, held, trigger);
  Line line = line_of(format("%-2s ", axis_name(axis)));
  put(line, number(value, axis < 3 ? 1 : 3, 7, true) + format(" %-2s ", wrench_unit(axis)),
      tells.style);
  const bool wide = width >= kWide;
  const int tail = wide ? 37 : 10;
  if (trigger) {
    // Odd, so that zero has a column.
    const int columns = (width - static_cast<int>(line.size()) - tail - 1) / 2 * 2 + 1;
    const double end = kScale * trigger->on;
    put(line,
        Bar{columns, -end, end, value, 0.0, false, {-trigger->on, 0.0, trigger->on}, tells.style});
    put(line, number(100.0 * std::abs(value) / trigger->on, 0, 4) + " %", tells.style);
    if (wide) put(line, format(" of %4.3g %-2s ", trigger->on, wrench_unit(axis)));
  }
  put(line, " " + (wide ? tells.wide : tells.narrow), tells.style);
  return line;
}

Line limit_line(const RunModel& model, bool torque, int width) {
  const double* w = model.cycle->message.wrench + (torque ? 3 : 0);
  const double value = std::hypot(w[0], w[1], w[2]);
  const char* unit = torque ? "Nm" : "N";
  Line line = line_of(torque ? "|t|" : "|f|");
  const tenon::run_setup_t* setup = model.setup ? &model.setup->message : nullptr;
  const double fault = setup == nullptr ? 0.0
                       : torque         ? setup->torque_fault_Nm
                                        : setup->force_fault_N;
  const double limit = setup == nullptr ? 0.0
                       : torque         ? setup->torque_limit_Nm
                                        : setup->force_limit_N;
  const double share = fault > 0.0 ? value / fault : 0.0;
  const Style style = share >= kLimitClose  ? Style::kBad
                      : share >= kLimitNear ? Style::kWarn
                                            : Style::kGood;
  put(line, number(value, torque ? 3 : 1, 7) + format(" %-2s ", unit), style);
  if (!(fault > 0.0)) return line;
  const bool wide = width >= kWide;
  const std::string most = format(" of %4.3g %s", fault, unit);
  const std::string tail = wide ? format(", plan's limit %.3g %s", limit, unit) : "";
  const int columns = width - static_cast<int>(line.size() + most.size() + (wide ? 29 : 0));
  put(line, Bar{columns, 0.0, fault, value, 0.0, false, {limit}, style});
  put(line, most + tail);
  return line;
}

}  // namespace

Block force_block(const RunModel& model, int width) {
  Block block;
  block.title = line_of("FORCE   task axes, of the threshold", Style::kTitle);
  if (!model.cycle) return block;
  const auto state = static_cast<State>(model.cycle->message.state);
  if (state == State::kWaiting || state == State::kTaring) {
    block.lines.push_back(line_of("not tared yet: forces mean nothing", Style::kDim));
    return block;
  }
  for (int axis = 0; axis < 6; ++axis) block.lines.push_back(axis_line(model, axis, width));
  block.lines.push_back(limit_line(model, false, width));
  block.lines.push_back(limit_line(model, true, width));
  return block;
}

}  // namespace tenon::executor

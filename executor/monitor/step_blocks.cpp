// What runs, which step of it, and the steps before.

#include <algorithm>
#include <array>

#include "executor/monitor/blocks.h"
#include "executor/states/state_machine.h"
#include "shared/base/printable.h"
#include "shared/base/text.h"
#include "shared/motion/contact_signature.h"
#include "shared/motion/outcome.h"

namespace tenon::executor {
namespace {

const char* arm_text(int state) {
  constexpr std::array<const char*, 6> kTexts = {"unconfigured", "off",      "being enabled",
                                                 "enabled",      "stopping", "in fault"};
  return state >= 0 && state < static_cast<int>(kTexts.size())
             ? kTexts.at(static_cast<std::size_t>(state))
             : "?";
}

const char* phase_text(int phase) {
  constexpr std::array<const char*, 4> kTexts = {"moving", "probing", "settling", "done"};
  return phase >= 0 && phase < static_cast<int>(kTexts.size())
             ? kTexts.at(static_cast<std::size_t>(phase))
             : "?";
}

/// "+x 0.100 m, -rz 0.050 rad"
std::string move_text(const std::vector<double>& displacement) {
  std::string text;
  for (int axis = 0; axis < 6; ++axis) {
    const double d = displacement[static_cast<std::size_t>(axis)];
    if (d == 0.0) continue;
    text += format("%s%c%s %.3g %s", text.empty() ? "" : ", ", d < 0.0 ? '-' : '+', axis_name(axis),
                   std::abs(d), axis_unit(axis));
  }
  return text.empty() ? "no displacement" : text;
}

std::string expected_text(int outcomes) {
  std::string text;
  for (const Outcome outcome : kOutcomes) {
    if ((static_cast<unsigned>(outcomes) >> static_cast<unsigned>(outcome) & 1U) == 0) continue;
    text += (text.empty() ? "" : " or ") + std::string(to_string(outcome));
  }
  return text.empty() ? "nothing" : text;
}

double length_of(const std::vector<double>& d) {
  const double way = std::hypot(d[0], d[1], d[2]);
  return way > 0.0 ? way : std::hypot(d[3], d[4], d[5]);
}

const char* unit_of(const std::vector<double>& d) {
  return std::hypot(d[0], d[1], d[2]) > 0.0 ? "m" : "rad";
}

// The way that is done, against the way that is commanded and the way that is expected.
void add_progress(const RunModel& model, std::size_t step, int width, std::vector<Line>& lines) {
  const tenon::run_setup_t& setup = model.setup->message;
  const std::vector<double>& displacement = setup.displacement[step];
  const double from = setup.expected_from[step];
  const double to = setup.expected_to[step];
  const char* unit = unit_of(displacement);
  lines.push_back(line_of("expects " + expected_text(setup.expected[step])));
  put(lines.back(), width >= kWide ? format(" after %.4f to %.4f %s", from, to, unit) : "");
  if (width < kWide) lines.push_back(line_of(format(" after %.4f to %.4f %s", from, to, unit)));
  if (!model.move.whole) {
    lines.push_back(line_of("way unknown: joined in mid-step", Style::kDim));
    return;
  }
  const double way = way_along(displacement, model.move.start, pose_of(model.cycle->message));
  const Style style = way > to + 1e-3 ? Style::kWarn : Style::kGood;
  const std::string done = number(way, 4, 8, true) + " " + unit + " ";
  const std::string most = format(" of %.3g %s", length_of(displacement), unit);
  Line line = line_of(done, style);
  const int columns = width - static_cast<int>(done.size() + most.size());
  put(line,
      Bar{columns, 0.0, std::max(length_of(displacement), to), way, 0.0, false, {from, to}, style});
  put(line, most);
  lines.push_back(line);
  lines.push_back(line_of(format("%.1f s of at most %.3g s, %s", model.move.elapsed_s,
                                 setup.timeout_s[step], phase_text(model.cycle->message.phase))));
}

}  // namespace

Block run_block(const RunModel& model, int width) {
  Block block;
  block.title = line_of("RUN", Style::kTitle);
  if (model.setup) {
    const tenon::run_setup_t& setup = model.setup->message;
    const std::string what =
        setup.plan.empty() ? "identification" : "plan " + setup.plan + ", start " + setup.start;
    block.lines.push_back(line_of(shortened(what, 200)));
    block.lines.push_back(line_of(shortened("cell " + setup.cell + ", robot " + setup.robot, 200)));
  } else if (model.cycle) {
    block.lines = wrapped("limits and plan unknown: no TENON_SETUP (an old log, or not yet)", width,
                          2, Style::kDim);
  }
  if (!model.cycle) return block;
  const tenon::cycle_state_t& cycle = model.cycle->message;
  block.lines.push_back(line_of(format("%s, drives %s", to_string(static_cast<State>(cycle.state)),
                                       arm_text(cycle.arm_state))));
  return block;
}

Block step_block(const RunModel& model, int width) {
  Block block;
  block.title = line_of("STEP", Style::kTitle);
  if (!model.cycle || model.move.step < 0) return block;
  const tenon::cycle_state_t& cycle = model.cycle->message;
  const int number_of = model.move.step;
  Line line = line_of(format("step %d", number_of));
  const bool known = model.setup && number_of < model.setup->message.step_count;
  const auto step = static_cast<std::size_t>(number_of);
  if (known) {
    put(line, format(" (%d of %d): ", number_of + 1, model.setup->message.step_count));
    put(line, move_text(model.setup->message.displacement[step]));
  }
  block.lines.push_back(line);
  const bool runs = cycle.step >= 0 && !model.summary;
  if (known && runs) add_progress(model, step, width, block.lines);
  block.lines.push_back(line_of("holds " + signature_text(cycle.signature), Style::kContact));
  return block;
}

Block history_block(const RunModel& model, int width) {
  Block block;
  block.title = line_of("STEPS DONE  way, peak force", Style::kTitle);
  for (const tenon::step_event_t& m : model.steps) {
    const Style style = m.deviation == 0 ? Style::kNormal : Style::kBad;
    const char* outcome = to_string(static_cast<Outcome>(m.outcome));
    const std::string held = signature_text(m.signature);
    const std::vector<double> travelled(m.travelled, m.travelled + 6);
    const std::string way = number(length_of(travelled), 4, 7) + " " + unit_of(travelled);
    const std::string force = number(m.peak_force_N, 1, 6) + " N";
    Line line = line_of(format("%3d %-7s ", m.step, outcome), style);
    put(line, way + force, style);
    if (width >= kWide) {
      put(line, number(m.duration_s, 2, 8) + " s  holds " + held, style);
    } else {
      put(line, " " + held, style);
    }
    if (m.deviation != 0) put(line, width >= kWide ? "  NOT AS PLANNED" : " !", style);
    block.lines.push_back(line);
  }
  return block;
}

}  // namespace tenon::executor

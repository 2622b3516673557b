// The arm's side: joints against their limits, the bus, the loop's time.

#include <algorithm>
#include <cmath>

#include "executor/monitor/blocks.h"
#include "shared/base/printable.h"
#include "shared/base/text.h"

namespace tenon::executor {
namespace {

constexpr double kRoomNear = 0.10;  // of a joint's range
constexpr double kRoomClose = 0.02;
constexpr double kSilent_s = 0.02;
constexpr std::size_t kNameMost = 10;

Line joint_line(const RunModel& model, std::size_t joint, int name_columns, int width) {
  const double value = model.cycle->message.joint_position[joint];
  const int number_of = static_cast<int>(joint);
  const bool known = model.setup && number_of < model.setup->message.joint_count;
  const bool linear = known && model.setup->message.joint_linear[joint] != 0;
  Line line = fitted(line_of(shortened(joint_name(model, number_of), 60)), name_columns);
  put(line, " ");
  const std::string position =
      number(value, 4, 8, true) + (known ? linear ? " m   " : " rad " : "     ");
  if (model.joint_silent_s[joint] > kSilent_s) {
    put(line, position + format("NO ANSWER for %.2f s", model.joint_silent_s[joint]), Style::kBad);
    return line;
  }
  if (!known) {
    put(line, position);
    return line;
  }
  const double lower = model.setup->message.joint_lower[joint];
  const double upper = model.setup->message.joint_upper[joint];
  const bool to_upper = upper - value < value - lower;
  const double room = to_upper ? upper - value : value - lower;
  const double share = room / (upper - lower);
  const Style style = !(share >= kRoomClose) ? Style::kBad
                      : share < kRoomNear    ? Style::kWarn
                                             : Style::kGood;
  put(line, position, style);
  const bool wide = width >= kWide;
  const int tail = wide ? 30 : 7;
  put(line,
      Bar{width - static_cast<int>(line.size()) - tail, lower, upper, value, 0.0, true, {}, style});
  put(line, number(100.0 * share, 0, 4) + " %" + (style == Style::kGood ? " " : "!"), style);
  if (wide) {
    put(line,
        number(room, 4, 8) + (linear ? " m" : " rad") + (to_upper ? " to upper" : " to lower"),
        style);
  }
  return line;
}

std::string count(std::int64_t number) { return std::to_string(number); }

// Red where one is above zero.
void add_count(Line& line, const char* what, std::int64_t value, Style above = Style::kWarn) {
  put(line, (line.empty() ? "" : "  ") + std::string(what) + " " + count(value),
      value > 0 ? above : Style::kNormal);
}

Line milliseconds(const char* what, double now_s, double worst_s, double period_s) {
  const Style style = !(period_s > 0.0)          ? Style::kNormal
                      : !(worst_s < period_s)    ? Style::kBad
                      : worst_s > 0.5 * period_s ? Style::kWarn
                                                 : Style::kGood;
  Line line = line_of(format("%-9s", what));
  put(line, number(1e3 * now_s, 3, 7) + " ms, worst" + number(1e3 * worst_s, 3, 8) + " ms", style);
  return line;
}

}  // namespace

Block joint_block(const RunModel& model, int width) {
  Block block;
  block.title = line_of("JOINTS  place in range, room left", Style::kTitle);
  if (!model.cycle) return block;
  const std::size_t joints =
      std::min(model.cycle->message.joint_position.size(), model.joint_silent_s.size());
  std::size_t longest = 1;
  for (std::size_t i = 0; i < joints; ++i) {
    longest = std::max(longest, joint_name(model, static_cast<int>(i)).size());
  }
  const int columns = static_cast<int>(std::min(longest, kNameMost));
  for (std::size_t i = 0; i < joints; ++i) {
    block.lines.push_back(joint_line(model, i, columns, width));
  }
  return block;
}

Block bus_block(const RunModel& model, int width) {
  Block block;
  block.title = line_of("BUS     counts of frames", Style::kTitle);
  if (!model.status || model.status->message.bus_known == 0) {
    if (model.cycle) block.lines.push_back(line_of("not told", Style::kDim));
    return block;
  }
  const tenon::run_status_t& m = model.status->message;
  const double most = model.setup ? model.setup->message.bus_load_most : 1.0;
  const Style style = m.bus_load_worst > most         ? Style::kBad
                      : m.bus_load_worst > 0.9 * most ? Style::kWarn
                                                      : Style::kGood;
  Line load = line_of("load " + number(100.0 * m.bus_load, 0, 3) + " % ", style);
  const std::string tail = format(" most %.0f %%", 100.0 * most);
  put(load, Bar{width - static_cast<int>(load.size() + tail.size()),
                0.0,
                1.0,
                m.bus_load,
                0.0,
                false,
                {most},
                style});
  put(load, tail);
  block.lines.push_back(load);
  block.lines.push_back(line_of(number(m.frame_rate_hz, 0, 1 + 5) + " frames/s, at most" +
                                number(100.0 * m.bus_load_worst, 0, 4) + " % stuffed"));
  Line counts;
  add_count(counts, "unsent", m.send_failures);
  add_count(counts, "error frames", m.error_frames);
  add_count(counts, "lost", m.overruns);
  block.lines.push_back(counts);
  if (m.error_passive != 0)
    block.lines.push_back(line_of("error passive: check cable and rate", Style::kBad));
  return block;
}

Block timing_block(const RunModel& model, int width, std::int64_t now_ns) {
  Block block;
  block.title = line_of("TIMING  worst of 10 s, counts of cycles", Style::kTitle);
  if (model.cycle) {
    const tenon::cycle_state_t& m = model.cycle->message;
    const double period_s = model.setup ? model.setup->message.cycle_s : 0.0;
    block.lines.push_back(
        milliseconds("wakes late", m.wakeup_late_s, model.wakeup_late_s.value(), period_s));
    block.lines.push_back(milliseconds("computes", m.compute_s, model.compute_s.value(), period_s));
    Line line = line_of(model.setup ? format("period %.3g ms", 1e3 * period_s) : "");
    add_count(line, "late", m.late_cycles);
    add_count(line, "not told", m.records_dropped);
    block.lines.push_back(line);
    // A wrench that no move sees any more is nobody's business.
    const std::string wrench =
        m.end_reason == 0 ? format(", wrench %.0f ms old", 1e3 * model.wrench_age_s) : "";
    line = line_of(format("cycle %.1f s ago", RunModel::age_s(*model.cycle, now_ns)) + wrench,
                   RunModel::age_s(*model.cycle, now_ns) > 1.0 ? Style::kBad : Style::kNormal);
    block.lines.push_back(fitted(std::move(line), width));
  }
  if (model.malformed > 0) {
    block.lines.push_back(line_of(
        count(static_cast<std::int64_t>(model.malformed)) + " messages not decoded", Style::kBad));
  }
  return block;
}

}  // namespace tenon::executor

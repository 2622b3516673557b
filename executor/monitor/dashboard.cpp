#include "executor/monitor/dashboard.h"

#include <algorithm>
#include <array>

#include "executor/monitor/blocks.h"
#include "shared/base/text.h"

namespace tenon::executor {
namespace {

constexpr int kTwoColumnsFrom = 80;
constexpr int kThreeColumnsFrom = 150;
constexpr int kGap = 2;
constexpr std::size_t kBannerLinesLeast = 3;
constexpr std::size_t kNoticeLinesMost = 3;

// How the body is spaced, from airy to tight.
struct Spacing {
  bool titles;
  bool blanks;
};
constexpr std::array<Spacing, 3> kSpacings = {{{true, true}, {true, false}, {false, false}}};

std::vector<Line> stacked(const std::vector<Block>& blocks, const Spacing& spacing) {
  std::vector<Line> lines;
  for (const Block& block : blocks) {
    if (block.lines.empty()) continue;
    if (spacing.blanks && !lines.empty()) lines.emplace_back();
    if (spacing.titles) lines.push_back(block.title);
    lines.insert(lines.end(), block.lines.begin(), block.lines.end());
  }
  return lines;
}

std::vector<Line> beside(const std::vector<std::vector<Line>>& columns, int width) {
  std::size_t rows = 0;
  for (const auto& column : columns) rows = std::max(rows, column.size());
  std::vector<Line> lines(rows);
  for (std::size_t row = 0; row < rows; ++row) {
    for (std::size_t c = 0; c < columns.size(); ++c) {
      const Line part = fitted(row < columns[c].size() ? columns[c][row] : Line{}, width);
      if (c > 0) put(lines[row], std::string(kGap, ' '));
      lines[row].insert(lines[row].end(), part.begin(), part.end());
    }
  }
  return lines;
}

int columns_across(int width) {
  return width < kTwoColumnsFrom ? 1 : width < kThreeColumnsFrom ? 2 : 3;
}

std::vector<std::vector<Block>> columns_of(const RunModel& model, const View& view, int columns,
                                           int width) {
  const Block run = run_block(model, width);
  const Block step = step_block(model, width);
  const Block force = force_block(model, width);
  const Block joints = joint_block(model, width);
  const Block bus = bus_block(model, width);
  const Block timing = timing_block(model, width, view.now_ns);
  if (columns == 1) return {{run, step, force, joints, bus, timing}};
  if (columns == 2) return {{run, step, force}, {joints, bus, timing}};
  return {{run, step, history_block(model, width)}, {force}, {joints, bus, timing}};
}

// What is left of the window's height takes the steps that are done.
void add_history(const RunModel& model, int width, std::size_t height, std::vector<Line>& lines) {
  constexpr std::size_t kLeast = 2;
  const Block history = history_block(model, width);
  if (history.lines.empty() || lines.size() >= height) return;
  if (lines.size() + kLeast > height) {
    lines.push_back(line_of("steps done: make the window higher", Style::kWarn));
    return;
  }
  if (lines.size() + kLeast < height) lines.emplace_back();
  lines.push_back(history.title);
  for (const Line& line : history.lines) {
    if (lines.size() < height) lines.push_back(line);
  }
}

std::vector<Line> body(const RunModel& model, const View& view, std::size_t height) {
  const int columns = columns_across(view.width);
  const int width = (view.width - kGap * (columns - 1)) / columns;
  std::vector<Line> lines;
  const auto blocks = columns_of(model, view, columns, width);
  const bool has_history = columns < 3 && !history_block(model, width).lines.empty();
  for (const Spacing& spacing : kSpacings) {
    std::vector<std::vector<Line>> stacks;
    stacks.reserve(blocks.size());
    for (const auto& column : blocks) stacks.push_back(stacked(column, spacing));
    lines = beside(stacks, width);
    const std::size_t more = has_history && spacing.titles ? 1 : 0;
    if (lines.size() + more <= height) break;
  }
  if (columns < 3) add_history(model, view.width, height, lines);
  if (lines.size() > height && height > 0) {
    const std::size_t hidden = lines.size() - height + 1;
    lines.resize(height);
    lines.back() = line_of(format("%zu lines more: make the window higher", hidden), Style::kWarn);
  }
  return lines;
}

std::size_t rows_at_the_tightest(const RunModel& model, const View& view) {
  const int columns = columns_across(view.width);
  const int width = (view.width - kGap * (columns - 1)) / columns;
  std::size_t rows = 0;
  for (const auto& column : columns_of(model, view, columns, width)) {
    rows = std::max(rows, stacked(column, kSpacings.back()).size());
  }
  return rows;
}

// A message in full, which may say what nobody watches any more, comes before blank lines, titles
// and the steps that are done. In a window without room for it, it may take half.
std::vector<Line> banner_lines(const RunModel& model, const View& view, std::size_t height,
                               std::size_t foot) {
  const std::size_t others = foot + rows_at_the_tightest(model, view);
  const std::size_t room = std::max(height > others ? height - others : 0, height / 2);
  std::vector<Line> lines;
  for (const Banner& banner :
       banners(model, view.source, view.source_ended, view.source_lacks, view.now_ns)) {
    const std::size_t left = room > lines.size() ? room - lines.size() : 0;
    for (Line& line :
         wrapped(banner.text, view.width, std::max(left, kBannerLinesLeast), banner.style)) {
      lines.push_back(fitted(std::move(line), view.width, banner.style));
    }
  }
  return lines;
}

// A recording comes first: what is being done.
Line key_line(const View& view) {
  Line line;
  if (view.keys) {
    put(line, view.recording.empty() ? " q quit  r record" : " q quit  r stop", Style::kKeys);
  } else {
    put(line, " no keyboard", Style::kKeys);
  }
  if (!view.recording.empty()) {
    put(line,
        format("  REC %llu messages to %s", static_cast<unsigned long long>(view.recorded),
               view.recording.c_str()),
        Style::kKeys);
  } else {
    put(line, "  " + view.source, Style::kKeys);
  }
  return fitted(std::move(line), view.width, Style::kKeys);
}

}  // namespace

std::vector<Line> dashboard(const RunModel& model, const View& view) {
  const auto height = static_cast<std::size_t>(std::max(view.height, 0));
  std::vector<Line> foot;
  if (!view.notice.empty()) {
    foot = wrapped(view.notice, view.width, kNoticeLinesMost,
                   view.notice_bad ? Style::kBad : Style::kGood);
  }
  foot.push_back(key_line(view));
  std::vector<Line> lines = banner_lines(model, view, height, foot.size());
  const std::size_t taken = lines.size() + foot.size();
  std::vector<Line> middle = body(model, view, height > taken ? height - taken : 0);
  if (height > taken) middle.resize(height - taken);
  if (stale(model, view.source_ended, view.now_ns)) {
    for (Line& line : middle) {
      for (Glyph& glyph : line) glyph.style = Style::kDim;
    }
  }
  if (height > taken) lines.insert(lines.end(), middle.begin(), middle.end());
  lines.insert(lines.end(), foot.begin(), foot.end());
  lines.resize(height);
  for (Line& line : lines) line = fitted(std::move(line), view.width);
  return lines;
}

}  // namespace tenon::executor

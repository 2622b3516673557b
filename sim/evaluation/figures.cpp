#include "sim/evaluation/figures.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <utility>

#include "shared/base/text.h"
#include "shared/task/pose_error.h"
#include "shared/task/spread.h"
#include "sim/evaluation/outline.h"
#include "sim/evaluation/plot.h"

namespace tenon::sim {
namespace {

constexpr int kWide_px = 660;
constexpr int kNarrow_px = 400;
constexpr const char* kGoalColour = "#2a7f3f";
constexpr double kEndsReach = 1.5;  ///< of the figure of ends, in tolerances

struct Extent {
  Point low = Point::Constant(1e9);
  Point high = Point::Constant(-1e9);

  void add(const Point& point) {
    low = low.cwiseMin(point);
    high = high.cwiseMax(point);
  }
  void add(const std::vector<Point>& points) {
    for (const Point& point : points) add(point);
  }
  [[nodiscard]] Extent widened(double share) const {
    const Point margin = Point::Constant(share * (high - low).maxCoeff());
    return {low - margin, high + margin};
  }
  [[nodiscard]] Extent within(const Extent& other) const {
    return {low.cwiseMax(other.low), high.cwiseMin(other.high)};
  }
};

Plot::Axis axis_of(const Extent& extent, const drawing::View& view, int up) {
  return {extent.low[up], extent.high[up],
          std::string(axis_name(up == 0 ? view.right : view.up)) + " (mm)"};
}

Plot plot_of(const Extent& extent, const drawing::View& view, int width_px) {
  return Plot::to_scale(width_px, width_px, axis_of(extent, view, 0), axis_of(extent, view, 1));
}

std::string side_of(const drawing::View& view) { return std::string(view.title) + ": "; }

std::string title_of(const Task& task, const Run& run) {
  return format("run %zu, ", run.trial.number) + out_text(task, run.trial.distance) + ": " +
         run.result.ending;
}

/// Seen from the environment it is the tool that is off.
Vector3 began_at(const Task& task, const Candidate& candidate, const Run& run) {
  const Pose environment = environment_pose(run.trial.offset, task.error_about_m);
  return seen_from(environment, candidate.start.pose).position_m;
}

std::optional<Point> ended_at(const Task& task, const Run& run, const drawing::View& view) {
  if (!run.result.error) return std::nullopt;
  return view.mm(task.goal.position_m + run.result.error->head<3>());
}

/// Successes as dots, then a cross for every other run, where `at` says; nothing where it says
/// none.
template <typename At>
void mark(Plot& plot, const Task& task, const Candidate& candidate, double size_px, const At& at) {
  std::vector<Point> succeeded;
  for (const auto& [number, run] : candidate.runs) {
    if (classify(run.result) == TrialClass::kSucceeded) succeeded.push_back(*at(run));
  }
  plot.dots(succeeded, size_px, kSucceededColour);
  for (const TrialClass kind : {TrialClass::kStopped, TrialClass::kDoneButWrong}) {
    std::vector<std::pair<Point, std::string>> failed;
    for (const auto& [number, run] : candidate.runs) {
      if (classify(run.result) != kind) continue;
      const std::optional<Point> place = at(run);
      if (place) failed.emplace_back(*place, title_of(task, run));
    }
    plot.crosses(failed, 1.6 * size_px, colour_of(kind));
  }
}

void draw_part(Plot& plot, const Task& task, const Pose& pose, const drawing::View& view,
               std::string_view style) {
  for (const Shape& shape : task.held) plot.polygon(outline(shape, pose, view), style);
}

void draw_environment(Plot& plot, const Task& task, const drawing::View& view) {
  const auto bumps = [&](const Shape& shape) {
    return std::any_of(task.held.begin(), task.held.end(), [&](const Shape& held) {
      return share_depth(shape, Pose{}, held, task.goal, view);
    });
  };
  for (const bool wanted : {false, true}) {
    const char* style = wanted ? "fill='#8d8577'" : "fill='#ece7db'";
    for (const Shape& shape : task.environment) {
      if (bumps(shape) == wanted) plot.polygon(outline(shape, Pose{}, view), style);
    }
  }
}

Extent extent_of_runs(const Task& task, const Candidate& candidate, const drawing::View& view) {
  Extent content;
  for (const auto& [number, run] : candidate.runs) {
    if (const auto ended = ended_at(task, run, view)) {
      content.add(view.mm(began_at(task, candidate, run)));
      for (const Vector3& reached_m : run.result.path_m) content.add(view.mm(reached_m));
      content.add(*ended);
    }
  }
  for (const Shape& shape : task.held) {
    content.add(outline(shape, candidate.start.pose, view));
    content.add(outline(shape, task.goal, view));
  }
  Extent all = content;
  for (const Shape& shape : task.environment) all.add(outline(shape, Pose{}, view));
  return all.within(content.widened(1.0)).widened(0.03);
}

/// Numbers as a table has them.
std::string percent(const Rate& rate) {
  return rate.count == 0 ? "" : format("%.0f", 1e2 * rate.value());
}

/// From red over pale grey to blue.
std::string heat(double value) {
  constexpr std::array<std::array<double, 3>, 3> kStops = {
      {{178, 24, 43}, {243, 238, 232}, {31, 110, 180}}};
  const std::size_t from = value < 0.5 ? 0 : 1;
  const double part = 2.0 * value - static_cast<double>(from);
  std::array<int, 3> mixed{};
  for (std::size_t i = 0; i < 3; ++i) {
    mixed[i] =
        static_cast<int>(std::lround((1.0 - part) * kStops[from][i] + part * kStops[from + 1][i]));
  }
  return format("#%02x%02x%02x", static_cast<unsigned>(mixed[0]), static_cast<unsigned>(mixed[1]),
                static_cast<unsigned>(mixed[2]));
}

std::string curve(const Bins& bins, const std::vector<Rate>& rates) {
  Plot plot(kWide_px, 300, {bins.low, bins.high, bins.quantity}, {0.0, 104.0, "succeeded (%)"});
  std::vector<std::pair<Point, Point>> spans;
  std::vector<std::pair<Point, Point>> steps;
  std::vector<Point> rates_at;
  for (std::size_t i = 0; i < rates.size(); ++i) {
    if (rates[i].count == 0) continue;
    const double middle = 0.5 * (bins.edges(i).low + bins.edges(i).high);
    const Interval interval = rates[i].interval();
    spans.emplace_back(Point(middle, 1e2 * interval.low), Point(middle, 1e2 * interval.high));
    rates_at.emplace_back(middle, 1e2 * rates[i].value());
    if (rates_at.size() > 1) steps.emplace_back(rates_at[rates_at.size() - 2], rates_at.back());
  }
  plot.lines(steps, "stroke='#1f6eb4' stroke-opacity='.35' stroke-width='2'");
  plot.lines(spans, "stroke='#1f6eb4' stroke-width='2'");
  plot.dots(rates_at, 8.0, kSucceededColour);
  return plot.svg("Success over " + bins.quantity);
}

std::string map(const std::vector<Bins>& by, const std::vector<std::vector<Rate>>& rates) {
  Plot plot(kWide_px, 460, {by[0].low, by[0].high, by[0].quantity},
            {by[1].low, by[1].high, by[1].quantity});
  for (std::size_t row = 0; row < rates.size(); ++row) {
    for (std::size_t column = 0; column < rates[row].size(); ++column) {
      const Rate& rate = rates[row][column];
      const Interval x = by[0].edges(column);
      const Interval y = by[1].edges(row);
      const Interval interval = rate.interval();
      plot.rectangle({x.low, y.low}, {x.high, y.high},
                     "stroke='#fff' fill='" + (rate.count == 0 ? "#fff" : heat(rate.value())) + "'",
                     format("%zu of %zu, 95 %% interval %.1f to %.1f %%", rate.successes,
                            rate.count, 1e2 * interval.low, 1e2 * interval.high));
      const bool dark = rate.value() < 0.2 || rate.value() > 0.8;
      plot.text({0.5 * (x.low + x.high), 0.5 * (y.low + y.high)}, percent(rate),
                dark ? "text-anchor='middle' dy='4' fill='#fff'" : "text-anchor='middle' dy='4'");
    }
  }
  return plot.svg("Success over " + by[0].quantity + " and " + by[1].quantity);
}

/// The standard deviations that the plan holds for, or the bounds. @param sigma mm
void mark_reach(Plot& plot, const Task& task, const Point& sigma) {
  if (task.errors == Distribution::kUniform) {
    const Point bound = task.particle_sigmas * sigma;
    plot.rectangle(-bound, bound, "fill='none' stroke='#777' stroke-width='1.5'");
    return;
  }
  for (const double sigmas : {2.0, 3.0}) {
    plot.circle(Point::Zero(), sigmas * sigma,
                sigmas == task.particle_sigmas
                    ? "fill='none' stroke='#777' stroke-width='1.5'"
                    : "fill='none' stroke='#999' stroke-dasharray='4 4'");
    plot.text({0.0, sigmas * sigma.y()}, format("%g\u03c3", sigmas),
              "text-anchor='middle' dy='-4' fill='#777'");
  }
}

}  // namespace

const char* colour_of(TrialClass trial_class) {
  switch (trial_class) {
    case TrialClass::kSucceeded:
      return kSucceededColour;
    case TrialClass::kStopped:
      return kStoppedColour;
    case TrialClass::kDoneButWrong:
      return kWrongColour;
  }
  return "#000";
}

std::string figure_of_runs(const Evaluation& evaluation, const Candidate& candidate,
                           const drawing::View& view) {
  const Task& task = evaluation.task;
  Plot plot = plot_of(extent_of_runs(task, candidate, view), view, kWide_px);
  draw_environment(plot, task, view);
  draw_part(plot, task, candidate.start.pose, view,
            "fill='#1f6eb4' fill-opacity='.08' stroke='#1f6eb4' stroke-dasharray='5 4'");
  draw_part(plot, task, task.goal, view,
            "fill='#2a7f3f' fill-opacity='.14' stroke='#2a7f3f' stroke-width='1.5'");

  std::array<std::vector<std::pair<Point, Point>>, 3> lines;
  std::vector<Point> began;
  for (const auto& [number, run] : candidate.runs) {
    const auto ended = ended_at(task, run, view);
    if (!ended) continue;
    began.push_back(view.mm(began_at(evaluation.task, candidate, run)));
    Point from = began.back();
    for (const Vector3& reached_m : run.result.path_m) {
      const Point to = view.mm(reached_m);
      lines[static_cast<std::size_t>(classify(run.result))].emplace_back(from, to);
      from = to;
    }
  }
  const double opacity =
      std::clamp(20.0 / static_cast<double>(candidate.runs.size() + 1), 0.06, 0.6);
  for (const TrialClass kind :
       {TrialClass::kSucceeded, TrialClass::kStopped, TrialClass::kDoneButWrong}) {
    const bool succeeded = kind == TrialClass::kSucceeded;
    plot.lines(lines[static_cast<std::size_t>(kind)],
               format("stroke-opacity='%.2f' stroke='", succeeded ? opacity : 0.5) +
                   std::string(succeeded ? "#333" : colour_of(kind)) + "'");
  }
  plot.dots(began, 3.0, "#444");
  mark(plot, evaluation.task, candidate, 6.0,
       [&](const Run& run) { return ended_at(task, run, view); });
  return plot.svg(side_of(view) + "where each run went");
}

std::string figure_of_draws(const Evaluation& evaluation, const Candidate& candidate,
                            const drawing::View& view) {
  const auto at = [&](const Run& run) {
    return std::optional<Point>(view.mm(run.trial.offset.head<3>()));
  };
  const Point sigma = view.mm(candidate.start.sigma.head<3>());
  Extent extent;
  extent.add(Point(-3.3 * sigma.maxCoeff() * Point::Ones()));
  extent.add(Point(3.3 * sigma.maxCoeff() * Point::Ones()));
  for (const auto& [number, run] : candidate.runs) extent.add(*at(run));
  Plot plot = plot_of(extent.widened(0.02), view, kNarrow_px);
  mark_reach(plot, evaluation.task, sigma);
  mark(plot, evaluation.task, candidate, 5.0, at);
  plot.dots({Point::Zero()}, 8.0, kGoalColour);
  return plot.svg(side_of(view) + "where the environment stood in each run");
}

std::string figure_of_ends(const Evaluation& evaluation, const Candidate& candidate,
                           const drawing::View& view) {
  const double tolerance_mm = 1e3 * evaluation.task.goal_tolerance_m;
  Extent extent;
  extent.add(Point::Constant(-kEndsReach * tolerance_mm));
  extent.add(Point::Constant(kEndsReach * tolerance_mm));
  Plot plot = plot_of(extent, view, kNarrow_px);
  plot.circle(Point::Zero(), Point::Constant(tolerance_mm),
              "fill='#2a7f3f' fill-opacity='.07' stroke='#2a7f3f' stroke-width='1.5'");
  plot.line({-0.15 * tolerance_mm, 0.0}, {0.15 * tolerance_mm, 0.0}, "stroke='#2a7f3f'");
  plot.line({0.0, -0.15 * tolerance_mm}, {0.0, 0.15 * tolerance_mm}, "stroke='#2a7f3f'");
  mark(plot, evaluation.task, candidate, 4.0, [&](const Run& run) -> std::optional<Point> {
    if (!run.result.error) return std::nullopt;
    return view.mm(run.result.error->head<3>());
  });
  return plot.svg(side_of(view) + "where the part ended about its goal");
}

std::string note_of_ends(const Evaluation& evaluation, const Candidate& candidate,
                         const drawing::View& view) {
  const double tolerance_mm = 1e3 * evaluation.task.goal_tolerance_m;
  std::size_t ends = 0;
  std::size_t outside = 0;
  std::size_t failed_outside = 0;
  std::size_t failed_in_circle = 0;
  for (const auto& [number, run] : candidate.runs) {
    if (!run.result.error) continue;
    ++ends;
    const Point end = view.mm(run.result.error->head<3>());
    const bool failed = classify(run.result) != TrialClass::kSucceeded;
    if (end.cwiseAbs().maxCoeff() > kEndsReach * tolerance_mm) {
      ++outside;
      if (failed) ++failed_outside;
    } else if (failed && end.norm() <= tolerance_mm) {
      ++failed_in_circle;
    }
  }
  std::string note = "Dots: done and at the goal; crosses: not.";
  if (failed_in_circle > 0) {
    note += format(
        " Of the crosses, %zu in the circle: stopped, or off in what this side does not show.",
        failed_in_circle);
  }
  if (outside > 0) {
    note += format(" Outside of this plot: %zu of %zu ends, %zu of them failed.", outside, ends,
                   failed_outside);
  }
  const std::size_t none = candidate.runs.size() - ends;
  if (none > 0) note += format(" %zu run%s ended nowhere.", none, plural(none));
  return note;
}

std::string figure_of_errors(const Evaluation& evaluation, const Candidate& candidate) {
  // Logarithmic, eight bars a decade, from 10 um to 1 m.
  constexpr int kLow = -2;
  constexpr int kHigh = 3;
  constexpr int kBarsPerDecade = 8;
  constexpr std::size_t kBars = (kHigh - kLow) * kBarsPerDecade;
  std::array<std::array<int, 3>, kBars> counts{};
  int highest = 1;
  for (const auto& [number, run] : candidate.runs) {
    if (!run.result.error) continue;
    const double error_mm = std::max(1e3 * run.result.error->head<3>().norm(), 1e-9);
    const double bar = std::floor(kBarsPerDecade * (std::log10(error_mm) - kLow));
    auto& count = counts[static_cast<std::size_t>(std::clamp(bar, 0.0, kBars - 1.0))];
    ++count[static_cast<std::size_t>(classify(run.result))];
    highest = std::max(highest, count[0] + count[1] + count[2]);
  }
  Plot plot(kWide_px, 240, {kLow, kHigh, "distance from the goal (mm)", true},
            {0.0, 1.08 * highest, "runs"});
  for (std::size_t i = 0; i < kBars; ++i) {
    const double left = kLow + static_cast<double>(i) / kBarsPerDecade;
    int below = 0;
    for (const TrialClass kind :
         {TrialClass::kSucceeded, TrialClass::kStopped, TrialClass::kDoneButWrong}) {
      const int count = counts[i][static_cast<std::size_t>(kind)];
      if (count == 0) continue;
      plot.rectangle({left, below}, {left + 0.9 / kBarsPerDecade, below + count},
                     "fill='" + std::string(colour_of(kind)) + "'",
                     format("%d %s", count, to_string(kind)));
      below += count;
    }
  }
  const double tolerance = std::log10(1e3 * evaluation.task.goal_tolerance_m);
  plot.line({tolerance, 0.0}, {tolerance, 1.08 * highest},
            "stroke='#2a7f3f' stroke-width='1.5' stroke-dasharray='5 4'");
  plot.text({tolerance + 0.06, 1.0 * highest}, "tolerance", "fill='#2a7f3f'");
  return plot.svg("How many runs ended how far from the goal");
}

std::string figure_of_breakdown(const Evaluation& evaluation, const Candidate& candidate) {
  const std::vector<std::vector<Rate>> rates = break_down(evaluation.by, candidate);
  return evaluation.by.size() == 1 ? curve(evaluation.by[0], rates[0]) : map(evaluation.by, rates);
}

std::string rate_bar(const Rate& rate) {
  constexpr double kWidth_px = 120.0;
  const Interval interval = rate.interval();
  return format(
      "<svg width='%.0f' height='16' aria-hidden='true'><rect width='%.0f' height='16' "
      "fill='#eee'/>"
      "<rect width='%.1f' height='16' fill='%s'/>"
      "<path d='M%.1f 8H%.1fM%.1f 3v10M%.1f 3v10' stroke='#111' stroke-width='1.5'/></svg>",
      kWidth_px, kWidth_px, kWidth_px * rate.value(), "#8fbbe0", kWidth_px * interval.low,
      kWidth_px * interval.high, kWidth_px * interval.low, kWidth_px * interval.high);
}

}  // namespace tenon::sim

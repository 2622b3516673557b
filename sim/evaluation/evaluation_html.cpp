#include "sim/evaluation/evaluation_html.h"

#include <algorithm>
#include <utility>

#include "shared/base/shown.h"
#include "shared/base/text.h"
#include "shared/drawing/html.h"
#include "shared/drawing/page.h"
#include "shared/drawing/view.h"
#include "shared/task/spread.h"
#include "sim/evaluation/evaluation_page_data.h"
#include "sim/evaluation/figures.h"
#include "sim/evaluation/run_sample.h"
#include "sim/evaluation/summary.h"

namespace tenon::sim {
namespace {

// Over all plans, so that the page stays below 3 MB.
constexpr std::size_t kRunsDrawn = 600;
constexpr std::size_t kFailuresListed = 200;

std::string percent(double part) { return format("%.1f", 1e2 * part); }

std::string rate_cell(const Rate& rate) {
  const Interval interval = rate.interval();
  return "<td class='rate'>" + rate_bar(rate) + "<b>" + percent(rate.value()) +
         " %</b> <span class='term'>[" + percent(interval.low) + ", " + percent(interval.high) +
         "] " + format("%zu of %zu", rate.successes, rate.count) + "</span></td>";
}

std::string proportion_cell(const Rate& rate) {
  const Interval interval = rate.interval();
  return "<td><b>" + percent(rate.value()) + " %</b> <span class='term'>[" + percent(interval.low) +
         ", " + percent(interval.high) + "]</span></td>";
}

std::string number_cell(const std::string& text) { return "<td class='num'>" + text + "</td>"; }

std::string legend() {
  const auto cross = [](const char* colour) {
    return std::string(
               "<svg width='14' height='14' aria-hidden='true'><path d='M2 2l10 10m0 -10l-10 10' "
               "stroke-width='2' stroke='") +
           colour + "'/></svg>";
  };
  return std::string(
             "<p class='legend'><span class='key'><svg width='14' height='14' "
             "aria-hidden='true'><circle cx='7' cy='7' r='5' "
             "fill='") +
         kSucceededColour + "'/></svg>done and at the goal</span><span class='key'>" +
         cross(kStoppedColour) + "stopped with a reason</span><span class='key'>" +
         cross(kWrongColour) + "done but not at the goal</span></p>\n";
}

std::string name_of(const Candidate& candidate) {
  const std::size_t slash = candidate.file.rfind('/');
  return drawing::escaped(slash == std::string::npos ? candidate.file
                                                     : candidate.file.substr(slash + 1));
}

/// A table whose cells are each named by their column too, for windows too narrow for columns.
/// @param rows of cells "<td...>...</td>", as many as there are titles
std::string carded_table(const std::vector<std::string>& titles,
                         const std::vector<std::vector<std::string>>& rows) {
  std::string html = "<div class='wide'><table class='moves nowrap'><thead><tr>";
  for (std::size_t i = 0; i < titles.size(); ++i) {
    const bool number = !rows.empty() && rows.front()[i].starts_with("<td class='num'");
    html += (number ? "<th class='num'>" : "<th>") + titles[i] + "</th>";
  }
  html += "</tr></thead>\n";
  for (const std::vector<std::string>& row : rows) {
    html += "<tr>";
    for (std::size_t i = 0; i < row.size(); ++i) {
      constexpr std::size_t kTag = 3;  // "<td"
      html += row[i].substr(0, kTag) + " data-label='" + titles[i] + "'" + row[i].substr(kTag);
    }
    html += "</tr>\n";
  }
  return html + "</table></div>\n";
}

class Report {
 public:
  explicit Report(const Evaluation& evaluation) : evaluation_(evaluation), task_(evaluation.task) {
    for (const Candidate& candidate : evaluation.candidates) {
      summaries_.push_back(summarise(task_, candidate));
      samples_.push_back(sample_of(candidate, kRunsDrawn / evaluation.candidates.size()));
    }
  }

  [[nodiscard]] std::string html() const {
    const std::string title = drawing::escaped(task_.name);
    drawing::LivePage page;
    page.title = title + ": evaluation";
    page.heading = "<p class='kicker'>Evaluation</p><h1>" + title + " <span>on cell " +
                   drawing::escaped(evaluation_.cell.name) + "</span></h1>\n" + opening() +
                   badges();
    page.body = std::string("<style>") + kFigureStyle + "</style>\n" +
                "<section class='stage' aria-label='Where the part went' data-part='stage'>"
                "</section>\n<section data-part='forces' aria-labelledby='forces'><h2 id='forces'>"
                "Forces of the run that is shown</h2></section>\n"
                "<section aria-labelledby='success'><h2 id='success'>Success</h2>\n" +
                plans_table() + errors_table() + "</section>\n";
    for (std::size_t i = 0; i < summaries_.size(); ++i) page.body += section(i);
    page.json = evaluation_page_json(evaluation_, samples_);
    return drawing::live_document(page);
  }

 private:
  [[nodiscard]] std::string opening() const {
    std::size_t runs = 0;
    for (const Candidate& candidate : evaluation_.candidates) runs += candidate.runs.size();
    std::string text = format("<p class='lead'>%zu run%s, seed %llu. ", runs, plural(runs),
                              static_cast<unsigned long long>(evaluation_.seed));
    text += evaluation_.ranges
                ? "Where the environment stands is drawn, and how else the world differs: "
                  "experiment " +
                      drawing::escaped(evaluation_.ranges->name) + "."
                : "Where the environment stands is drawn; all else is as the files say.";
    return text + " Every plan meets the same worlds. Intervals: 95 % (Wilson).</p>\n";
  }

  /// Each plan's success, at a glance.
  [[nodiscard]] std::string badges() const {
    std::string html = "<ul class='badges'>\n";
    for (std::size_t i = 0; i < summaries_.size(); ++i) {
      const Rate& rate = summaries_[i].success;
      html +=
          std::string("<li class='") + (rate.successes == rate.count ? "good" : "bad") + "'>" +
          name_of(evaluation_.candidates[i]) +
          format(": %zu of %zu at the goal, %zu stopped, %zu done but wrong</li>\n", rate.successes,
                 rate.count, summaries_[i].stopped, summaries_[i].done_but_wrong);
    }
    return html + "</ul>\n";
  }

  [[nodiscard]] std::string plans_table() const {
    std::vector<std::string> titles = {"Plan", "Method", "Steps", "Succeeded"};
    for (const RateWithin& within : summaries_.front().within) {
      titles.push_back("W" + within_text(evaluation_.task, within.distance).substr(1) +
                       format(" (%.2f %% of draws)", 1e2 * within.mass));
    }
    const bool tilts = std::any_of(summaries_.begin(), summaries_.end(),
                                   [](const Summary& summary) { return summary.tilts; });
    if (tilts) titles.push_back(format("And tilted &le; %.2f&deg;", shown(task_.tilt_rad, 3)));
    titles.insert(titles.end(), {"Stopped", "Done but wrong"});
    std::vector<std::vector<std::string>> rows;
    for (std::size_t i = 0; i < summaries_.size(); ++i) {
      const Candidate& candidate = evaluation_.candidates[i];
      const Summary& summary = summaries_[i];
      std::vector<std::string> row = {
          "<td><a href='#plan" + std::to_string(i) + "'>" + name_of(candidate) + "</a></td>",
          std::string("<td>") + to_string(candidate.plan.method) + "</td>",
          number_cell(std::to_string(candidate.plan.steps.size())), rate_cell(summary.success)};
      for (const RateWithin& within : summary.within) row.push_back(proportion_cell(within.rate));
      if (tilts) row.push_back(proportion_cell(summary.promised));
      row.push_back(number_cell(std::to_string(summary.stopped)));
      row.push_back(number_cell(std::to_string(summary.done_but_wrong)));
      rows.push_back(std::move(row));
    }
    return carded_table(titles, rows);
  }

  [[nodiscard]] static std::string force_text(const Summary& summary) {
    const Quantiles& force = summary.contact_force_N;
    return summary.begun == 0 ? ""
                              : format("%.1f / %.1f / %.1f N", force.p50, force.p99, force.max);
  }

  [[nodiscard]] static std::string time_text(const Summary& summary) {
    return summary.begun == 0 ? "" : format("%.1f s", summary.duration_s.p50);
  }

  /// Of a plan of which no run was done: there are no ends to tell of.
  [[nodiscard]] std::vector<std::string> undone_row(std::size_t i) const {
    std::vector<std::string> row = {"<td>" + name_of(evaluation_.candidates[i]) + "</td>",
                                    "<td>no run was done</td>"};
    row.resize(7, number_cell(""));
    row.push_back(number_cell(force_text(summaries_[i])));
    row.push_back(number_cell(time_text(summaries_[i])));
    return row;
  }

  [[nodiscard]] std::string errors_table() const {
    const std::vector<std::string> titles = {"Runs that were done",
                                             "Axis",
                                             "Initial deviation",
                                             "Final deviation",
                                             "Ratio",
                                             "Final mean",
                                             "Distance, mean / max",
                                             "Largest force, p50 / p99 / max",
                                             "Time, p50"};
    std::vector<std::vector<std::string>> rows;
    for (std::size_t i = 0; i < summaries_.size(); ++i) {
      const Summary& summary = summaries_[i];
      if (summary.done == 0) {
        rows.push_back(undone_row(i));
        continue;
      }
      const bool spreads = summary.done > 1;  // one run does not
      bool first = true;
      for (const AxisError& error : summary.errors) {
        const int axis = error.axis;
        const char* unit = axis < 3 ? "mm" : "&deg;";
        std::vector<std::string> row = {
            "<td>" + (first ? name_of(evaluation_.candidates[i]) : "") + "</td>",
            std::string("<td>") + axis_name(axis) + "</td>",
            number_cell(spreads ? format("%.2f %s", shown(error.initial.deviation, axis), unit)
                                : ""),
            number_cell(spreads ? format("%.4f %s", shown(error.final.deviation, axis), unit) : ""),
            number_cell(ratio_text(error)),
            number_cell(format("%+.3f %s", shown(error.final.mean, axis), unit)),
            number_cell(first ? format("%.2f / %.2f mm", 1e3 * summary.error_norm_m.mean,
                                       1e3 * summary.error_norms_m.max)
                              : ""),
            number_cell(first ? force_text(summary) : ""),
            number_cell(first ? time_text(summary) : "")};
        rows.push_back(std::move(row));
        first = false;
      }
    }
    return carded_table(titles, rows);
  }

  [[nodiscard]] std::string section(std::size_t i) const {
    const Candidate& candidate = evaluation_.candidates[i];
    const std::string id = "plan" + std::to_string(i);
    std::string html = "<section aria-labelledby='" + id + "'><h2 id='" + id + "'>" +
                       name_of(candidate) + ": " + to_string(candidate.plan.method) + ", start " +
                       drawing::escaped(candidate.plan.start_name) + "</h2>\n";
    if (!made_for(candidate, task_)) {
      html += "<p class='note'>The plan was made for another task, or another variant of it.</p>\n";
    }
    html += failures_part(i) + "<div class='plots'>\n";
    for (const drawing::View& view : drawing::views_of(task_.coordinates)) html += places(i, view);
    html += drawing::figure(figure_of_errors(evaluation_, candidate),
                            "How far from the goal the runs ended; logarithmic.");
    if (!evaluation_.by.empty()) {
      html += drawing::figure(
          figure_of_breakdown(evaluation_, candidate),
          evaluation_.by.size() == 1
              ? "Success over the drawn quantity, with 95 % intervals."
              : "Success in % over the two drawn quantities; point at a cell for its "
                "counts.");
    }
    return html + "</div>\n" + legend() + "</section>\n";
  }

  /// Where runs went (which the moving picture shows, too), where the environment stood, and where
  /// they ended.
  [[nodiscard]] std::string places(std::size_t i, const drawing::View& view) const {
    const Candidate& sample = samples_[i];
    const std::size_t all = evaluation_.candidates[i].runs.size();
    const std::string shown =
        sample.runs.size() == all ? "" : format(" %zu of %zu runs.", sample.runs.size(), all);
    return "<div class='still'>" +
           drawing::figure(
               figure_of_runs(evaluation_, sample, view),
               "The way of each run from where it began (small dots), step by step, seen from the "
               "environment as it really stood. Dashed: the part at its nominal start; green: "
               "at the goal." +
                   shown) +
           "</div>\n" +
           drawing::figure(figure_of_draws(evaluation_, sample, view),
                           "Where the environment really stood, about where the plan believed it "
                           "(green). " +
                               std::string(task_.errors == Distribution::kUniform
                                               ? "Square: the bounds."
                                               : "Rings: standard deviations.") +
                               shown) +
           drawing::figure(figure_of_ends(evaluation_, sample, view),
                           "Where the part ended about its goal, and the tolerance of " +
                               tolerance_text(task_.goal_tolerance_m, task_.goal_axes) + ". " +
                               note_of_ends(evaluation_, sample, view) + shown);
  }

  [[nodiscard]] static std::string class_cell(const TrialResult& result) {
    const bool stopped = classify(result) == TrialClass::kStopped;
    return std::string("<td class='") + (stopped ? "stopped" : "wrong") + "'>" +
           (stopped ? "stopped" : "done but wrong") + "</td>";
  }

  [[nodiscard]] static std::string step_cells(const TrialResult& result) {
    return "<td class='num' data-label='Step'>" +
           (result.step < 0 ? "" : std::to_string(result.step)) + "</td><td data-label='Outcome'>" +
           drawing::escaped(result.outcome) + "</td>";
  }

  /// A button for each run that can be replayed.
  [[nodiscard]] std::string replays(std::size_t i, const FailureKind& kind) const {
    std::string html;
    for (const Run* run : kind.examples) {
      const std::size_t number = run->trial.number;
      if (evaluation_.candidates[i].recordings.count(number) == 0) continue;
      html += format(
          "<button type='button' class='jump' data-plan='%zu' data-run='%zu' "
          "title='Replay run %zu'>run %zu</button> ",
          i, number, number, number);
    }
    return html;
  }

  [[nodiscard]] std::string kinds_table(std::size_t i) const {
    std::string html =
        "<div class='wide'><table class='moves'><thead><tr><th class='num'>Failed runs</th>"
        "<th>How</th><th class='num'>Last step</th><th>Its outcome</th><th>Ending</th>"
        "<th>Why, in the first of them</th><th>Replay</th></tr></thead>\n<tbody>\n";
    for (const FailureKind& kind : kinds_of_failure(evaluation_.candidates[i])) {
      const TrialResult& result = kind.first().result;
      html += "<tr><th scope='row' class='num'>" +
              format("%zu run%s</th>", kind.count, plural(kind.count)) + class_cell(result) +
              step_cells(result) + "<td data-label='Ending'>" + drawing::escaped(result.ending) +
              "</td><td data-label='Why'>" + drawing::escaped(result.reason) +
              "</td><td data-label='Replay'>" + replays(i, kind) + "</td></tr>\n";
    }
    return html + "</tbody></table></div>\n";
  }

  /// Kinds of failure, then each run of them with the command that makes it again.
  [[nodiscard]] std::string failures_part(std::size_t i) const {
    const Candidate& candidate = evaluation_.candidates[i];
    const std::vector<const Run*> failed = failures(candidate);
    if (failed.empty()) return "<p><b>No run failed.</b></p>\n";
    const std::size_t listed =
        std::min(failed.size(), kFailuresListed / evaluation_.candidates.size());
    std::string html = kinds_table(i) + "<details><summary>" +
                       format("%zu run%s", failed.size(), plural(failed.size())) +
                       " that failed</summary>\n<div class='wide'><table class='moves'><thead><tr>"
                       "<th class='num'>Run</th><th class='num'>Off</th><th>How</th>"
                       "<th class='num'>Step</th><th>Outcome</th><th>Why, and how to see it again"
                       "</th></tr></thead>\n<tbody>\n";
    for (std::size_t k = 0; k < listed; ++k) {
      const Run* run = failed[k];
      html += "<tr><th scope='row' class='num'>" + std::to_string(run->trial.number) + "</th>" +
              "<td class='num' data-label='Off'>" + out_text(task_, run->trial.distance) + "</td>" +
              class_cell(run->result) + step_cells(run->result) + "<td>" +
              drawing::escaped(run->result.reason) + "<br><code>" +
              drawing::escaped(replay_command(evaluation_, candidate, run->trial.number)) +
              "</code></td></tr>\n";
    }
    html += "</tbody></table></div>\n";
    if (listed < failed.size()) {
      html += format("<p class='note'>The first %zu; --json has all.</p>\n", listed);
    }
    return html + "</details>\n";
  }

  const Evaluation& evaluation_;
  const Task& task_;
  std::vector<Summary> summaries_;
  std::vector<Candidate> samples_;  ///< a plan each
};

}  // namespace

std::string evaluation_html(const Evaluation& evaluation) { return Report(evaluation).html(); }

}  // namespace tenon::sim

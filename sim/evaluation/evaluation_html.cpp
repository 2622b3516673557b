#include "sim/evaluation/evaluation_html.h"

#include "shared/base/shown.h"
#include "shared/base/text.h"
#include "shared/drawing/html.h"
#include "shared/drawing/view.h"
#include "shared/task/spread.h"
#include "sim/evaluation/figures.h"
#include "sim/evaluation/summary.h"

namespace tenon::sim {
namespace {

constexpr const char* kStyle =
    "body{font:15px/1.45 system-ui,sans-serif;max-width:1120px;margin:28px auto;padding:0 18px;"
    "color:#222}h1{font-size:26px;margin:0 0 2px}h2{font-size:19px;margin:40px 0 6px}"
    "p{margin:4px 0 12px;max-width:900px}.grey{color:#666}"
    "table{border-collapse:collapse;font-size:14px;margin:14px 0}"
    "td,th{border-bottom:1px solid #ddd;padding:5px 12px 5px 0;text-align:left;"
    "vertical-align:top}th{color:#666;font-weight:600;border-bottom:2px solid #bbb}"
    ".nowrap td{white-space:nowrap}td.num,th.num{text-align:right}td "
    "svg{display:inline-block;vertical-align:-3px;"
    "margin-right:8px}code{font-size:12px;color:#444}"
    ".row{display:flex;flex-wrap:wrap;gap:18px 22px;align-items:flex-start}"
    "figure{margin:0 0 14px}figcaption{font-size:13px;color:#555;max-width:580px;margin:2px 0 0 "
    "74px}"
    ".narrow figcaption{max-width:320px}svg{display:block}"
    ".key{display:inline-block;margin-right:18px}.key svg{display:inline-block;"
    "vertical-align:-3px;margin-right:5px}";

std::string percent(double part) { return format("%.1f", 1e2 * part); }

std::string rate_cell(const Rate& rate) {
  const Interval interval = rate.interval();
  return "<td>" + rate_bar(rate) + "<b>" + percent(rate.value()) + " %</b> <span class='grey'>[" +
         percent(interval.low) + ", " + percent(interval.high) + "] " +
         format("%zu of %zu", rate.successes, rate.count) + "</span></td>";
}

std::string number_cell(const std::string& text) { return "<td class='num'>" + text + "</td>"; }

std::string legend() {
  const auto cross = [](const char* colour) {
    return std::string(
               "<svg width='14' height='14'><path d='M2 2l10 10m0 -10l-10 10' "
               "stroke-width='2' stroke='") +
           colour + "'/></svg>";
  };
  return std::string(
             "<p><span class='key'><svg width='14' height='14'><circle cx='7' cy='7' r='5' "
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

class Report {
 public:
  explicit Report(const Evaluation& evaluation) : evaluation_(evaluation), task_(evaluation.task) {
    for (const Candidate& candidate : evaluation.candidates) {
      summaries_.push_back(summarise(task_, candidate));
    }
  }

  [[nodiscard]] std::string html() const {
    const std::string title = drawing::escaped(task_.name);
    std::string body = opening() + legend() + plans_table() + errors_table();
    for (std::size_t i = 0; i < summaries_.size(); ++i) body += section(i);
    return drawing::document(
        {title + ": evaluation", std::string(kStyle) + kFigureStyle, title, body});
  }

 private:
  [[nodiscard]] std::string opening() const {
    std::size_t runs = 0;
    for (const Candidate& candidate : evaluation_.candidates) runs += candidate.runs.size();
    std::string text = format("<p class='grey'>%zu runs on cell ", runs) +
                       drawing::escaped(evaluation_.cell) +
                       format(", seed %llu. ", static_cast<unsigned long long>(evaluation_.seed));
    text += evaluation_.ranges
                ? "Where the environment stands is drawn, and how else the world differs: "
                  "experiment " +
                      drawing::escaped(evaluation_.ranges->name) + "."
                : "Where the environment stands is drawn; all else is as the files say.";
    return text + " Every plan meets the same worlds. Intervals: 95 % (Wilson).</p>\n";
  }

  [[nodiscard]] std::string plans_table() const {
    std::string html =
        "<table class='nowrap'><tr><th>Plan</th><th>Method</th><th class='num'>Steps</th>"
        "<th>Succeeded</th>";
    for (const RateWithin& within : summaries_.front().within) {
      html += "<th>W" + within_text(evaluation_.task, within.distance).substr(1) +
              format(" (%.2f %% of draws)</th>", 1e2 * within.mass);
    }
    html += "<th class='num'>Stopped</th><th class='num'>Done but wrong</th></tr>\n";
    for (std::size_t i = 0; i < summaries_.size(); ++i) {
      const Candidate& candidate = evaluation_.candidates[i];
      const Summary& summary = summaries_[i];
      html += "<tr><td><a href='#plan" + std::to_string(i) + "'>" + name_of(candidate) +
              "</a></td><td>" + to_string(candidate.plan.method) + "</td>" +
              number_cell(std::to_string(candidate.plan.steps.size())) + rate_cell(summary.success);
      for (const RateWithin& within : summary.within) {
        html += "<td><b>" + percent(within.rate.value()) + " %</b> <span class='grey'>[" +
                percent(within.rate.interval().low) + ", " + percent(within.rate.interval().high) +
                "]</span></td>";
      }
      html += number_cell(std::to_string(summary.stopped)) +
              number_cell(std::to_string(summary.done_but_wrong)) + "</tr>\n";
    }
    return html + "</table>\n";
  }

  [[nodiscard]] std::string errors_table() const {
    std::string html =
        "<table class='nowrap'><tr><th>Runs that were done</th><th>Axis</th>"
        "<th class='num'>Initial deviation</th><th class='num'>Final deviation</th>"
        "<th class='num'>Ratio</th><th class='num'>Final mean</th>"
        "<th class='num'>Distance, mean / max</th>"
        "<th class='num'>Largest force, p50 / p99 / max</th>"
        "<th class='num'>Time, p50</th></tr>\n";
    for (std::size_t i = 0; i < summaries_.size(); ++i) {
      const Summary& summary = summaries_[i];
      bool first = true;
      for (const AxisError& error : summary.errors) {
        const int axis = error.axis;
        const char* unit = axis < 3 ? "mm" : "&deg;";
        html += "<tr><td>" + (first ? name_of(evaluation_.candidates[i]) : "") + "</td><td>" +
                axis_name(axis) + "</td>" +
                number_cell(format("%.2f %s", shown(error.initial.deviation, axis), unit)) +
                number_cell(format("%.4f %s", shown(error.final.deviation, axis), unit)) +
                number_cell(ratio_text(error)) +
                number_cell(format("%+.3f %s", shown(error.final.mean, axis), unit));
        const Quantiles& force = summary.contact_force_N;
        html += number_cell(first ? format("%.2f / %.2f mm", 1e3 * summary.error_norm_m.mean,
                                           1e3 * summary.error_norms_m.max)
                                  : "");
        html += number_cell(first ? format("%.1f / %.1f / %.1f N", force.p50, force.p99, force.max)
                                  : "") +
                number_cell(first ? format("%.1f s", summary.duration_s.p50) : "") + "</tr>\n";
        first = false;
      }
    }
    return html + "</table>\n";
  }

  [[nodiscard]] std::string section(std::size_t i) const {
    const Candidate& candidate = evaluation_.candidates[i];
    std::string html = "<h2 id='plan" + std::to_string(i) + "'>" + name_of(candidate) + ": " +
                       to_string(candidate.plan.method) + ", start " +
                       drawing::escaped(candidate.plan.start_name) + "</h2>\n";
    if (candidate.plan.task_hash != task_.hash) {
      html += "<p class='grey'>The plan was made for another task, or another variant of it.</p>\n";
    }
    for (const drawing::View& view : drawing::views_of(task_.coordinates)) {
      html += figures(candidate, view);
    }
    if (!evaluation_.by.empty()) {
      html += drawing::figure(
          figure_of_breakdown(evaluation_, candidate),
          evaluation_.by.size() == 1
              ? "Success over the drawn quantity, with 95 % intervals."
              : "Success in % over the two drawn quantities; point at a cell for its "
                "counts.");
    }
    return html + failures_table(candidate);
  }

  /// Two columns.
  [[nodiscard]] std::string figures(const Candidate& candidate, const drawing::View& view) const {
    std::string html = "<div class='row'>\n<div>\n";
    html += drawing::figure(
        figure_of_runs(evaluation_, candidate, view),
        "Where each run began (small dots) and ended, joined by a line, seen from the "
        "environment as it really stood. Dashed: the part at its nominal start; green: "
        "at the goal.");
    html += drawing::figure(figure_of_errors(evaluation_, candidate),
                            "How far from the goal the runs ended; logarithmic.");
    html += "</div>\n<div class='narrow'>\n";
    html += drawing::figure(
        figure_of_draws(evaluation_, candidate, view),
        "Where the environment really stood, about where the plan believed it (green). "
        "Rings: standard deviations.");
    html += drawing::figure(figure_of_ends(evaluation_, candidate, view),
                            "Where the part ended about its goal, and the tolerance of " +
                                format("%g mm.", 1e3 * task_.goal_tolerance_m));
    return html + "</div>\n</div>\n";
  }

  [[nodiscard]] static std::string class_cell(const TrialResult& result) {
    return std::string("<td style='color:") + colour_of(classify(result)) + "'>" +
           (classify(result) == TrialClass::kStopped ? "stopped" : "done but wrong") + "</td>";
  }

  [[nodiscard]] static std::string step_cells(const TrialResult& result) {
    return number_cell(result.step < 0 ? "" : std::to_string(result.step)) + "<td>" +
           drawing::escaped(result.outcome) + "</td>";
  }

  [[nodiscard]] static std::string kinds_table(const Candidate& candidate) {
    std::string html =
        "<table><tr><th class='num'>Failed runs</th><th></th><th class='num'>Last step</th>"
        "<th>Its outcome</th><th>Ending</th><th>Why, in the first of them</th></tr>\n";
    for (const FailureKind& kind : kinds_of_failure(candidate)) {
      const TrialResult& result = kind.first->result;
      html += "<tr>" + number_cell(std::to_string(kind.count)) + class_cell(result) +
              step_cells(result) + "<td>" + drawing::escaped(result.ending) + "</td><td>" +
              drawing::escaped(result.reason) + "</td></tr>\n";
    }
    return html + "</table>\n";
  }

  [[nodiscard]] std::string failures_table(const Candidate& candidate) const {
    const std::vector<const Run*> failed = failures(candidate);
    if (failed.empty()) return "<p><b>No run failed.</b></p>\n";
    std::string html = kinds_table(candidate) + "<details" +
                       std::string(failed.size() <= 20 ? " open" : "") + "><summary>" +
                       std::to_string(failed.size()) + (failed.size() == 1 ? " run" : " runs") +
                       " that failed</summary>\n<table><tr><th class='num'>Run</th>"
                       "<th class='num'>&sigma;</th><th></th><th class='num'>Step</th>"
                       "<th>Outcome</th><th>Why, and how to see it again</th></tr>\n";
    for (const Run* run : failed) {
      const TrialResult& result = run->result;
      html += "<tr>" + number_cell(std::to_string(run->trial.number)) +
              number_cell(format("%.2f", run->trial.distance)) + class_cell(result) +
              step_cells(result) + "<td>" + drawing::escaped(result.reason) + "<br><code>" +
              drawing::escaped(replay_command(evaluation_, candidate, run->trial.number)) +
              "</code></td></tr>\n";
    }
    return html + "</table></details>\n";
  }

  const Evaluation& evaluation_;
  const Task& task_;
  std::vector<Summary> summaries_;
};

}  // namespace

std::string evaluation_html(const Evaluation& evaluation) { return Report(evaluation).html(); }

}  // namespace tenon::sim

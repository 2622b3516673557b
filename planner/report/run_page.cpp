#include "planner/report/run_page.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "planner/report/pictures.h"
#include "planner/report/plan_sections.h"
#include "planner/report/run_data.h"
#include "planner/report/run_path.h"
#include "shared/base/shown.h"
#include "shared/base/text.h"
#include "shared/drawing/html.h"
#include "shared/drawing/page.h"
#include "shared/drawing/step_words.h"
#include "shared/drawing/view.h"

namespace tenon::planner {
namespace {

using drawing::escaped;

std::string lead(const Plan& plan, const RecordedRun& run) {
  std::string text = format("<p class='lead'>%zu of %zu guarded moves in %.1f s", run.steps.size(),
                            plan.steps.size(), run.duration_s);
  if (!run.robot.empty()) {
    text += " by <b>" + escaped(run.robot) + "</b> in cell <b>" + escaped(run.cell) + "</b>";
  }
  text += ". ";
  if (!run.message.empty()) text += "The executor says: " + escaped(run.message) + ".";
  return text + "</p>\n";
}

std::string ending(const RecordedRun& run) {
  if (!run.ended) return badge(false, "Its end is not in the log");
  return badge(run.done, run.done ? "Done" : "Not done");
}

std::string timing(const RecordedRun& run) {
  std::string text = format("%llu cycles, %llu late", static_cast<unsigned long long>(run.cycles),
                            static_cast<unsigned long long>(run.late_cycles));
  if (run.incomplete_cycles > 0) {
    text += format(", %llu with feedback missing",
                   static_cast<unsigned long long>(run.incomplete_cycles));
  }
  text += format("; awake at most %.0f &micro;s after the due time", 1e6 * run.wakeup_late_max_s);
  return badge(run.late_cycles == 0 && run.incomplete_cycles == 0, text);
}

std::string badges(const Plan& plan, const RecordedRun& run) {
  std::string html = "<ul class='badges'>\n" + ending(run);
  if (run.peak_force_N) {
    html += badge(*run.peak_force_N <= plan.force_limit_N,
                  format("Largest force %.1f N, the plan holds the tool back at %.1f N",
                         *run.peak_force_N, plan.force_limit_N));
  }
  html += timing(run);
  for (const std::string& note : run.notes) html += badge(false, escaped(note));
  return html + "</ul>\n";
}

/// A place in time that the page can go to.
std::string jump(double time_s, const std::string& text) {
  return format("<button type='button' class='jump' data-time='%.4f'>", time_s) + text +
         "</button>";
}

std::string faults(const RecordedRun& run) {
  std::string html = "<section aria-labelledby='faults'><h2 id='faults'>Faults</h2>\n";
  if (run.faults.empty()) return html + "<p>None was told.</p></section>\n";
  html += "<ul class='faults'>\n";
  for (const RecordedFault& fault : run.faults) {
    html += "<li>" + (fault.time_s ? jump(*fault.time_s, format("%.2f s", *fault.time_s)) : "") +
            " " + escaped(fault.text) + "</li>\n";
  }
  return html + "</ul></section>\n";
}

/// Along the plan's coordinates, beside what validation saw of this outcome.
/// Without a sign where nothing is left.
double in_tenths(double value) { return std::round(10.0 * value) / 10.0 + 0.0; }

std::string travel(const Plan& plan, const RecordedStep& step) {
  const OutcomeRule& rule = plan.steps[step.step].rule(step.outcome);
  const bool expected = plan.check_envelopes && rule.successor != kSuccessorFail;
  std::string text;
  for (int axis = 0; axis < 6; ++axis) {
    if (!has(plan.coordinates, axis)) continue;
    text += format("%s%s %+.1f", text.empty() ? "" : "<br>", axis_name(axis),
                   in_tenths(shown(step.travelled[axis], axis)));
    if (!expected) continue;
    text += format(" <span class='term'>(%+.1f to %+.1f)</span>",
                   in_tenths(shown(rule.envelope.travelled_min[axis], axis)),
                   in_tenths(shown(rule.envelope.travelled_max[axis], axis)));
  }
  return text;
}

std::string expected_outcomes(const Step& step) {
  std::string text;
  for (const Outcome outcome : kOutcomes) {
    if (step.rule(outcome).successor == kSuccessorFail) continue;
    text += (text.empty() ? "" : " or ") + std::string(to_string(outcome));
  }
  return text;
}

std::string step_row(const Plan& plan, const RecordedStep& step, std::size_t number) {
  const Step& planned = plan.steps[step.step];
  const bool good = step.deviation.empty();
  return format(
             "<tr data-span='%zu'><th scope='row'><button type='button' class='jump' "
             "data-span='%zu' aria-label='Step %zu'>%zu</button></th>",
             number, number, step.step, step.step) +
         "<td data-label='Move'>" + drawing::displacement_text(planned) +
         "</td><td data-label='Outcome'" + (good ? "" : " class='stopped'") + ">" +
         to_string(step.outcome) + " <span class='term'>(" + expected_outcomes(planned) +
         ")</span>" + (good ? "" : "<br>" + escaped(step.deviation)) +
         "</td><td data-label='Travelled (mm, deg)'>" + travel(plan, step) +
         "</td><td data-label='Contacts'>" + escaped(step.signature) +
         format(
             "</td><td class='num' data-label='Force'>%.1f N</td>"
             "<td class='num' data-label='Took'>%.2f s</td></tr>\n",
             step.peak_force_N, step.duration_s);
}

/// Of the step in which the run ended, if it did not end the step: as far as the log tells.
std::string unfinished_row(const Plan& plan, const RecordedRun& run) {
  const auto last = std::find_if(run.samples.rbegin(), run.samples.rend(),
                                 [](const RecordedCycle& sample) { return sample.step >= 0; });
  if (last == run.samples.rend()) return "";
  const std::int16_t step = last->step;
  const std::size_t number = run.steps.size();
  const bool known = static_cast<std::size_t>(step) < plan.steps.size();
  if (!known || (number > 0 && static_cast<int>(run.steps.back().step) == step)) return "";
  double force_N = 0.0;
  double from_s = last->time_s;
  const auto feel = [&](const RecordedCycle& sample) {
    const double felt_N = std::hypot(sample.wrench[0], sample.wrench[1], sample.wrench[2]);
    if (std::isfinite(felt_N)) force_N = std::max(force_N, felt_N);
  };
  // The cycle that a fault ends has no step any more; what it felt is what ended the step.
  if (last != run.samples.rbegin()) feel(*std::prev(last));
  for (auto sample = last; sample != run.samples.rend() && sample->step == step; ++sample) {
    from_s = sample->time_s;
    feel(*sample);
  }
  const Step& planned = plan.steps[static_cast<std::size_t>(step)];
  return format("<tr data-span='%zu'><th scope='row'>%d</th><td data-label='Move'>", number, step) +
         drawing::displacement_text(planned) +
         "</td><td data-label='Outcome' class='stopped'>unfinished <span class='term'>(" +
         expected_outcomes(planned) + ")</span></td><td></td><td></td>" +
         format(
             "<td class='num' data-label='Force'>%.1f N</td>"
             "<td class='num' data-label='Took'>%.2f s</td></tr>\n",
             force_N, last->time_s - from_s);
}

std::string steps(const Plan& plan, const RecordedRun& run) {
  std::string html =
      "<section aria-labelledby='steps'><h2 id='steps'>Steps</h2>\n<p>What was, and in brackets "
      "what the plan goes on from.</p>\n<div class='wide'><table class='moves'><thead><tr>"
      "<th>Step</th><th>Move</th><th>Outcome</th><th>Travelled (mm, deg)</th><th>Contacts</th>"
      "<th>Largest force</th><th>Took</th></tr></thead>\n<tbody>\n";
  for (std::size_t i = 0; i < run.steps.size(); ++i) html += step_row(plan, run.steps[i], i);
  const std::string unfinished = unfinished_row(plan, run);
  html += unfinished;
  if (run.steps.empty() && unfinished.empty())
    html += "<tr><td colspan='7'>No step was finished.</td></tr>\n";
  return html + "</tbody></table></div></section>\n";
}

/// The curves, which the scripts draw.
std::string curves(const RecordedRun& run) {
  std::string html = "<section aria-labelledby='curves'><h2 id='curves'>Over time</h2>\n";
  if (run.samples.empty()) {
    return html +
           "<p>Forces, motion and timing over time are in the log: give it with "
           "<code>--log</code>.</p></section>\n";
  }
  return html +
         "<p class='unscripted'>The curves need scripts.</p>\n"
         "<div data-part='curves'></div></section>\n";
}

/// Of the way that a picture shows.
constexpr std::size_t kWayMax = 600;

/// What stands still: in print, and where no script runs.
std::string stills(const RecordedRun& run, const ReportData& data) {
  std::vector<Pose> tools = tools_of(data.plan, run, kWayMax);
  const std::optional<Pose> fit = fit_of(data.plan, run);
  if (fit) {
    for (Pose& tool : tools) tool = compose(*fit, tool);
  }
  std::string html = "<section class='still'>\n";
  for (const drawing::View& view : drawing::views_of(data.plan.coordinates)) {
    html += std::string("<h2>") + view.title + "</h2>\n" + run_overview(data, tools, view);
  }
  return html +
         "<p>Blue outline: the part where the run ended; green: at the goal. Black: the way of "
         "the tool" +
         (fit ? ", moved so that it ends at the goal" : "") +
         ". Coloured: the paths of the plan's particles.</p></section>\n";
}

std::string plan_sections(const ReportData& data) {
  return reasons(data) + uncertainty_section(data) +
         "<details><summary>All moves of the plan</summary>\n" + moves_section(data) +
         "</details>\n";
}

}  // namespace

std::string run_report(const Plan& plan, const RecordedRun& run, const ReportData* data) {
  const std::string task_name = escaped(plan.task_name);
  const std::string start_name = escaped(plan.start_name);
  drawing::LivePage page;
  page.title = task_name + ", start " + start_name + ": run";
  page.heading = "<p class='kicker'>Run of an assembly plan</p><h1>" + task_name +
                 " <span>from start " + start_name + "</span></h1>\n" + lead(plan, run) +
                 badges(plan, run);
  page.body =
      "<section class='stage' aria-label='The run in motion' data-part='stage'></section>\n";
  if (data == nullptr) {
    page.body +=
        "<p class='note'>Part, environment and the plan's own paths are in the task: "
        "give it with <code>--task</code>.</p>\n";
  }
  if (data != nullptr) page.body += stills(run, *data);
  page.body += curves(run) + faults(run) + steps(plan, run);
  if (data != nullptr) page.body += plan_sections(*data);
  page.json = run_json(plan, run, data);
  return drawing::live_document(page);
}

}  // namespace tenon::planner

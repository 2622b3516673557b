#include "planner/report/html_report.h"

#include <algorithm>
#include <set>
#include <vector>

#include "planner/report/pictures.h"
#include "planner/report/report_data.h"
#include "planner/report/report_words.h"
#include "planner/report/summary.h"
#include "planner/report/touched.h"
#include "shared/base/shown.h"
#include "shared/base/text.h"
#include "shared/drawing/html.h"
#include "shared/drawing/view.h"

namespace tenon::planner {
namespace {

constexpr const char* kStyle =
    "body{font:15px/1.45 sans-serif;max-width:1100px;margin:24px auto;"
    "padding:0 16px;color:#222}h1{font-size:24px;margin-bottom:4px}h2{font-size:18px;"
    "margin:28px 0 8px}table{border-collapse:collapse;font-size:13px}td,th{border-bottom:1px "
    "solid #ddd;padding:3px 9px;text-align:left;vertical-align:top}th{background:#f4f4f4}"
    "figure{display:inline-block;width:200px;margin:0 12px 14px 0;vertical-align:top;"
    "font-size:12px}svg{background:#fff;display:block;max-height:640px}.num{text-align:right}";

ReportData data_of(const Plan& plan, const Task& task, const Certification& certification,
                   const Validation& validation) {
  const std::vector<Chain>& chains = certification.runs.front().chains;
  ReportData data{plan, task, chains, certification.holds(), validation, {}};
  data.nodes = nodes_of(data.is_baseline() ? finished(validation) : chains, task);
  return data;
}

std::string verdict(const ReportData& data) {
  const Plan& plan = data.plan;
  std::string text = "<p>";
  if (data.is_baseline()) {
    text += format(
        "%zu steps by the baseline <b>%s</b>, which plans for the nominal start alone. It ends "
        "there within %.1f mm of the goal. ",
        plan.steps.size(), to_string(plan.method), 1e3 * plan.goal_tolerance_m);
  } else {
    text += format("%zu steps bring the tool from an uncertainty of ", plan.steps.size()) +
            spread_text(plan, data.nodes.front().spread) + " to " +
            spread_text(plan, data.nodes.back().spread) +
            format(" (standard deviations of the particles), within %.1f mm of the goal. ",
                   1e3 * plan.goal_tolerance_m);
  }
  text += format("In validation %u of %u random starts ended there; repeated for this page: ",
                 plan.draws_at_goal, plan.draws) +
          estimate_text(data.validation, data.task) + ". ";
  return text + (data.certified
                     ? "Certified again for this page: the chain holds.</p>\n"
                     : "<b>Certified again for this page: the chain does NOT hold.</b></p>\n");
}

/// Each direction that contact settles, and with what.
std::string reasons(const ReportData& data) {
  std::string items;
  for (int axis = 0; axis < 6 && !data.is_baseline(); ++axis) {
    const double before = data.nodes.front().spread[axis];
    const double after = data.nodes.back().spread[axis];
    if (before < kWorthTelling || after > kCollapsed * before) continue;
    std::set<std::string> touched;
    std::string steps;
    for (std::size_t step = 0; step + 1 < data.nodes.size(); ++step) {
      const double settled = data.nodes[step].spread[axis] - data.nodes[step + 1].spread[axis];
      if (settled < kWorthTelling) continue;
      touched.merge(found_or_lost(data, step));
      steps += format("%s%zu", steps.empty() ? "" : ", ", step);
    }
    items += "<li>" + std::string(axis_name(axis)) + " " + amount(before, axis) + " &rarr; " +
             amount(after, axis) + ": contact with " + names_of(touched) +
             " begins or ends, in steps " + steps + "</li>\n";
  }
  if (items.empty()) return {};
  return "<p>Why it works: wherever the tool starts, contact puts it at a known place "
         "(standard deviations at the start and at the end).</p>\n<ul>\n" +
         items + "</ul>\n";
}

/// A picture and its words for each step that all particles ran.
std::string figures(const ReportData& data) {
  std::size_t steps = data.plan.steps.size();
  for (const Chain& chain : data.chains) steps = std::min(steps, chain.moves.size());
  std::string html;
  for (std::size_t step = 0; step < steps; ++step) {
    std::string pictures;
    for (const drawing::View& view : drawing::views_of(data.plan.coordinates)) {
      pictures += step_picture(data, view, step);
    }
    const std::set<std::string> touched = touched_after(data, step);
    html += drawing::figure(
        pictures, format("step %zu: ", step) + displacement_text(data.plan.steps[step]) + "<br>" +
                      outcomes_text(data, step) +
                      (touched.empty() ? "" : "<br>touches " + names_of(touched)) +
                      shrinkages(data, step));
  }
  return html;
}

std::string envelope_text(const Plan& plan, const OutcomeRule& rule) {
  if (!plan.check_envelopes) return "not checked";
  std::string text;
  for (int axis = 0; axis < 6; ++axis) {
    if (!has(plan.coordinates, axis)) continue;
    text += format("%s%s %.1f to %.1f", text.empty() ? "" : ", ", axis_name(axis),
                   shown(rule.envelope.travelled_min[axis], axis),
                   shown(rule.envelope.travelled_max[axis], axis));
  }
  text += "; contacts " + to_string(rule.envelope.always);
  if (rule.envelope.possible != rule.envelope.always) {
    text += " (possible " + to_string(rule.envelope.possible) + ")";
  }
  return text;
}

std::string table(const Plan& plan) {
  std::string html =
      "<table><tr><th>Step</th><th>Displacement</th><th>Slow from (mm)</th>"
      "<th>Outcome</th><th>Expected travel (mm, deg) and contacts</th><th>Next</th></tr>\n";
  for (std::size_t i = 0; i < plan.steps.size(); ++i) {
    bool first = true;
    for (const Outcome outcome : kOutcomes) {
      const OutcomeRule& rule = plan.steps[i].rule(outcome);
      if (rule.successor == kSuccessorFail) continue;
      html +=
          first ? format("<tr><td>%zu</td><td>%s</td><td class='num'>%.0f</td>", i,
                         displacement_text(plan.steps[i]).c_str(), 1e3 * plan.steps[i].slow_from_m)
                : "<tr><td></td><td></td><td></td>";
      html += format("<td>%s</td><td>", to_string(outcome)) + envelope_text(plan, rule) +
              "</td><td>" +
              (rule.successor == kSuccessorDone ? std::string("done")
                                                : std::to_string(rule.successor)) +
              "</td></tr>\n";
      first = false;
    }
  }
  return html + "</table>\n<p>Any other outcome" +
         (plan.check_envelopes ? ", travel or contact" : "") + " stops the execution.</p>\n";
}

}  // namespace

std::string html_report(const Plan& plan, const Task& task, const Certification& certification,
                        const Validation& validation) {
  const ReportData data = data_of(plan, task, certification, validation);
  const std::string title =
      drawing::escaped(plan.task_name) + ", start " + drawing::escaped(plan.start_name);
  std::string body = verdict(data) + reasons(data);
  for (const drawing::View& view : drawing::views_of(plan.coordinates)) {
    body += std::string("<h2>") + view.title + "</h2>\n" + overview(data, view);
  }
  body +=
      "<p>Blue: the part at its nominal start; green: at the goal. Coloured: the paths of the "
      "particles, from their hollow dots, as certified. Grey: " +
      std::to_string(validation.draws.size()) + " random starts.</p>\n";
  body += "<h2>Uncertainty over the steps</h2>\n" + uncertainty_chart(data);
  body +=
      "<h2>What each step does</h2>\n<p>Hollow dots: particles before the step, filled: after "
      "it. Red: what is touched. Bold: a direction whose uncertainty the step removes.</p>\n" +
      figures(data);
  body += "<h2>Steps</h2>\n" + table(plan);
  return drawing::document({title, kStyle, title, body});
}

}  // namespace tenon::planner

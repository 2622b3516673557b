#include "planner/report/plan_sections.h"

#include <cstddef>
#include <vector>

#include "planner/report/drops.h"
#include "planner/report/pictures.h"
#include "planner/report/report_words.h"
#include "planner/report/touched.h"
#include "shared/base/shown.h"
#include "shared/base/text.h"
#include "shared/drawing/html.h"
#include "shared/drawing/step_words.h"

namespace tenon::planner {
namespace {

std::string reason(const ReportData& data, int axis) {
  const double before = data.nodes.front().spread[axis];
  const double after = data.nodes.back().spread[axis];
  std::string html = "<li><b>" + std::string(axis_name(axis)) + " " + amount(before, axis) +
                     " &rarr; " + amount(after, axis) + "</b>";
  const std::vector<Drop> drops = drops_along(data, axis);
  if (drops.empty()) return html + ": no step needs to make it more certain</li>\n";
  html += "<ul>\n";
  for (const Drop& drop : drops) {
    html += format("<li><button type='button' class='jump' data-step='%zu'>step %zu</button> ",
                   drop.step + 1, drop.step) +
            amount(drop.before, axis) + " &rarr; " + amount(drop.after, axis) + ": " +
            drawing::escaped(drop.why) + "</li>\n";
  }
  return html + "</ul></li>\n";
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
  return text + "; contacts " + contacts_text(rule.envelope);
}

/// The cells that stand once a step, whichever outcomes it may have.
std::string step_cells(const ReportData& data, std::size_t index) {
  const Step& step = data.plan.steps[index];
  std::string html =
      format(
          "<th scope='row'><button type='button' class='jump' data-step='%zu' "
          "aria-label='After step %zu'>%zu</button></th>",
          index + 1, index, index) +
      "<td data-label='Move'>" + drawing::displacement_text(step) +
      format("</td><td class='num' data-label='Slow from'>%.0f mm</td>", 1e3 * step.slow_from_m);
  if (index + 1 >= data.nodes.size()) return html + "<td></td><td></td>";
  return html + "<td data-label='Particles'>" + outcomes_text(data, index) +
         "</td><td data-label='Touches'>" + names_of(touched_after(data, index)) + "</td>";
}

std::string table(const ReportData& data) {
  const Plan& plan = data.plan;
  std::string html =
      "<div class='wide'><table class='moves'><thead><tr><th>Step</th><th>Move</th>"
      "<th>Slow from</th><th>Particles</th><th>Touches</th>"
      "<th>Outcome</th><th>Expected travel (mm, deg) and contacts</th><th>Next</th>"
      "</tr></thead>\n<tbody>\n";
  for (std::size_t i = 0; i < plan.steps.size(); ++i) {
    bool first = true;
    for (const Outcome outcome : kOutcomes) {
      const OutcomeRule& rule = plan.steps[i].rule(outcome);
      if (rule.successor == kSuccessorFail) continue;
      html += format("<tr data-step='%zu'>", i + 1) +
              (first ? step_cells(data, i) : "<td></td><td></td><td></td><td></td><td></td>") +
              format("<td data-label='Outcome'>%s</td>", to_string(outcome)) +
              "<td data-label='Travel (mm, deg)'>" + envelope_text(plan, rule) +
              "</td><td data-label='Next'>" +
              (rule.successor == kSuccessorDone ? std::string("done")
                                                : std::to_string(rule.successor)) +
              "</td></tr>\n";
      first = false;
    }
  }
  return html + "</tbody></table></div>\n<p>Any other outcome" +
         (plan.check_envelopes ? ", travel or contact" : "") + " stops the execution.</p>\n";
}

}  // namespace

std::string badge(bool good, const std::string& text) {
  return std::string("<li class='") + (good ? "good" : "bad") + "'>" + text + "</li>\n";
}

std::string reasons(const ReportData& data) {
  if (data.is_baseline() || data.nodes.empty()) return {};
  std::string items;
  for (int axis = 0; axis < 6; ++axis) {
    if (has(data.plan.coordinates, axis)) items += reason(data, axis);
  }
  return "<section aria-labelledby='why'><h2 id='why'>Why it works</h2>\n<p>Wherever the tool "
         "starts, contact puts it at a known place. Standard deviation of each direction at the "
         "start and at the end, and the steps that make the difference:</p>\n<ul class='why'>\n" +
         items + "</ul></section>\n";
}

std::string moves_section(const ReportData& data) {
  return "<section aria-labelledby='moves'><h2 id='moves'>Moves</h2>\n" + table(data) +
         "</section>\n";
}

std::string uncertainty_section(const ReportData& data) {
  return "<section aria-labelledby='uncertainty'><h2 id='uncertainty'>Uncertainty over the "
         "steps</h2>\n<div data-part='uncertainty'></div><div class='still'>" +
         uncertainty_chart(data) + "</div></section>\n";
}

}  // namespace tenon::planner

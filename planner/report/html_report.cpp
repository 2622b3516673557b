#include "planner/report/html_report.h"

#include <cstddef>
#include <string>
#include <vector>

#include "planner/report/page_data.h"
#include "planner/report/pictures.h"
#include "planner/report/plan_sections.h"
#include "planner/report/report_data.h"
#include "planner/report/report_words.h"
#include "planner/report/search_section.h"
#include "planner/report/summary.h"
#include "shared/base/text.h"
#include "shared/drawing/html.h"
#include "shared/drawing/page.h"
#include "shared/drawing/view.h"

namespace tenon::planner {
namespace {

std::string verdict(const ReportData& data) {
  const Plan& plan = data.plan;
  const std::string allowed = tolerance_text(plan.goal_tolerance_m, plan.goal_axes);
  std::string text = "<p class='lead'>";
  if (data.is_baseline()) {
    text += format(
        "%zu steps by the baseline <b>%s</b>, which plans for the nominal start alone. It ends "
        "there within %s of the goal. ",
        plan.steps.size(), to_string(plan.method), allowed.c_str());
  } else {
    text += format("%zu guarded moves bring the tool from an uncertainty of ", plan.steps.size()) +
            spread_text(plan, data.nodes.front().spread) + " to " +
            spread_text(plan, data.nodes.back().spread) +
            " (standard deviations of the particles), within " + allowed + " of the goal.";
  }
  return text + "</p>\n";
}

/// Whether what the page shows was simulated again for it, or is what planning came to.
enum class Made { kAgain, kByPlanning };

/// What was checked, and came out how.
std::string badges(const ReportData& data, Made made) {
  const Plan& plan = data.plan;
  const std::string again = made == Made::kAgain ? " again for this page" : "";
  std::string list = badge(
      data.certified,
      "Certified" + again + (data.certified ? ": the chain holds" : ": the chain does NOT hold"));
  list += badge(plan.draws_at_goal == plan.draws,
                format("Validation: %u of %u random starts ended at the goal", plan.draws_at_goal,
                       plan.draws));
  if (made == Made::kAgain) {
    list += badge(data.validation.at_goal() == data.validation.draws.size(),
                  "Repeated for this page: " + estimate_text(data.validation, data.task));
  }
  const std::string doubt = doubt_text(data.validation, data.task);
  if (!doubt.empty()) list += badge(false, doubt);
  return "<ul class='badges'>\n" + list + "</ul>\n";
}

/// What stands still: in print, and where no script runs.
std::string stills(const ReportData& data) {
  std::string html = "<section class='still'>\n";
  for (const drawing::View& view : drawing::views_of(data.plan.coordinates)) {
    html += std::string("<h2>") + view.title + "</h2>\n" + overview(data, view);
  }
  return html +
         "<p>Blue outline: the part at its nominal start; green: at the goal. Coloured: the paths "
         "of the particles, from their hollow dots, as certified. Grey: " +
         std::to_string(data.validation.draws.size()) + " random starts.</p></section>\n";
}

std::string page_of(const ReportData& data, const SearchStory* story, Made made) {
  const Plan& plan = data.plan;
  const std::string task_name = drawing::escaped(plan.task_name);
  const std::string start_name = drawing::escaped(plan.start_name);
  drawing::LivePage page;
  page.title = task_name + ", start " + start_name + ": plan";
  page.heading = "<p class='kicker'>Assembly plan</p><h1>" + task_name + " <span>from start " +
                 start_name + "</span></h1>\n" + verdict(data) + badges(data, made);
  page.body =
      "<section class='stage' aria-label='The plan in motion' data-part='stage'></section>\n" +
      stills(data) + reasons(data) + uncertainty_section(data) +
      (story == nullptr ? std::string() : search_section(*story)) + moves_section(data);
  page.json = page_json(data);
  return drawing::live_document(page);
}

}  // namespace

std::string html_report(const Plan& plan, const Task& task, const Certification& certification,
                        const Validation& validation, const SearchStory* story) {
  return page_of(report_data(plan, task, certification, validation), story, Made::kAgain);
}

std::string html_report(const PlanReport& report, const Task& task) {
  Validation shown = report.validation;
  if (shown.draws.size() > kReportDraws) {
    shown.draws.erase(shown.draws.begin() + kReportDraws, shown.draws.end());
  }
  const SearchStory story =
      read_statistics("statistics", statistics_json(report, task), report.bytes);
  return page_of(report_data(*report.plan, task, report.certification, shown), &story,
                 Made::kByPlanning);
}

}  // namespace tenon::planner

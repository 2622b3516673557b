#include "planner/report/drops.h"

#include <set>

#include "planner/report/report_words.h"
#include "planner/report/touched.h"

namespace tenon::planner {
namespace {

std::string listed(const std::set<std::string>& names) {
  std::string text;
  for (const std::string& name : names) text += (text.empty() ? "" : ", ") + name;
  return text;
}

/// What the step did to contacts: they began, ended, or were kept while it slid or turned.
std::string cause_among(const ReportData& data, std::size_t step) {
  std::string text;
  const auto add = [&](const std::set<std::string>& names, const char* verb) {
    if (names.empty()) return;
    text += (text.empty() ? "contact with " : ", with ") + listed(names) + verb;
  };
  add(begun_in(data, step), " begins");
  add(ended_in(data, step), " ends");
  if (!text.empty()) return text;
  const std::set<std::string> kept = touched_after(data, step);
  return kept.empty() ? "without a contact: where each start ends differs less"
                      : "pressed against " + listed(kept) + " while it moves";
}

/// Among those whose uncertainty the nodes tell: see ReportData::nodes.
std::string cause_of(const ReportData& data, std::size_t step) {
  if (!data.is_baseline()) return cause_among(data, step);
  const std::vector<Chain> drawn = finished(data.validation);
  return cause_among({data.plan, data.task, drawn, data.certified, data.validation, {}}, step);
}

}  // namespace

std::vector<Drop> drops_in(const ReportData& data, std::size_t step) {
  std::vector<Drop> drops;
  if (step + 1 >= data.nodes.size()) return drops;
  for (int axis = 0; axis < 6; ++axis) {
    const double first = data.nodes.front().spread[axis];
    const double before = data.nodes[step].spread[axis];
    const double after = data.nodes[step + 1].spread[axis];
    if (!has(data.plan.coordinates, axis) || before - after <= kDropWorthTelling * first) continue;
    drops.push_back({step, axis, before, after, after < kCollapsed * before, cause_of(data, step)});
  }
  return drops;
}

std::vector<Drop> drops_along(const ReportData& data, int axis) {
  std::vector<Drop> drops;
  for (std::size_t step = 0; step + 1 < data.nodes.size(); ++step) {
    for (const Drop& drop : drops_in(data, step)) {
      if (drop.axis == axis) drops.push_back(drop);
    }
  }
  return drops;
}

}  // namespace tenon::planner

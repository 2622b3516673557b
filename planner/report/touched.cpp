#include "planner/report/touched.h"

#include <algorithm>
#include <iterator>

#include "shared/task/touched.h"

namespace tenon::planner {
namespace {

/// In some particle's set of the first, and not in that particle's of the second.
std::set<std::string> only_in_first(const ReportData& data, std::size_t step, bool after_first) {
  std::set<std::string> names;
  for (const Chain& chain : data.chains) {
    const std::set<std::string> after = touched_by(data, chain, step);
    const std::set<std::string> before =
        step == 0 ? std::set<std::string>{} : touched_by(data, chain, step - 1);
    const std::set<std::string>& first = after_first ? after : before;
    const std::set<std::string>& second = after_first ? before : after;
    std::set_difference(first.begin(), first.end(), second.begin(), second.end(),
                        std::inserter(names, names.end()));
  }
  return names;
}

}  // namespace

std::set<std::string> touched_by(const ReportData& data, const Chain& chain, std::size_t move) {
  if (move >= chain.touching.size()) return {};
  return touched_pieces(data.task, chain.touching[move]);
}

std::set<std::string> touched_after(const ReportData& data, std::size_t step) {
  std::set<std::string> names;
  for (const Chain& chain : data.chains) names.merge(touched_by(data, chain, step));
  return names;
}

std::set<std::string> begun_in(const ReportData& data, std::size_t step) {
  return only_in_first(data, step, true);
}

std::set<std::string> ended_in(const ReportData& data, std::size_t step) {
  return only_in_first(data, step, false);
}

}  // namespace tenon::planner

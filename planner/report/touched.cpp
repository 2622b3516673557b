#include "planner/report/touched.h"

#include <algorithm>
#include <iterator>

#include "shared/task/ring.h"

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

bool is_floor(const Shape& shape, const Pose& goal) {
  return shape.pose.position_m.z() + 0.5 * shape.size_m.z() <= goal.position_m.z() + kAboveFloor_m;
}

std::set<std::string> touched_by(const ReportData& data, const Chain& chain, std::size_t move) {
  std::set<std::string> names;
  if (move >= chain.touching.size()) return names;
  for (const Shape& shape : data.task.environment) {
    if (is_floor(shape, data.plan.goal) && (data.plan.coordinates >> 2 & 1U) == 0) continue;
    for (const std::string& pair : chain.touching[move]) {
      if (pair.ends_with("-" + shape.name)) names.insert(piece_of(shape.name));
    }
  }
  return names;
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

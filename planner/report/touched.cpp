#include "planner/report/touched.h"

#include <algorithm>
#include <iterator>

namespace tenon::planner {
namespace {

std::set<std::string> touched_by(const ReportData& data, const Chain& chain, std::size_t move) {
  std::set<std::string> names;
  for (const Shape& shape : data.task.environment) {
    if (is_floor(shape, data.plan) && (data.plan.coordinates >> 2 & 1U) == 0) continue;
    for (const std::string& pair : chain.touching[move]) {
      if (pair.ends_with("-" + shape.name)) names.insert(shape.name);
    }
  }
  return names;
}

}  // namespace

bool is_floor(const Shape& shape, const Plan& plan) {
  return shape.pose.position_m.z() + 0.5 * shape.size_m.z() <=
         plan.goal.position_m.z() + kAboveFloor_m;
}

std::set<std::string> touched_after(const ReportData& data, std::size_t step) {
  std::set<std::string> names;
  for (const Chain& chain : data.chains) names.merge(touched_by(data, chain, step));
  return names;
}

std::set<std::string> found_or_lost(const ReportData& data, std::size_t step) {
  std::set<std::string> names;
  for (const Chain& chain : data.chains) {
    const std::set<std::string> now = touched_by(data, chain, step);
    const std::set<std::string> before =
        step == 0 ? std::set<std::string>{} : touched_by(data, chain, step - 1);
    std::set_symmetric_difference(now.begin(), now.end(), before.begin(), before.end(),
                                  std::inserter(names, names.end()));
  }
  return names;
}

}  // namespace tenon::planner

#include "executor/dry_run/slow_down.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>

namespace tenon::executor {

ParameterSet slowed(const ParameterSet& set, double factor) {
  assert(factor > 0.0 && factor <= 1.0);
  if (factor == 1.0) return set;
  ParameterSet slow = set;
  SpeedLimits& v = slow.speeds;
  for (double* speed : {&v.approach_mps, &v.contact_mps, &v.approach_radps, &v.contact_radps}) {
    *speed *= factor;
  }
  for (double* rate : {&v.acceleration_mps2, &v.acceleration_radps2}) *rate *= factor * factor;
  for (double* rate : {&v.jerk_mps3, &v.jerk_radps3}) *rate *= factor * factor * factor;
  slow.timeout_us = static_cast<std::uint32_t>(
      std::min(std::ceil(set.timeout_us / factor),
               static_cast<double>(std::numeric_limits<std::uint32_t>::max())));
  return slow;
}

Plan slowed(const Plan& plan, std::span<const double> factors) {
  assert(factors.size() == plan.steps.size());
  Plan slow = plan;
  slow.parameter_sets.clear();
  for (std::size_t i = 0; i < plan.steps.size(); ++i) {
    const ParameterSet set = slowed(plan.parameter_sets[plan.steps[i].parameter_set], factors[i]);
    auto& sets = slow.parameter_sets;
    const auto same = std::find(sets.begin(), sets.end(), set);
    slow.steps[i].parameter_set = static_cast<std::uint8_t>(same - sets.begin());
    if (same == sets.end()) sets.push_back(set);
  }
  return slow;
}

}  // namespace tenon::executor

#pragma once
// The same plan, slower: every step runs through the same path in 1 / factor of its time. Speeds
// take the factor, accelerations its square, jerks its cube, the time limit its inverse. Slowing is
// always safe: an impact's force only falls with the contact speed. Set-up code; allocates.

#include <span>

#include "shared/plan/plan.h"

namespace tenon::executor {

/// @param factor (0, 1]
[[nodiscard]] ParameterSet slowed(const ParameterSet& set, double factor);

/// Steps of one set and different factors get sets of their own.
/// @param factors one a step, each in (0, 1]
[[nodiscard]] Plan slowed(const Plan& plan, std::span<const double> factors);

}  // namespace tenon::executor

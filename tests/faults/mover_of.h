#pragma once
// Which drive a step of a plan needs, for faults that are to be felt there.

#include <cstddef>
#include <string>

#include "shared/plan/plan.h"

namespace tenon::tests {

/// Whose joint a step moves most, in words of a fault ("node=2"). Of a gantry, whose nodes 1, 2 and
/// 3 are x, y and z.
[[nodiscard]] inline std::string mover_of(const Plan& plan, std::size_t step) {
  int axis = 0;
  plan.steps.at(step).displacement.head<3>().cwiseAbs().maxCoeff(&axis);
  return "node=" + std::to_string(axis + 1);
}

}  // namespace tenon::tests

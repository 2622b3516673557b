#pragma once
// What all parts of the page are about. Plain data; any thread.

#include <vector>

#include "planner/judge/certification.h"
#include "planner/judge/chain.h"
#include "planner/judge/validation.h"
#include "planner/report/belief_nodes.h"
#include "shared/plan/plan.h"
#include "shared/task/task.h"

namespace tenon::planner {

/// Whatever it refers to outlives it.
struct ReportData {
  const Plan& plan;
  const Task& task;
  const std::vector<Chain>& chains;  ///< of the particles, as certified
  bool certified = false;
  const Validation& validation;
  /// Of the particles; of a single particle, which knows of no uncertainty, those of the draws.
  /// Empty where no chain went through.
  std::vector<BeliefNode> nodes;

  [[nodiscard]] bool is_baseline() const { return plan.method != PlanMethod::kMha; }
};

/// Of a plan. @param certification of it; its first run gives the particles' paths. All outlive the
/// data
[[nodiscard]] ReportData report_data(const Plan& plan, const Task& task,
                                     const Certification& certification,
                                     const Validation& validation);

}  // namespace tenon::planner

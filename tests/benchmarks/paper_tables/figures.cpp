#include "tests/benchmarks/paper_tables/figures.h"

#include <cmath>
#include <vector>

namespace tenon::paper_tables {
namespace {

void set_errors(const std::vector<planner::Chain>& chains, const Task& task, Figures& figures) {
  const auto count = static_cast<double>(chains.size());
  double squares_m2 = 0.0;
  for (const planner::Chain& chain : chains) {
    const double error_m = (chain.end().position_m - task.goal.position_m).norm();
    figures.error_mean_m += error_m / count;
    squares_m2 += error_m * error_m / count;
  }
  const double mean_m = figures.error_mean_m;
  figures.error_std_m = std::sqrt(std::max(0.0, squares_m2 - mean_m * mean_m));
}

}  // namespace

Figures figures_of(const planner::PlanReport& report, const Task& task) {
  const planner::PlannerTimes& times = report.times;
  Figures figures;
  figures.planned = report.status == planner::PlanStatus::kPlanned;
  figures.time_s = times.attractors_s + times.search_s;
  figures.check_s = report.judging.time_s();
  figures.expansions = static_cast<double>(report.expansions);
  figures.expansions_first = static_cast<double>(report.expansions_first);
  figures.moves =
      static_cast<double>(report.attractor_moves.rollouts + report.search_moves.rollouts);
  figures.check_moves = static_cast<double>(report.judging.moves());
  if (!figures.planned) {
    figures.reason = std::string(to_string(report.status)) + ": " + report.reason;
    return figures;
  }
  figures.cost = report.plan->cost;
  figures.bound = report.plan->bound;
  figures.nodes = static_cast<double>(report.plan->steps.size() + 1);
  set_errors(report.certification.runs.front().chains, task, figures);
  for (const planner::VariantRun& run : report.certification.runs) {
    ++figures.variants;
    figures.variants_held += run.holds ? 1U : 0U;
  }
  figures.draws = report.plan->draws;
  figures.draws_at_goal = report.plan->draws_at_goal;
  figures.draws_within = report.validation.within(task.particle_sigmas);
  figures.draws_within_at_goal = report.validation.at_goal_within(task.particle_sigmas);
  return figures;
}

}  // namespace tenon::paper_tables

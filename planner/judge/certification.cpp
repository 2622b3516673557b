#include "planner/judge/certification.h"

#include <algorithm>
#include <numbers>

#include "planner/belief/belief_summary.h"
#include "planner/judge/plan_draft.h"
#include "shared/base/error.h"
#include "shared/base/shown.h"
#include "shared/base/text.h"
#include "shared/plan/codec.h"
#include "shared/task/find_start.h"
#include "shared/task/inserted.h"

namespace tenon::planner {
namespace {

constexpr double kPoseAgreement_m = 0.5e-3;
constexpr double kPoseAgreement_rad = 0.2 * std::numbers::pi / 180.0;

Belief ends(const std::vector<Chain>& chains) {
  Belief belief;
  for (const Chain& chain : chains) belief.particles.push_back({chain.end(), {}, {}, {}});
  return belief;
}

/// One move against its reference. @return empty where they agree
std::string difference(const GuardedMove::Result& move, const GuardedMove::Result& reference) {
  if (move.outcome != reference.outcome) {
    return std::string("outcome ") + to_string(move.outcome) + ", as planned " +
           to_string(reference.outcome);
  }
  if (move.signature != reference.signature) {
    return "contacts " + to_string(move.signature) + ", as planned " +
           to_string(reference.signature);
  }
  const Vector6 off = displacement_between(reference.pose, move.pose);
  if (off.head<3>().norm() > kPoseAgreement_m || off.tail<3>().norm() > kPoseAgreement_rad) {
    return format("pose differs by %.3f mm and %.3f degrees", 1e3 * off.head<3>().norm(),
                  degrees(off.tail<3>().norm()));
  }
  return {};
}

/// Which chain ends farthest from the goal, those that are not inserted before all others.
std::size_t farthest(const std::vector<Chain>& chains, const Task& task) {
  const auto off = [&](const Chain& chain) {
    return std::pair(!inserted(task, chain.end()), tolerances_from_goal(task, chain.end()));
  };
  const auto worst = std::max_element(chains.begin(), chains.end(),
                                      [&](auto& a, auto& b) { return off(a) < off(b); });
  return static_cast<std::size_t>(worst - chains.begin());
}

void keep_earliest(VariantRun& run, const Disagreement& found) {
  if (run.holds || found.step < run.disagreement.step) run.disagreement = found;
  run.holds = false;
}

/// The first move of a chain that is not as another's; its last where all are.
std::size_t parted(const Chain& chain, const Chain& planned) {
  const std::size_t common = std::min(chain.moves.size(), planned.moves.size());
  for (std::size_t i = 0; i < common; ++i) {
    if (!difference(chain.moves[i], planned.moves[i]).empty()) return chain.steps[i];
  }
  return chain.steps.empty() ? 0 : chain.steps.back();
}

/// Why a chain does not do what it did in the same physics. @return empty where it does
std::string astray(const Chain& chain, const Chain& planned) {
  if (!chain.done) return chain.failure;
  if (!planned.done || chain.moves.empty()) return {};
  const std::string why = difference(chain.moves.back(), planned.moves.back());
  return why.empty() ? why : "at its end, " + why;
}

void judge(VariantRun& run, const VariantRun& reference, const Task& task, std::size_t last_step) {
  run.holds = true;
  const bool same_physics = run.variant.friction == reference.variant.friction &&
                            run.variant.oversize_m == reference.variant.oversize_m &&
                            run.variant.latency_s == reference.variant.latency_s;
  for (std::size_t p = 0; p < run.chains.size(); ++p) {
    const Chain& chain = run.chains[p];
    const Chain& planned = reference.chains[p];
    if (same_physics) {
      const std::string why = astray(chain, planned);
      if (!why.empty()) keep_earliest(run, {parted(chain, planned), p, why});
    } else if (!chain.done) {
      keep_earliest(run, {chain.steps.empty() ? 0 : chain.steps.back(), p, chain.failure});
    }
  }
  if (!run.holds) return;
  const BeliefSummary end = summarise(ends(run.chains), task);
  if (at_goal(end, task)) return;
  keep_earliest(run,
                {last_step, farthest(run.chains, task),
                 format("the chain ends beside the goal: farthest particle %.3f mm, u %.3g m^2",
                        1e3 * end.farthest_m, end.uncertainty_m2)});
}

double cost_of(const std::vector<Chain>& chains, const Task& task) {
  std::vector<BeliefSummary> nodes;
  for (std::size_t i = 0;; ++i) {
    Belief belief;
    for (const Chain& chain : chains) {
      if (i > chain.moves.size()) return 0.0;
      belief.particles.push_back({chain.tool(i), {}, {}, {}});
    }
    nodes.push_back(summarise(belief, task));
    if (i == chains.front().moves.size()) break;
  }
  double cost = 0.0;
  for (std::size_t i = 1; i < nodes.size(); ++i) cost += edge_cost(nodes[i - 1], nodes[i], task);
  return cost;
}

}  // namespace

std::vector<CertificationVariant> certification_variants(const Task& task, const Plan& plan) {
  const std::int64_t step_us = task.rollout_step_us;
  std::vector<CertificationVariant> variants = {
      {"as planned", {}, {}, {}, step_us}, {"half the integration step", {}, {}, {}, step_us / 2}};
  if (plan.method == PlanMethod::kMha) {
    variants.push_back({"lowest friction", task.friction.low, {}, {}, step_us});
    variants.push_back({"highest friction", task.friction.high, {}, {}, step_us});
    if (task.oversize_m > 0.0) variants.push_back({"as drawn", {}, 0.0, {}, step_us});
    if (plan.latency_max_s > 0.0) {
      variants.push_back({"no latency", {}, {}, 0.0, step_us});
      variants.push_back({"longest latency", {}, {}, plan.latency_max_s, step_us});
    }
  }
  return variants;
}

bool Certification::holds() const { return refuting() == nullptr; }

const VariantRun* Certification::refuting() const {
  const VariantRun* earliest = nullptr;
  for (const VariantRun& run : runs) {
    if (run.holds) continue;
    if (earliest == nullptr || run.disagreement.step < earliest->disagreement.step) earliest = &run;
  }
  return earliest;
}

const Start& start_of(const Plan& plan, const Task& task) {
  const Start* start = find_start(task, plan.start_name);
  if (start == nullptr) {
    throw InputError("plan: task '" + task.name + "' has no start '" + plan.start_name +
                     "': give the task that the plan was made from");
  }
  if (!start->pose.position_m.isApprox(plan.start.position_m, 1e-5) ||
      !(start->pose.orientation.angularDistance(plan.start.orientation) < 1e-5)) {
    throw InputError("plan: its start '" + plan.start_name + "' stands elsewhere in task '" +
                     task.name + "': plan again");
  }
  return *start;
}

namespace {

/// All that a plan says besides its steps' ways and outcomes follows from its task.
void check_same_task(const Plan& plan, const Task& task) {
  std::vector<Vector6> displacements;
  for (const Step& step : plan.steps) displacements.push_back(step.displacement);
  Plan drafted = draft_plan(task, start_of(plan, task),
                            {plan.contact_stiffness_Npm, plan.latency_max_s}, displacements);
  drafted.parameter_sets.resize(plan.parameter_sets.size(), drafted.parameter_sets.front());
  for (std::size_t i = 0; i < plan.parameter_sets.size(); ++i) {
    drafted.parameter_sets[i].aligns = plan.parameter_sets[i].aligns;
  }
  const auto demand = [&](bool same, const char* what) {
    if (same) return;
    throw InputError(std::string("plan: its ") + what + " is not that of task '" + task.name +
                     "': plan again, or give the --cell that it was made for");
  };
  demand(plan.goal == drafted.goal, "goal");
  demand(plan.goal_tolerance_m == drafted.goal_tolerance_m && plan.goal_axes == drafted.goal_axes,
         "goal tolerance");
  demand(plan.compliance == drafted.compliance, "compliance");
  demand(plan.force_limit_N == drafted.force_limit_N, "force limit");
  demand(plan.torque_limit_Nm == drafted.torque_limit_Nm, "torque limit");
  demand(plan.parameter_sets == drafted.parameter_sets, "set of speeds, thresholds and times");
}

}  // namespace

Certification certify(std::span<const std::uint8_t> bytes, const Task& task, RolloutPool& pool,
                      CertificationExtent extent) {
  const DecodedPlan decoded = decode_plan(bytes);
  if (!decoded.plan) {
    throw InputError("plan: byte " + std::to_string(decoded.offset) + ", " + decoded.field + ": " +
                     to_string(decoded.error));
  }
  const Plan& plan = *decoded.plan;
  check_same_task(plan, task);
  const Belief belief = in_cell(start_belief(task, start_of(plan, task), plan.method),
                                plan.contact_stiffness_Npm, plan.latency_max_s);
  const std::size_t particles = belief.particles.size();

  Certification certification;
  for (const CertificationVariant& variant : certification_variants(task, plan)) {
    certification.runs.push_back({variant, std::vector<Chain>(particles), false, {}});
  }
  const std::size_t last_step = plan.steps.empty() ? 0 : plan.steps.size() - 1;
  const auto run_from = [&](std::size_t first, std::size_t end) {
    pool.run((end - first) * particles, [&](Rollout& rollout, std::size_t i) {
      VariantRun& run = certification.runs[first + i / particles];
      Particle start = belief.particles[i % particles];
      start.physics.friction = run.variant.friction.value_or(start.physics.friction);
      start.physics.oversize_m = run.variant.oversize_m.value_or(start.physics.oversize_m);
      start.physics.latency_s = run.variant.latency_s.value_or(start.physics.latency_s);
      run.chains[i % particles] = run_chain(rollout, plan, start, run.variant.step_us);
    });
    for (std::size_t i = first; i < end; ++i) {
      judge(certification.runs[i], certification.runs.front(), task, last_step);
    }
  };
  run_from(0, 1);
  if (extent == CertificationExtent::kToFirstRefutation && !certification.runs.front().holds) {
    certification.runs.resize(1);
  } else {
    run_from(1, certification.runs.size());
  }
  certification.cost = cost_of(certification.runs.front().chains, task);
  return certification;
}

}  // namespace tenon::planner

#include "planner/summary.h"

#include <algorithm>
#include <nlohmann/json.hpp>

#include "planner/text.h"

namespace tenon::planner {
namespace {

std::string displacement_text(const Plan& plan, const Vector6& displacement) {
  std::string text;
  for (int axis = 0; axis < 6; ++axis) {
    if ((plan.coordinates >> axis & 1U) == 0 || displacement[axis] == 0.0) continue;
    text += format("%s%s %+.1f", text.empty() ? "" : ", ", axis_name(axis),
                   shown(displacement[axis], axis));
  }
  return text.empty() ? "none" : text;
}

std::string rule_text(const Plan& plan, Outcome outcome, const OutcomeRule& rule) {
  std::string text = format("       %-8s", to_string(outcome));
  if (plan.check_envelopes) {
    for (int axis = 0; axis < 6; ++axis) {
      if ((plan.coordinates >> axis & 1U) == 0) continue;
      text += format(" %s [%.1f, %.1f]", axis_name(axis),
                     shown(rule.envelope.travelled_min[axis], axis),
                     shown(rule.envelope.travelled_max[axis], axis));
    }
    text += "  contacts " + to_string(rule.envelope.always);
    const ContactSignature sometimes{
        static_cast<std::uint16_t>(rule.envelope.possible.bits & ~rule.envelope.always.bits)};
    if (sometimes.count() > 0) text += ", perhaps " + to_string(sometimes);
  }
  return text + (rule.successor == kSuccessorDone
                     ? "  -> done\n"
                     : format("  -> %d\n", static_cast<int>(rule.successor)));
}

double peak_force_N(const PlanReport& report) {
  double peak_N = 0.0;
  for (const Draw& draw : report.validation.draws) {
    for (const GuardedMove::Result& move : draw.chain.moves) {
      peak_N = std::max(peak_N, move.peak_force_N);
    }
  }
  return peak_N;
}

}  // namespace

std::string step_table(const Plan& plan) {
  std::string text = "step   displacement (mm, deg)    slow from (mm)\n";
  for (std::size_t i = 0; i < plan.steps.size(); ++i) {
    const Step& step = plan.steps[i];
    text += format("%4zu   %-25s %8.1f\n", i, displacement_text(plan, step.displacement).c_str(),
                   1e3 * step.slow_from_m);
    for (const Outcome outcome : kOutcomes) {
      const OutcomeRule& rule = step.rule(outcome);
      if (rule.successor != kSuccessorFail) text += rule_text(plan, outcome, rule);
    }
  }
  return text;
}

std::string summary(const PlanReport& report, const Task& task, const std::string& file) {
  const Plan& plan = *report.plan;
  const PlannerTimes& t = report.times;
  const Validation& v = report.validation;
  const auto moves = [](const SuccessorEngine::Counters& c) {
    return static_cast<unsigned long long>(c.rollouts);
  };
  std::string text;
  text +=
      format("%s: start %s of %s, %zu steps, %zu bytes\n", file.c_str(), plan.start_name.c_str(),
             plan.task_name.c_str(), plan.steps.size(), report.bytes.size());
  text += format("cost %.0f, at most %.2f times the optimum of the searched graph\n", plan.cost,
                 plan.bound);
  text += format("search: %zu expansions, %zu states, %zu attractors, %zu refuted edges\n",
                 report.expansions, report.states, report.attractors, report.refusals.size());
  text += format(
      "simulated moves: %llu attractors, %llu search (%llu known), %llu certification, "
      "%llu validation\n",
      moves(report.attractor_moves), moves(report.search_moves),
      static_cast<unsigned long long>(report.search_moves.memo_hits),
      static_cast<unsigned long long>(report.certification_moves),
      static_cast<unsigned long long>(report.validation_moves));
  text +=
      format("time: %.2f s attractors, %.2f s search, %.2f s certification, %.2f s validation\n",
             t.attractors_s, t.search_s, t.certification_s, t.validation_s);
  text += format(
      "validation: %zu of %zu draws end at the goal (%zu of %zu within %g sigma), "
      "peak force %.0f N\n",
      v.at_goal(), v.draws.size(), v.at_goal_within(task.particle_sigmas),
      v.within(task.particle_sigmas), task.particle_sigmas, peak_force_N(report));
  for (const std::string& change : report.adapted) text += "for the cell: " + change + "\n";
  for (const std::string& refusal : report.refusals) text += "refuted: " + refusal + "\n";
  return text + step_table(plan);
}

std::string statistics_json(const PlanReport& report) {
  const auto moves = [](const SuccessorEngine::Counters& c) {
    return nlohmann::ordered_json{
        {"simulated", c.rollouts}, {"memo_hits", c.memo_hits}, {"failures", c.failures}};
  };
  nlohmann::ordered_json json;
  json["status"] = to_string(report.status);
  json["reason"] = report.reason;
  json["attractors"] = report.attractors;
  json["states"] = report.states;
  json["expansions"] = report.expansions;
  json["refusals"] = report.refusals;
  json["adapted"] = report.adapted;
  json["moves"] = {{"attractors", moves(report.attractor_moves)},
                   {"search", moves(report.search_moves)},
                   {"certification", report.certification_moves},
                   {"validation", report.validation_moves}};
  json["time_s"] = {{"attractors", report.times.attractors_s},
                    {"search", report.times.search_s},
                    {"certification", report.times.certification_s},
                    {"validation", report.times.validation_s}};
  if (report.plan) {
    json["start"] = report.plan->start_name;
    json["steps"] = report.plan->steps.size();
    json["bytes"] = report.bytes.size();
    json["cost"] = report.plan->cost;
    json["bound"] = report.plan->bound;
    json["draws"] = report.plan->draws;
    json["draws_at_goal"] = report.plan->draws_at_goal;
    json["peak_force_N"] = peak_force_N(report);
  }
  return json.dump(2) + "\n";
}

}  // namespace tenon::planner

#include "planner/report/summary.h"

#include <algorithm>
#include <limits>
#include <map>
#include <optional>

#include "planner/judge/refutation.h"
#include "planner/report/report_words.h"
#include "shared/base/shown.h"
#include "shared/base/text.h"
#include "shared/base/wilson.h"
#include "shared/task/spread.h"

namespace tenon::planner {
namespace {

// Of the draws within reach, at the goal: what a plan is to be relied on for.
constexpr double kReliable = 0.95;

std::string displacement_text(const Plan& plan, const Vector6& displacement) {
  std::string text;
  for (int axis = 0; axis < 6; ++axis) {
    if (!has(plan.coordinates, axis) || displacement[axis] == 0.0) continue;
    text += format("%s%s %+.1f", text.empty() ? "" : ", ", axis_name(axis),
                   shown(displacement[axis], axis));
  }
  return text.empty() ? "none" : text;
}

std::string successor_text(Successor successor) {
  return successor == kSuccessorDone ? " -> done\n"
                                     : format(" -> %d\n", static_cast<int>(successor));
}

std::string envelope_text(const Plan& plan, const Envelope& envelope) {
  std::string text;
  for (int axis = 0; axis < 6; ++axis) {
    if (!has(plan.coordinates, axis)) continue;
    text += format(" %s [%.1f, %.1f]", axis_name(axis), shown(envelope.travelled_min[axis], axis),
                   shown(envelope.travelled_max[axis], axis));
  }
  return text + "  contacts " + contacts_text(envelope);
}

/// A line for each outcome that leads on; without envelopes, one for all that lead to one step.
std::string rules_text(const Plan& plan, const Step& step) {
  std::string text;
  std::map<Successor, std::string> names_to;
  for (const Outcome outcome : kOutcomes) {
    const OutcomeRule& rule = step.rule(outcome);
    if (rule.successor == kSuccessorFail) continue;
    if (plan.check_envelopes) {
      text += format("       %-8s", to_string(outcome)) + envelope_text(plan, rule.envelope) + " " +
              successor_text(rule.successor);
    } else {
      std::string& names = names_to[rule.successor];
      names += (names.empty() ? "" : ", ") + std::string(to_string(outcome));
    }
  }
  for (const auto& [successor, names] : names_to) {
    text += "       " + names + successor_text(successor);
  }
  return text;
}

/// ", tilted by up to 0.17 degrees", or "by up to 0.09 of 0.17 degrees". @param held of it, rad
std::string tilt_text(double held, double stated) {
  const std::string most = format("%.2g degrees", shown(stated, 3));
  return ", tilted by up to " + (held < stated ? format("%.2g of ", shown(held, 3)) : "") + most;
}

/// A line for all draws that were stopped in one step, and one for all that ended beside the goal.
std::string misses_text(const PlanReport& report, const Task& task) {
  struct Alike {
    std::optional<std::size_t> step;
    std::string first;
    std::size_t more = 0;
  };
  std::vector<Alike> all;
  for (const Draw& draw : report.validation.draws) {
    if (draw.at_goal) continue;
    std::optional<std::size_t> step;
    if (!draw.chain.done) step = draw.chain.steps.back();
    const auto known =
        std::find_if(all.begin(), all.end(), [&](const Alike& one) { return one.step == step; });
    if (known != all.end()) {
      ++known->more;
    } else {
      all.push_back({step, out_text(task, draw.sigmas_out) + ", " + miss_text(draw.chain, task)});
    }
  }
  std::string text;
  for (const Alike& one : all) {
    text += "missed: " + one.first;
    if (one.more > 0) text += format("; %zu more ", one.more) + (one.step ? "there" : "beside it");
    text += "\n";
  }
  return text;
}

}  // namespace

double peak_force_N(const PlanReport& report) {
  double peak_N = 0.0;
  for (const Draw& draw : report.validation.draws) {
    for (const GuardedMove::Result& move : draw.chain.moves) {
      peak_N = std::max(peak_N, move.peak_force_N);
    }
  }
  return peak_N;
}

std::vector<std::string> missed(const PlanReport& report, const Task& task) {
  std::vector<std::string> lines;
  for (const Draw& draw : report.validation.draws) {
    if (draw.at_goal) continue;
    lines.push_back(out_text(task, draw.sigmas_out) + ", " + miss_text(draw.chain, task));
  }
  return lines;
}

std::string cost_text(const Plan& plan) {
  return format("cost %.0f, ", plan.cost) +
         (plan.bound > 0.0
              ? format("at most %.2f times the optimum of the searched graph\n", plan.bound)
              : "no bound proven\n");
}

std::string estimate_text(const Validation& validation, const Task& task) {
  const std::size_t count = validation.draws.size();
  const Interval interval = wilson_interval(validation.at_goal(), count);
  return format("%zu of %zu draws end at the goal (95 %%: %.1f to %.1f %%), %zu of %zu ",
                validation.at_goal(), count, 1e2 * interval.low, 1e2 * interval.high,
                validation.at_goal_within(task.particle_sigmas),
                validation.within(task.particle_sigmas)) +
         within_text(task, task.particle_sigmas);
}

std::string doubt_text(const Validation& validation, const Task& task) {
  const std::size_t within = validation.within(task.particle_sigmas);
  const std::size_t good = validation.at_goal_within(task.particle_sigmas);
  if (within == 0 || wilson_interval(good, within).high >= kReliable) return {};
  std::string text = format("only %zu of %zu random starts ", good, within) +
                     within_text(task, task.particle_sigmas) + " end at the goal";
  const double held_rad = validation.held.tilt_rad;
  if (!tilted_axes(task).empty() && held_rad < task.tilt_rad) {
    text += format(
        "; of the %.2g degrees of tilt that physics.tilt_rad allows for the plan bears "
        "%.2g: more play at the goal helps, or a cell that is calibrated better",
        shown(task.tilt_rad, 3), shown(held_rad, 3));
  }
  return text;
}

std::string corners_text(const Validation& validation, const Task& task) {
  double latency_s = 0.0;
  double softest_Npm = std::numeric_limits<double>::infinity();
  double stiffest_Npm = 0.0;
  for (const Draw& corner : validation.corners) {
    const PhysicalParameters& its = corner.chain.start.physics;
    latency_s = std::max(latency_s, its.latency_s);
    softest_Npm = std::min(softest_Npm, its.contact_stiffness_Npm);
    stiffest_Npm = std::max(stiffest_Npm, its.contact_stiffness_Npm);
  }
  std::string physics = format("friction %g and %g", task.friction.low, task.friction.high);
  if (softest_Npm < stiffest_Npm) {
    physics += format(", contacts of %.3g and %.3g N/mm", 1e-3 * softest_Npm, 1e-3 * stiffest_Npm);
  }
  if (latency_s > 0.0) physics += format(", latency 0 and %.1f ms", 1e3 * latency_s);
  if (task.oversize_m > 0.0) {
    physics += format(", the part as drawn and %g mm larger", 1e3 * task.oversize_m);
  }
  const CalibrationErrors& held = validation.held;
  if (sensor_errors(task).size() > 1) {
    const double stated_m = task.sensor_error_m;
    physics += ", the force sensor up to " +
               (held.sensor_error_m < stated_m ? format("%g of ", 1e3 * held.sensor_error_m) : "") +
               format("%g mm off", 1e3 * stated_m);
  }
  if (!tilted_axes(task).empty()) physics += tilt_text(held.tilt_rad, task.tilt_rad);
  return format("%zu of %zu starts ", arrived(validation.corners), validation.corners.size()) +
         reach_text(task) + " end at the goal, at " + physics;
}

std::string step_table(const Plan& plan) {
  std::string text = "step   displacement (mm, deg)    slow from (mm)\n";
  for (std::size_t i = 0; i < plan.steps.size(); ++i) {
    const Step& step = plan.steps[i];
    text += format("%4zu   %-25s %8.1f\n", i, displacement_text(plan, step.displacement).c_str(),
                   1e3 * step.slow_from_m);
    text += rules_text(plan, step);
  }
  return text;
}

std::string cell_changes_text(const std::vector<std::string>& changes) {
  std::string text;
  for (const std::string& change : changes) text += "for the cell: " + change + "\n";
  return text;
}

std::string summary(const PlanReport& report, const Task& task, const std::string& file) {
  const Plan& plan = *report.plan;
  const auto moves = [](const SuccessorEngine::Counters& c) {
    return static_cast<unsigned long long>(c.rollouts);
  };
  std::string text;
  text += format("%s: start %s of %s, method %s, %zu step%s, %zu bytes\n", file.c_str(),
                 plan.start_name.c_str(), plan.task_name.c_str(), to_string(plan.method),
                 plan.steps.size(), plural(plan.steps.size()), report.bytes.size());
  text += cost_text(plan);
  text += format(
      "search: %zu expansion%s (%zu for the first path), %zu state%s, %zu guide%s, "
      "%zu refuted path%s\n",
      report.expansions, plural(report.expansions), report.expansions_first, report.states,
      plural(report.states), report.guides, plural(report.guides), report.refusals.size(),
      plural(report.refusals.size()));
  if (!report.guide.empty())
    text += "way: the guide " + report.guide + ", followed to the letter\n";
  text += format(
      "simulated moves: %llu attractors, %llu search (%llu known), %llu certification, "
      "%llu corners, %llu validation\n",
      moves(report.attractor_moves), moves(report.search_moves),
      static_cast<unsigned long long>(report.search_moves.memo_hits),
      static_cast<unsigned long long>(report.judging.certification.moves),
      static_cast<unsigned long long>(report.judging.corners.moves),
      static_cast<unsigned long long>(report.judging.validation.moves));
  text += format(
      "time: %.2f s attractors, %.2f s search, %.2f s certification, %.2f s corners, "
      "%.2f s validation\n",
      report.times.attractors_s, report.times.search_s, report.judging.certification.time_s,
      report.judging.corners.time_s, report.judging.validation.time_s);
  text += "validation: " + estimate_text(report.validation, task) +
          format(", peak force %.0f N\n", peak_force_N(report));
  text += "corners: " + corners_text(report.validation, task) + "\n";
  if (!report.validation.rim.empty()) {
    text +=
        format("beyond the promise: %zu of %zu starts %g sigma out end there too\n",
               arrived(report.validation.rim), report.validation.rim.size(), drawn_sigmas(task));
  }
  text += misses_text(report, task);
  text += cell_changes_text(report.adapted);
  for (const std::string& refusal : report.refusals) text += "refuted: " + refusal + "\n";
  return text + step_table(plan);
}

}  // namespace tenon::planner

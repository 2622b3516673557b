#include "planner/smaller_errors.h"

#include <algorithm>
#include <array>
#include <limits>

#include "shared/base/text.h"
#include "shared/task/spread.h"

namespace tenon::planner {
namespace {

struct Part {
  double share;
  const char* name;
};
constexpr std::array<Part, 3> kParts = {
    {{0.25, "a quarter"}, {0.5, "half"}, {0.75, "three quarters"}}};

constexpr double kShareOfEffort = 0.5;
constexpr double kLeast_s = 2.0;

/// What can be for want of knowing where things are.
bool for_want_of_certainty(PlanStatus status) {
  switch (status) {
    case PlanStatus::kExhausted:
    case PlanStatus::kNoAttractor:
    case PlanStatus::kTimeLimit:
    case PlanStatus::kExpansionLimit:
    case PlanStatus::kNotCertified:
    case PlanStatus::kMoveLimit:
      return true;
    case PlanStatus::kPlanned:
    case PlanStatus::kInCollision:
    case PlanStatus::kAlreadyAtGoal:
    case PlanStatus::kOutOfReach:
      return false;
  }
  return false;
}

double seconds(const PlanReport& report) {
  return report.times.attractors_s + report.times.search_s + report.judging.time_s();
}

std::uint64_t moves(const PlanReport& report) {
  return report.search_moves.rollouts + report.attractor_moves.rollouts + report.judging.moves();
}

/// As the task file states them: "sigma_m: [0.015, 0.015], sigma_rad: [0.02]".
std::string errors_text(const Task& task, const Start& start) {
  std::string text;
  for (const int first : {0, 3}) {
    std::string numbers;
    for (int axis = first; axis < first + 3; ++axis) {
      if (!has(task.coordinates, axis)) continue;
      numbers += (numbers.empty() ? "" : ", ") + format("%.3g", stated_error(task, start, axis));
    }
    if (numbers.empty()) continue;
    text +=
        (text.empty() ? "" : ", ") + std::string(error_key(task, first)) + ": [" + numbers + "]";
  }
  return text;
}

}  // namespace

std::string smaller_errors_text(const PlanReport& failed, const Task& task, const Start& start,
                                const Rollout& rollout, const PlannerOptions& options,
                                const ClockSeconds& now_s) {
  if (!for_want_of_certainty(failed.status) || options.method != PlanMethod::kMha) return {};
  if (start.sigma.isZero()) return {};
  const double until_s = now_s() + std::max(kLeast_s, kShareOfEffort * seconds(failed));
  std::uint64_t moves_left = options.moves_max == std::numeric_limits<std::uint64_t>::max()
                                 ? options.moves_max
                                 : options.moves_max / 2;
  std::string has_plan;
  for (const Part& part : kParts) {
    Task smaller = task;
    smaller.starts = {start};
    smaller.starts.front().sigma *= part.share;
    smaller.time_limit_s = until_s - now_s();
    const Start& surer = smaller.starts.front();
    PlannerOptions once = options;
    once.planned = {};
    once.improve_s = 0.0;
    once.moves_max = moves_left;
    if (options.progress) options.progress(format("with %s of the start's errors", part.name));
    const double began_s = now_s();
    const PlanReport report =
        make_plan(smaller, surer, rollout, once, [&] { return now_s() - began_s; });
    if (report.status != PlanStatus::kPlanned) {
      return has_plan.empty() ? format("; nor was one found with %s of its errors (%s)", part.name,
                                       errors_text(task, surer).c_str())
                              : has_plan + format(", with %s none was found", part.name);
    }
    has_plan = format("; with %s of its errors (%s) it has a plan", part.name,
                      errors_text(task, surer).c_str());
    moves_left -= std::min(moves_left, moves(report));
  }
  return has_plan;
}

}  // namespace tenon::planner

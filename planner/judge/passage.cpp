#include "planner/judge/passage.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "planner/belief/primitives.h"
#include "planner/judge/plan_draft.h"
#include "shared/task/inserted.h"

namespace tenon::planner {
namespace {

// So many starts to either side stand for all.
constexpr std::size_t kFarthest = 3;
// Halvings until a shift passes, and after that until its bound is known to an eighth.
constexpr int kHalvings = 7;
constexpr int kBisections = 3;
// What the middle has to gain, and how far it stays from what the extremes bear, of half of that.
constexpr double kWorth = 0.1;

/// The steps from one on, as a plan.
Plan tail(const Plan& plan, std::size_t first) {
  Plan rest = plan;
  rest.steps.erase(rest.steps.begin(), rest.steps.begin() + static_cast<std::ptrdiff_t>(first));
  for (Step& step : rest.steps) {
    for (OutcomeRule& rule : step.outcomes) {
      if (rule.successor != kSuccessorDone && rule.successor != kSuccessorFail) {
        rule.successor = static_cast<Successor>(rule.successor - first);
      }
    }
  }
  return rest;
}

/// Where a chain rests before a step.
Particle before(const Chain& chain, std::size_t step) {
  Particle particle = chain.start;
  if (step > 0) {
    particle.pose = chain.moves[step - 1].pose;
    particle.signature = chain.moves[step - 1].signature;
  }
  return particle;
}

/// All along a step, and after it.
bool hangs_free(std::span<const Chain> chains, std::size_t step) {
  return std::all_of(chains.begin(), chains.end(), [step](const Chain& chain) {
    return chain.steps[step] == step && before(chain, step).signature.bits == 0 &&
           chain.moves[step].outcome == Outcome::kReached && chain.touching[step].empty();
  });
}

void shift(Step& step, int axis, double by_m) { step.displacement[axis] += by_m; }

/// From the axes of a tool's moves to those that its pose is in: none but where it carries them.
Eigen::Quaterniond move_axes(const Task& task, const Pose& tool) {
  if (!task.motion.carried_axes) return Eigen::Quaterniond::Identity();
  return tool.orientation * task.goal.orientation.conjugate();
}

/// A tool shifted along one of its moves' axes.
Pose aside(const Task& task, const Pose& tool, int axis, double by_m) {
  Pose shifted = tool;
  shifted.position_m += move_axes(task, tool) * Vector3(by_m * Vector3::Unit(axis));
  return shifted;
}

struct Range {
  double low_m = 0.0;
  double high_m = 0.0;

  [[nodiscard]] double middle_m() const { return 0.5 * (low_m + high_m); }
  [[nodiscard]] double half_m() const { return 0.5 * (high_m - low_m); }
};

/// One step's shifts along one axis, tried on starts that rest before it.
class Passage {
 public:
  /// @param chains that arrive, of the plan: the farthest to either side stand for all
  Passage(const Plan& plan, std::size_t step, int axis, std::span<const Chain> chains,
          const Task& task, const RunStarts& run)
      : tail_(tail(plan, step)), axis_(axis), task_(task), run_(run) {
    std::vector<std::pair<double, JudgedStart>> across;
    for (const Chain& chain : chains) {
      across.emplace_back(half_way_m(chain, step), JudgedStart{before(chain, step), 0.0});
    }
    std::sort(across.begin(), across.end(),
              [](const auto& a, const auto& b) { return a.first < b.first; });
    for (std::size_t i = 0; i < across.size(); ++i) {
      if (i < kFarthest || i + kFarthest >= across.size()) starts_.push_back(across[i].second);
    }
  }

  /// Whether all arrive. A part that nothing guides ends beside the goal by the shift.
  [[nodiscard]] bool passes(double by_m) const {
    Plan shifted = tail_;
    shift(shifted.steps.front(), axis_, by_m);
    const auto misses = [&](const Draw& draw) {
      if (!draw.chain.done) return true;
      const Pose end = draw.chain.end();
      return !ends_well(end) && !ends_well(aside(task_, end, axis_, -by_m));
    };
    const std::vector<Draw> draws = run_(shifted, starts_, misses);
    return std::none_of(draws.begin(), draws.end(), misses);
  }

  /// Shifts with which all arrive.
  /// @param most_m shifts by more are not looked at
  [[nodiscard]] Range range(double most_m) const {
    return {passes(-most_m) ? -most_m : bound_m(-most_m),
            passes(most_m) ? most_m : bound_m(most_m)};
  }

 private:
  [[nodiscard]] bool ends_well(const Pose& end) const {
    return inserted(task_, end) && within_tolerance(task_, end);
  }

  /// Where on this axis it would be half way from the step on if nothing were there, from the goal.
  [[nodiscard]] double half_way_m(const Chain& chain, std::size_t step) const {
    Pose half_way = chain.moves[step].pose;
    const Eigen::Quaterniond axes = move_axes(task_, half_way);
    for (std::size_t i = 1; i < tail_.steps.size(); ++i) {
      half_way.position_m += axes * Vector3(0.5 * tail_.steps[i].displacement.head<3>());
    }
    half_way = seen_from(chain.start.environment, half_way);
    const Vector3 off_m = half_way.position_m - task_.goal.position_m;
    return (move_axes(task_, half_way).conjugate() * off_m)[axis_];
  }

  /// Up to where all arrive, to one side. @param beyond_m where they do not
  [[nodiscard]] double bound_m(double beyond_m) const {
    double within_m = 0.5 * beyond_m;
    for (int i = 0; !passes(within_m); ++i) {
      if (i == kHalvings) return 0.0;
      beyond_m = within_m;
      within_m *= 0.5;
    }
    for (int i = 0; i < kBisections; ++i) {
      const double between_m = 0.5 * (within_m + beyond_m);
      (passes(between_m) ? within_m : beyond_m) = between_m;
    }
    return within_m;
  }

  Plan tail_;
  int axis_;
  const Task& task_;
  const RunStarts& run_;
  std::vector<JudgedStart> starts_;
};

/// Translations across the way that is left after a step.
std::vector<int> across(const Plan& plan, std::size_t step, const Task& task) {
  Vector3 way_m = Vector3::Zero();
  for (std::size_t i = step + 1; i < plan.steps.size(); ++i) {
    way_m += plan.steps[i].displacement.head<3>();
  }
  int along = 0;
  way_m.cwiseAbs().maxCoeff(&along);
  std::vector<int> axes;
  for (int axis = 0; axis < 3; ++axis) {
    if (axis != along && has(moved_axes(task), axis)) axes.push_back(axis);
  }
  return axes;
}

/// Whether the part stands free after a step, to either side too.
bool stands_free(std::span<const Chain> chains, std::size_t step, const Task& task,
                 const std::vector<int>& axes, Rollout& rollout) {
  return std::none_of(chains.begin(), chains.end(), [&](const Chain& chain) {
    return std::any_of(axes.begin(), axes.end(), [&](int axis) {
      const Pose tool = chain.tool(step + 1);
      return rollout.in_collision(aside(task, tool, axis, task.goal_tolerance_m)) ||
             rollout.in_collision(aside(task, tool, axis, -task.goal_tolerance_m));
    });
  });
}

/// The last step after which it does, though not the plan's last.
std::optional<std::size_t> placing(const Plan& plan, std::span<const Chain> chains,
                                   const Task& task, Rollout& rollout) {
  for (std::size_t step = plan.steps.size() - 1; step-- > 0;) {
    if (!stands_free(chains, step, task, across(plan, step, task), rollout)) continue;
    if (hangs_free(chains, step)) return step;
    break;
  }
  return std::nullopt;
}

}  // namespace

std::optional<Plan> with_passage_centred(const Plan& plan, std::span<const Chain> chains,
                                         const Task& task, const PassageStarts& starts,
                                         Rollout& rollout, const RunStarts& run) {
  const bool whole = std::all_of(chains.begin(), chains.end(), [&](const Chain& chain) {
    return chain.moves.size() == plan.steps.size();
  });
  if (plan.steps.empty() || chains.empty() || !whole) return std::nullopt;
  const auto step = placing(plan, chains, task, rollout);
  const std::vector<int> axes = step ? across(plan, *step, task) : std::vector<int>();
  if (axes.empty()) return std::nullopt;
  const auto ran = [&](const std::vector<JudgedStart>& from) {
    return from.empty() ? std::vector<Chain>(chains.begin(), chains.end())
                        : good_chains(run(plan, from, {}));
  };
  const std::vector<Chain> usual = ran(starts.usual);
  const std::vector<Chain> extreme = ran(starts.extreme);
  if (usual.empty() || extreme.empty()) return std::nullopt;
  Plan centred = plan;
  for (const int axis : axes) {
    const auto range = [&](const std::vector<Chain>& known) {
      return Passage(centred, *step, axis, known, task, run).range(task.goal_tolerance_m);
    };
    const Range borne = range(extreme);
    const double within_m = (1.0 - kWorth) * borne.half_m();
    const double middle_m = std::clamp(range(usual).middle_m(), borne.middle_m() - within_m,
                                       borne.middle_m() + within_m);
    if (std::abs(middle_m) < kWorth * borne.half_m()) continue;
    shift(centred.steps[*step], axis, middle_m);
  }
  if (centred.steps[*step].displacement == plan.steps[*step].displacement) return std::nullopt;
  return through_bytes(centred);
}

}  // namespace tenon::planner

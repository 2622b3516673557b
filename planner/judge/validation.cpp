#include "planner/judge/validation.h"

#include <algorithm>
#include <atomic>
#include <bit>
#include <optional>
#include <string_view>
#include <utility>

#include "planner/belief/belief.h"
#include "shared/base/fnv.h"
#include "shared/plan/codec.h"
#include "shared/task/inserted.h"

namespace tenon::planner {
namespace {

bool ends_at_goal(const Chain& chain, const Task& task) {
  return chain.done && inserted(task, chain.end()) && within_tolerance(task, chain.end());
}

/// Each index once, in the order of its binary digits read backwards (van der Corput): after so
/// many no gap between them is wider than 4 count / many.
std::vector<std::size_t> far_apart(std::size_t count) {
  const std::size_t all = std::bit_ceil(count);
  std::vector<std::size_t> order;
  for (std::size_t i = 0; i < all; ++i) {
    std::size_t backwards = 0;
    for (std::size_t bit = 1; bit < all; bit *= 2) {
      backwards = 2 * backwards + ((i & bit) != 0 ? 1 : 0);
    }
    if (backwards < count) order.push_back(backwards);
  }
  return order;
}

}  // namespace

const Draw* missed_draw(std::span<const Draw> draws, double sigmas) {
  const auto missed = std::find_if(draws.begin(), draws.end(), [sigmas](const Draw& draw) {
    return !draw.at_goal && draw.sigmas_out <= sigmas;
  });
  return missed == draws.end() ? nullptr : &*missed;
}

std::size_t arrived(std::span<const Draw> draws) {
  return static_cast<std::size_t>(
      std::count_if(draws.begin(), draws.end(), [](const Draw& d) { return d.at_goal; }));
}

std::vector<Chain> good_chains(std::span<const Draw> draws) {
  std::vector<Chain> chains;
  for (const Draw& draw : draws) {
    if (draw.at_goal) chains.push_back(draw.chain);
  }
  return chains;
}

std::size_t Validation::at_goal() const { return arrived(draws); }

std::size_t Validation::within(double sigmas) const {
  return static_cast<std::size_t>(std::count_if(
      draws.begin(), draws.end(), [&](const Draw& d) { return d.sigmas_out <= sigmas; }));
}

std::size_t Validation::at_goal_within(double sigmas) const {
  return static_cast<std::size_t>(std::count_if(draws.begin(), draws.end(), [&](const Draw& d) {
    return d.at_goal && d.sigmas_out <= sigmas;
  }));
}

std::uint64_t judging_seed(const Plan& plan) {
  Plan unjudged = plan;
  unjudged.cost = 0.0;
  unjudged.bound = 0.0;
  unjudged.draws = 0;
  unjudged.draws_at_goal = 0;
  const std::vector<std::uint8_t> bytes = encode_plan(unjudged);
  return fnv1a_64({reinterpret_cast<const char*>(bytes.data()), bytes.size()});
}

std::vector<Draw> run_starts(const Plan& plan, const Task& task,
                             std::span<const JudgedStart> starts, RolloutPool& pool,
                             const std::function<bool(const Draw&)>& until) {
  std::vector<Draw> draws(starts.size());
  std::atomic<std::size_t> last{starts.size()};
  pool.run(starts.size(), [&](Rollout& rollout, std::size_t i) {
    if (i > last) return;
    Draw& draw = draws[i];
    draw.sigmas_out = starts[i].sigmas_out;
    draw.chain = run_chain(rollout, plan, starts[i].particle, task.rollout_step_us);
    draw.at_goal = ends_at_goal(draw.chain, task);
    if (!until || !until(draw)) return;
    for (std::size_t seen = last; i < seen && !last.compare_exchange_weak(seen, i);) {
    }
  });
  if (last < draws.size()) draws.resize(last + 1);
  return draws;
}

std::vector<Draw> run_past_miss(
    std::span<const JudgedStart> starts, double sigmas, std::size_t at_once,
    const std::function<std::vector<Draw>(std::span<const JudgedStart>)>& run) {
  const std::vector<std::size_t> order = far_apart(starts.size());
  std::vector<std::optional<Draw>> ran(starts.size());
  std::size_t enough = starts.size();
  bool missed = false;
  for (std::size_t i = 0; i < enough;) {
    std::vector<JudgedStart> some;
    for (std::size_t j = i; j < std::min(i + at_once, enough); ++j) {
      some.push_back(starts[order[j]]);
    }
    std::vector<Draw> draws = run(some);
    const bool first = !missed && missed_draw(draws, sigmas) != nullptr;
    for (Draw& draw : draws) ran[order[i++]] = std::move(draw);
    if (first) enough = std::min(2 * i, starts.size());
    missed = missed || first;
  }
  std::vector<Draw> in_order;
  for (std::optional<Draw>& draw : ran) {
    if (draw) in_order.push_back(*std::move(draw));
  }
  return in_order;
}

void hold_extremes(const Plan& plan, const Task& task, const Start& start, Rollout& rollout,
                   Validation& validation,
                   const std::function<std::vector<Draw>(std::span<const JudgedStart>)>& run) {
  Task held = task;
  for (const CalibrationErrors& errors : errors_to_hold(task)) {
    validation.held = errors;
    held = holding(task, errors);
    validation.corners = run(corner_starts(plan, held, start, rollout));
    const bool all = arrived(validation.corners) == validation.corners.size();
    if (all || plan.method != PlanMethod::kMha) break;
  }
  validation.rim = run(rim_starts(plan, held, start, rollout));
}

Validation validate(const Plan& plan, const Task& task, const Start& start, std::size_t draws,
                    RolloutPool& pool) {
  const auto run = [&](std::span<const JudgedStart> starts) {
    return run_starts(plan, task, starts, pool);
  };
  Rollout& rollout = pool.front();
  Validation validation;
  validation.draws =
      run(drawn_starts(judging_seed(plan), draws, DrawnPhysics::kEven, plan, task, start, rollout));
  hold_extremes(plan, task, start, rollout, validation, run);
  return validation;
}

std::vector<Draw> decided_by(const Plan& plan, const Task& task, std::span<const Draw> draws) {
  std::vector<Draw> decided(draws.begin(), draws.end());
  for (Draw& draw : decided) {
    Chain& chain = draw.chain;
    const std::size_t end = first_deviation(plan, chain);
    if (end < chain.moves.size()) {
      chain.failure = describe(
          transition(plan, chain.steps[end], chain.start.pose, chain.moves[end]), chain.moves[end]);
      chain.done = false;
      chain.moves.resize(end + 1);
      chain.steps.resize(end + 1);
      chain.touching.resize(end + 1);
    }
    draw.at_goal = ends_at_goal(chain, task);
  }
  return decided;
}

}  // namespace tenon::planner

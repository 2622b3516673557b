#include "planner/judge/plain_touches.h"

#include <algorithm>

#include "planner/judge/plan_draft.h"

namespace tenon::planner {
namespace {

// A rotation is settled where a touch leaves less than this of its spread.
constexpr double kSettled = 0.5;

/// How far the parts are turned apart as the environments see them, rad, after so many moves.
Vector3 turned_apart_rad(std::span<const Chain> chains, const Pose& goal, std::size_t after) {
  Vector3 least = Vector3::Constant(1e9);
  Vector3 most = -least;
  for (const Chain& chain : chains) {
    const Vector3 turned = displacement_between(goal, chain.tool(after)).tail<3>();
    least = least.cwiseMin(turned);
    most = most.cwiseMax(turned);
  }
  return most - least;
}

bool settles_rotation(std::span<const Chain> chains, const Plan& plan, std::size_t step) {
  const Vector3 before = turned_apart_rad(chains, plan.goal, step);
  const Vector3 after = turned_apart_rad(chains, plan.goal, step + 1);
  return (after.array() < kSettled * before.array()).any();
}

bool touches(std::span<const Chain> chains, std::size_t step) {
  return std::any_of(chains.begin(), chains.end(), [&](const Chain& chain) {
    return chain.moves[step].outcome == Outcome::kContact;
  });
}

}  // namespace

std::optional<Plan> with_plain_touches(const Plan& draft, std::span<const Chain> chains) {
  if (draft.compliance.compliant_axes >> 3 == 0) return std::nullopt;
  Plan plan = draft;
  bool changed = false;
  for (std::size_t step = 0; step < plan.steps.size(); ++step) {
    if (!touches(chains, step) || settles_rotation(chains, plan, step)) continue;
    if (plan.steps[step].parameter_set != 0) continue;
    make_plain(plan, step);
    changed = true;
  }
  if (!changed) return std::nullopt;
  return through_bytes(plan);
}

}  // namespace tenon::planner

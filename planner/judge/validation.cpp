#include "planner/judge/validation.h"

#include <algorithm>
#include <cmath>
#include <span>

#include "planner/belief/belief.h"
#include "shared/base/random.h"
#include "shared/task/inserted.h"

namespace tenon::planner {
namespace {

// A start whose every draw collides is no start; the planner has refused it before.
constexpr int kAttempts = 1000;
// Draws between one look at the results and the next.
constexpr std::size_t kBatch = 20;

struct DrawnStart {
  Particle particle;
  double mahalanobis = 0.0;
};

double reach_sigmas(const Task& task) { return task.particle_sigmas + 1.0; }

DrawnStart draw_start(Random& random, const Plan& plan, const Task& task, const Start& start,
                      Rollout& rollout) {
  DrawnStart drawn;
  for (int attempt = 0; attempt < kAttempts; ++attempt) {
    Vector6 offset = Vector6::Zero();
    double squares = 0.0;
    for (int axis = 0; axis < 6; ++axis) {
      if (!has(task.coordinates, axis) || start.sigma[axis] == 0.0) continue;
      const double z = random.normal();
      squares += z * z;
      offset[axis] = z * start.sigma[axis];
    }
    drawn.particle.pose = displaced(start.pose, offset);
    drawn.mahalanobis = std::sqrt(squares);
    if (drawn.mahalanobis > reach_sigmas(task)) continue;
    if (!rollout.in_collision(drawn.particle.pose)) break;
  }
  drawn.particle.physics.friction =
      task.friction.low + random.uniform() * (task.friction.high - task.friction.low);
  drawn.particle.physics.contact_stiffness_Npm = plan.contact_stiffness_Npm;
  if (task.oversize_m > 0.0) drawn.particle.physics.oversize_m = random.uniform() * task.oversize_m;
  return drawn;
}

/// Unit vectors along every uncertain coordinate both ways, and to every corner between them.
std::vector<Vector6> rim_directions(const Task& task, const Start& start) {
  std::vector<int> axes;
  for (int axis = 0; axis < 6; ++axis) {
    if (has(task.coordinates, axis) && start.sigma[axis] > 0.0) axes.push_back(axis);
  }
  std::vector<Vector6> directions;
  for (const int axis : axes) {
    directions.push_back(Vector6::Unit(axis));
    directions.push_back(-Vector6::Unit(axis));
  }
  if (axes.size() < 2) return directions;
  for (unsigned corner = 0; corner < 1U << axes.size(); ++corner) {
    Vector6 direction = Vector6::Zero();
    for (std::size_t i = 0; i < axes.size(); ++i) {
      direction[axes[i]] = (corner >> i & 1U) != 0 ? 1.0 : -1.0;
    }
    directions.push_back(direction.normalized());
  }
  return directions;
}

std::vector<DrawnStart> rim_starts(const Plan& plan, const Task& task, const Start& start,
                                   Rollout& rollout) {
  std::vector<DrawnStart> starts;
  for (const Vector6& direction : rim_directions(task, start)) {
    const Pose pose =
        displaced(start.pose, reach_sigmas(task) * direction.cwiseProduct(start.sigma));
    if (rollout.in_collision(pose)) continue;
    for (const double friction : {task.friction.low, task.friction.high}) {
      starts.push_back({{pose, {}, {friction, plan.contact_stiffness_Npm, task.oversize_m}},
                        reach_sigmas(task)});
    }
  }
  return starts;
}

std::vector<Draw> run_all(const Plan& plan, const Task& task, std::span<const DrawnStart> starts,
                          RolloutPool& pool) {
  std::vector<Draw> draws(starts.size());
  pool.run(starts.size(), [&](Rollout& rollout, std::size_t i) {
    Draw& draw = draws[i];
    draw.mahalanobis = starts[i].mahalanobis;
    draw.chain = run_chain(rollout, plan, starts[i].particle, task.rollout_step_us);
    draw.at_goal = draw.chain.done && inserted(task, draw.chain.end()) &&
                   distance(draw.chain.end(), task.goal, metric_of(task)) <= task.goal_tolerance_m;
  });
  return draws;
}

}  // namespace

std::size_t Validation::at_goal() const {
  return static_cast<std::size_t>(
      std::count_if(draws.begin(), draws.end(), [](const Draw& d) { return d.at_goal; }));
}

std::size_t Validation::within(double sigmas) const {
  return static_cast<std::size_t>(std::count_if(
      draws.begin(), draws.end(), [&](const Draw& d) { return d.mahalanobis <= sigmas; }));
}

std::size_t Validation::at_goal_within(double sigmas) const {
  return static_cast<std::size_t>(std::count_if(draws.begin(), draws.end(), [&](const Draw& d) {
    return d.at_goal && d.mahalanobis <= sigmas;
  }));
}

std::vector<Chain> Validation::good_chains() const {
  std::vector<Chain> chains;
  for (const std::vector<Draw>* group : {&draws, &rim}) {
    for (const Draw& draw : *group) {
      if (draw.at_goal) chains.push_back(draw.chain);
    }
  }
  return chains;
}

std::size_t Validation::moves() const {
  std::size_t count = 0;
  for (const std::vector<Draw>* group : {&draws, &rim}) {
    for (const Draw& draw : *group) count += draw.chain.steps.size();
  }
  return count;
}

Validation validate(const Plan& plan, const Task& task, const Start& start,
                    const ValidationParameters& parameters, RolloutPool& pool) {
  Random random(parameters.seed);
  std::vector<DrawnStart> starts;
  for (std::size_t i = 0; i < parameters.draws; ++i) {
    starts.push_back(draw_start(random, plan, task, start, pool.front()));
  }
  Validation validation;
  for (std::size_t first = 0; first < starts.size(); first += kBatch) {
    const auto batch = std::span(starts).subspan(first, std::min(kBatch, starts.size() - first));
    const std::vector<Draw> draws = run_all(plan, task, batch, pool);
    validation.draws.insert(validation.draws.end(), draws.begin(), draws.end());
    const bool refuted = std::any_of(draws.begin(), draws.end(), [&](const Draw& draw) {
      return !draw.at_goal && draw.mahalanobis <= task.particle_sigmas;
    });
    if (refuted && parameters.stop_when_refuted) return validation;
  }
  validation.rim = run_all(plan, task, rim_starts(plan, task, start, pool.front()), pool);
  return validation;
}

}  // namespace tenon::planner

#include "planner/validation.h"

#include <algorithm>
#include <cmath>

#include "planner/belief.h"
#include "planner/normal_draws.h"

namespace tenon::planner {
namespace {

// A start whose every draw collides is no start; the planner has refused it before.
constexpr int kAttempts = 1000;

struct DrawnStart {
  Particle particle;
  double mahalanobis = 0.0;
};

DrawnStart draw_start(NormalDraws& random, const Plan& plan, const Task& task, const Start& start,
                      Rollout& rollout) {
  DrawnStart drawn;
  for (int attempt = 0; attempt < kAttempts; ++attempt) {
    Vector6 offset = Vector6::Zero();
    double squares = 0.0;
    for (int axis = 0; axis < 6; ++axis) {
      if ((task.coordinates >> axis & 1U) == 0 || start.sigma[axis] == 0.0) continue;
      const double z = random.normal();
      squares += z * z;
      offset[axis] = z * start.sigma[axis];
    }
    drawn.particle.pose = displaced(start.pose, offset);
    drawn.mahalanobis = std::sqrt(squares);
    if (drawn.mahalanobis > task.particle_sigmas + 1.0) continue;
    if (!rollout.in_collision(drawn.particle.pose)) break;
  }
  drawn.particle.physics.friction =
      task.friction.low + random.uniform() * (task.friction.high - task.friction.low);
  drawn.particle.physics.contact_stiffness_Npm = plan.contact_stiffness_Npm;
  return drawn;
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

Validation validate(const Plan& plan, const Task& task, const Start& start,
                    const ValidationParameters& parameters, RolloutPool& pool) {
  NormalDraws random(parameters.seed);
  std::vector<DrawnStart> starts;
  for (std::size_t i = 0; i < parameters.draws; ++i) {
    starts.push_back(draw_start(random, plan, task, start, pool.front()));
  }
  Validation validation;
  validation.draws.resize(starts.size());
  pool.run(starts.size(), [&](Rollout& rollout, std::size_t i) {
    Draw& draw = validation.draws[i];
    draw.mahalanobis = starts[i].mahalanobis;
    draw.chain = run_chain(rollout, plan, starts[i].particle, task.rollout_step_us);
    draw.at_goal = draw.chain.done &&
                   distance(draw.chain.end(), task.goal, metric_of(task)) <= task.goal_tolerance_m;
  });
  return validation;
}

}  // namespace tenon::planner

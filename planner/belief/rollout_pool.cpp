#include "planner/belief/rollout_pool.h"

#include <algorithm>

#include "shared/system/fan_out.h"

namespace tenon::planner {

RolloutPool::RolloutPool(const Rollout& prototype, std::size_t threads) {
  for (std::size_t i = 0; i < std::max<std::size_t>(threads, 1); ++i) {
    rollouts_.push_back(prototype.clone());
  }
}

void RolloutPool::run(std::size_t jobs, const std::function<void(Rollout&, std::size_t)>& job) {
  fan_out(jobs, rollouts_.size(),
          [&](std::size_t i, std::size_t worker) { job(*rollouts_[worker], i); });
}

}  // namespace tenon::planner

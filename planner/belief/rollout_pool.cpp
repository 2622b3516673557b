#include "planner/belief/rollout_pool.h"

#include <algorithm>
#include <atomic>
#include <exception>
#include <thread>

namespace tenon::planner {

RolloutPool::RolloutPool(const Rollout& prototype, std::size_t threads) {
  for (std::size_t i = 0; i < std::max<std::size_t>(threads, 1); ++i) {
    rollouts_.push_back(prototype.clone());
  }
}

void RolloutPool::run(std::size_t jobs, const std::function<void(Rollout&, std::size_t)>& job) {
  std::atomic<std::size_t> next{0};
  std::vector<std::exception_ptr> errors(jobs);
  const auto work = [&](Rollout& rollout) {
    for (std::size_t i = next++; i < jobs; i = next++) {
      try {
        job(rollout, i);
      } catch (...) {
        errors[i] = std::current_exception();
      }
    }
  };
  {
    std::vector<std::jthread> helpers;
    for (std::size_t i = 1; i < std::min(rollouts_.size(), jobs); ++i) {
      helpers.emplace_back(work, std::ref(*rollouts_[i]));
    }
    work(*rollouts_.front());
  }
  for (const std::exception_ptr& error : errors) {
    if (error) std::rethrow_exception(error);
  }
}

}  // namespace tenon::planner

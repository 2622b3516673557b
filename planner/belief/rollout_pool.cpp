#include "planner/belief/rollout_pool.h"

#include <algorithm>
#include <cstdint>
#include <utility>
#include <vector>

#include "shared/system/fan_out.h"

namespace tenon::planner {
namespace {

/// Another rollout, and who is told of its moves.
class ToldRollout final : public Rollout {
 public:
  ToldRollout(std::unique_ptr<Rollout> rollout, std::function<void()> told)
      : rollout_(std::move(rollout)), told_(std::move(told)) {}

  [[nodiscard]] RolloutResult simulate(const Particle& particle, const MoveParameters& move,
                                       std::int64_t step_us,
                                       std::vector<TraceSample>* trace) override {
    RolloutResult result = rollout_->simulate(particle, move, step_us, trace);
    told_();
    return result;
  }
  [[nodiscard]] bool in_collision(const Pose& tool_pose) override {
    return rollout_->in_collision(tool_pose);
  }
  [[nodiscard]] std::unique_ptr<Rollout> clone() const override { return rollout_->clone(); }

 private:
  std::unique_ptr<Rollout> rollout_;
  std::function<void()> told_;
};

}  // namespace

RolloutPool::RolloutPool(const Rollout& prototype, std::size_t threads) {
  for (std::size_t i = 0; i < std::max<std::size_t>(threads, 1); ++i) {
    rollouts_.push_back(prototype.clone());
  }
}

void RolloutPool::after_each_move(std::function<void()> told) {
  rollouts_.front() = std::make_unique<ToldRollout>(std::move(rollouts_.front()), std::move(told));
}

void RolloutPool::run(std::size_t jobs, const std::function<void(Rollout&, std::size_t)>& job) {
  fan_out(jobs, rollouts_.size(),
          [&](std::size_t i, std::size_t worker) { job(*rollouts_[worker], i); });
}

}  // namespace tenon::planner

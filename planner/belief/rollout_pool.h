#pragma once
// A fixed number of rollouts for as many threads. Jobs write into slots of their own, so results do
// not depend on how many threads there are.

#include <cstddef>
#include <functional>
#include <memory>
#include <vector>

#include "shared/ports/rollout.h"

namespace tenon::planner {

/// Used by one thread at a time; run() starts the others and joins them.
class RolloutPool {
 public:
  /// @param prototype cloned `threads` times (at least once)
  RolloutPool(const Rollout& prototype, std::size_t threads);

  /// Calls job(rollout, i) once for each i < jobs (shared/system/fan_out.h). An exception in a job
  /// is thrown here, that of the lowest i where there are several.
  void run(std::size_t jobs, const std::function<void(Rollout&, std::size_t)>& job);

  /// @param told called after every move that is simulated on the caller's thread, and only there
  void after_each_move(std::function<void()> told);

  /// For questions outside of run().
  [[nodiscard]] Rollout& front() { return *rollouts_.front(); }

 private:
  std::vector<std::unique_ptr<Rollout>> rollouts_;
};

}  // namespace tenon::planner

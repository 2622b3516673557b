#pragma once
// Runs on several threads. What a run gives must depend on its job alone; then nothing depends on
// the number of threads.

#include <cstddef>
#include <functional>
#include <vector>

#include "sim/evaluation/trial.h"

namespace tenon::sim {

struct Job {
  std::size_t plan = 0;  ///< of the plans that are compared
  std::size_t number = 0;
};

/// The jobs of a shard, number by number, all plans of a number together.
/// @param shard 0 .. shards - 1, of the numbers that leave this remainder
[[nodiscard]] std::vector<Job> jobs_of(std::size_t plans, std::size_t count, std::size_t shard,
                                       std::size_t shards);

/// Starts the jobs in their order, each on the next free thread. `run` is called on any thread and
/// makes what it needs there; `ended` is called by one thread at a time, in the order in which runs
/// end. Rethrows what either threw, after the runs in flight (shared/system/fan_out.h).
void run_all(const std::vector<Job>& jobs, std::size_t threads,
             const std::function<Run(const Job&)>& run,
             const std::function<void(const Job&, Run)>& ended);

}  // namespace tenon::sim

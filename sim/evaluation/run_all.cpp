#include "sim/evaluation/run_all.h"

#include <mutex>
#include <utility>

#include "shared/system/fan_out.h"

namespace tenon::sim {

std::vector<Job> jobs_of(std::size_t plans, std::size_t count, std::size_t shard,
                         std::size_t shards) {
  std::vector<Job> jobs;
  for (std::size_t number = shard; number < count; number += shards) {
    for (std::size_t plan = 0; plan < plans; ++plan) jobs.push_back({plan, number});
  }
  return jobs;
}

void run_all(const std::vector<Job>& jobs, std::size_t threads,
             const std::function<Run(const Job&)>& run,
             const std::function<void(const Job&, Run)>& ended) {
  std::mutex mutex;
  fan_out(jobs.size(), threads, [&](std::size_t i, std::size_t /*worker*/) {
    Run result = run(jobs[i]);
    const std::lock_guard lock(mutex);
    ended(jobs[i], std::move(result));
  });
}

}  // namespace tenon::sim

#include "sim/evaluation/run_all.h"

#include <algorithm>
#include <atomic>
#include <exception>
#include <mutex>
#include <thread>
#include <utility>

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
  std::atomic<std::size_t> next{0};
  std::mutex mutex;
  std::exception_ptr error;
  const auto work = [&] {
    try {
      for (std::size_t i = next++; i < jobs.size(); i = next++) {
        Run result = run(jobs[i]);
        const std::lock_guard lock(mutex);
        ended(jobs[i], std::move(result));
      }
    } catch (...) {
      const std::lock_guard lock(mutex);
      if (!error) error = std::current_exception();
      next = jobs.size();
    }
  };
  {
    std::vector<std::jthread> helpers;
    for (std::size_t i = 1; i < std::min(threads, jobs.size()); ++i) helpers.emplace_back(work);
    work();
  }
  if (error) std::rethrow_exception(error);
}

}  // namespace tenon::sim

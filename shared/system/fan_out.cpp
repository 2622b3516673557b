#include "shared/system/fan_out.h"

#include <algorithm>
#include <atomic>
#include <exception>
#include <mutex>
#include <thread>
#include <vector>

namespace tenon {

std::size_t all_cores() { return std::max(1U, std::thread::hardware_concurrency()); }

void fan_out(std::size_t jobs, std::size_t threads,
             const std::function<void(std::size_t i, std::size_t worker)>& job) {
  std::atomic<std::size_t> next{0};
  std::mutex mutex;
  std::exception_ptr error;
  std::size_t thrown_by = jobs;
  const auto work = [&](std::size_t worker) {
    for (std::size_t i = next++; i < jobs; i = next++) {
      try {
        job(i, worker);
      } catch (...) {
        const std::lock_guard lock(mutex);
        next = jobs;
        // All lower ones have begun, so the lowest that throws is among those that end.
        if (i < thrown_by) {
          thrown_by = i;
          error = std::current_exception();
        }
      }
    }
  };
  {
    std::vector<std::jthread> helpers;
    for (std::size_t worker = 1; worker < std::min(threads, jobs); ++worker) {
      helpers.emplace_back(work, worker);
    }
    work(0);
  }
  if (error) std::rethrow_exception(error);
}

}  // namespace tenon

// Jobs on several threads: each once, in their order on one thread, and what they throw.

#include "shared/system/fan_out.h"

#include <gtest/gtest.h>

#include <atomic>
#include <numeric>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

namespace tenon {
namespace {

constexpr std::size_t kThreadCounts[] = {0, 1, 2, 3, 8};

TEST(FanOut, EveryIndexIsCalledOnceAtAnyNumberOfThreads) {
  for (const std::size_t threads : kThreadCounts) {
    for (const std::size_t jobs : {0U, 1U, 2U, 7U, 1000U}) {
      std::vector<int> calls(jobs, 0);  // a slot a job: nothing is shared
      fan_out(jobs, threads, [&](std::size_t i, std::size_t /*worker*/) { ++calls.at(i); });
      EXPECT_EQ(calls, std::vector<int>(jobs, 1)) << jobs << " jobs on " << threads;
    }
  }
}

TEST(FanOut, OneThreadIsTheCallersAndGoesInOrder) {
  const auto caller = std::this_thread::get_id();
  std::vector<std::size_t> order;
  fan_out(100, 1, [&](std::size_t i, std::size_t worker) {
    EXPECT_EQ(std::this_thread::get_id(), caller);
    EXPECT_EQ(worker, 0U);
    order.push_back(i);
  });
  std::vector<std::size_t> expected(100);
  std::iota(expected.begin(), expected.end(), std::size_t{0});
  EXPECT_EQ(order, expected);
}

TEST(FanOut, AWorkerIsOneThreadAtATimeAndThereAreNoMoreThanAskedFor) {
  constexpr std::size_t kWorkers = 3;
  std::vector<std::atomic<int>> busy(kWorkers);
  fan_out(1000, kWorkers, [&](std::size_t /*i*/, std::size_t worker) {
    EXPECT_EQ(busy.at(worker)++, 0);
    std::this_thread::yield();
    --busy.at(worker);
  });
}

TEST(FanOut, AFewJobsDoNotStartMoreThreadsThanThereAreJobs) {
  fan_out(2, 8, [](std::size_t /*i*/, std::size_t worker) { EXPECT_LT(worker, 2U); });
}

TEST(FanOut, AllJobsMayRunAtOnce) {
  // Two that wait for each other end only where neither waits for the other to have ended.
  std::atomic<int> there{0};
  fan_out(2, 2, [&](std::size_t /*i*/, std::size_t /*worker*/) {
    ++there;
    while (there < 2) std::this_thread::yield();
  });
  EXPECT_EQ(there, 2);
}

/// What comes out where the jobs from `first` on throw, each its own number.
std::string thrown(std::size_t threads, std::size_t first, std::vector<int>& calls) {
  try {
    fan_out(calls.size(), threads, [&](std::size_t i, std::size_t /*worker*/) {
      ++calls.at(i);
      if (i >= first) throw std::runtime_error(std::to_string(i));
    });
  } catch (const std::runtime_error& error) {
    return error.what();
  }
  return "nothing";
}

TEST(FanOut, TheExceptionOfTheLowestIndexTravelsAndNoFurtherJobBegins) {
  for (const std::size_t threads : kThreadCounts) {
    for (int repetition = 0; repetition < 50; ++repetition) {
      std::vector<int> calls(2000, 0);
      EXPECT_EQ(thrown(threads, 40, calls), "40") << threads << " threads";
      for (std::size_t i = 0; i <= 40; ++i) EXPECT_EQ(calls[i], 1) << i;
      // Each thread was in one job at most when the first threw.
      EXPECT_LE(std::accumulate(calls.begin(), calls.end(), 0), 41 + 8);
    }
  }
}

TEST(FanOut, AnExceptionOfTheOnlyJobTravels) {
  std::vector<int> calls(1, 0);
  EXPECT_EQ(thrown(4, 0, calls), "0");
}

}  // namespace
}  // namespace tenon

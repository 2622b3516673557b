// Every start of the task, planned once and executed on many draws of the table's place.

#include <gtest/gtest.h>

#include <array>
#include <atomic>
#include <cmath>
#include <cstdio>
#include <string>
#include <thread>
#include <vector>

#include "tests/chain/planned.h"
#include "tests/support/lockstep.h"

namespace tenon::tests {
namespace {

constexpr std::size_t kDraws = 50;
constexpr double kInside_sigmas = 2.0;

struct Execution {
  std::string start;
  std::uint64_t seed = 0;
  double distance = 0.0;
  bool at_goal = false;
  bool done = false;
  double error_m = 0.0;
  std::string reason;
};

void execute(Execution& run) {
  Lockstep::Options options;
  options.start = run.start;
  options.seed = run.seed;
  options.offset = draw_offset(box_task(), box_start(run.start), run.seed, run.distance);
  const auto result = Lockstep(gantry_cell(), box_task(), box_plan(run.start), options).run();
  run.done = result.ending.reason == executor::EndReason::kPlanDone;
  run.at_goal = run.done && result.truth.within_tolerance;
  run.error_m = result.truth.error_norm_m;
  run.reason = result.reason;
}

struct Count {
  int runs = 0;
  int at_goal = 0;
  int done_but_wrong = 0;
  int stopped = 0;
  void add(const Execution& run) {
    ++runs;
    at_goal += run.at_goal;
    done_but_wrong += run.done && !run.at_goal;
    stopped += !run.done;
  }
};

std::vector<Execution> execute_all() {
  std::vector<Execution> runs;
  for (const Start& start : box_task().starts) {
    (void)box_plan(start.name);  // made here, on one thread
    const auto base = static_cast<std::uint64_t>(1000 * std::stoi(start.name));
    for (std::uint64_t i = 0; i < kDraws; ++i) {
      Execution run;
      run.start = start.name;
      run.seed = base + i;
      runs.push_back(run);
    }
  }
  std::atomic<std::size_t> next = 0;
  std::array<std::thread, 2> threads;
  for (std::thread& thread : threads) {
    thread = std::thread([&] {
      for (std::size_t i = next++; i < runs.size(); i = next++) execute(runs[i]);
    });
  }
  for (std::thread& thread : threads) thread.join();
  return runs;
}

TEST(Draws, NearlyAllWithinTwoSigmasEndAtTheGoalAndTheRestSayWhy) {
  const std::vector<Execution> runs = execute_all();
  Count inside;
  Count outside;
  double sum_m = 0.0;
  double squares_m2 = 0.0;
  int done = 0;
  for (const Execution& run : runs) {
    (run.distance <= kInside_sigmas ? inside : outside).add(run);
    if (run.done) {
      ++done;
      sum_m += run.error_m;
      squares_m2 += run.error_m * run.error_m;
    }
    if (run.at_goal) continue;
    EXPECT_FALSE(run.reason.empty());
    std::printf("start %s seed %llu at %.2f sigma: %s, error %.2f mm\n", run.start.c_str(),
                static_cast<unsigned long long>(run.seed), run.distance, run.reason.c_str(),
                1e3 * run.error_m);
  }
  const double mean_m = sum_m / done;
  const auto print = [](const char* where, const Count& count) {
    std::printf(
        "%s %g sigma: %d runs, %d at the goal, %d stopped with a reason, %d done but wrong\n",
        where, kInside_sigmas, count.runs, count.at_goal, count.stopped, count.done_but_wrong);
  };
  print("within", inside);
  print("beyond", outside);
  std::printf("error of the runs that were done: mean %.3f mm, standard deviation %.3f mm\n",
              1e3 * mean_m, 1e3 * std::sqrt(squares_m2 / done - mean_m * mean_m));
  EXPECT_GE(inside.at_goal, 0.99 * inside.runs);
  EXPECT_EQ(inside.done_but_wrong + outside.done_but_wrong, 0);
}

}  // namespace
}  // namespace tenon::tests

// Starts of the task, planned once and executed on many draws of the table's place: a few in every
// run of the tests, all of them (label full) where a release needs it.

#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <map>
#include <stdexcept>
#include <string>
#include <vector>

#include "planner/cell_fit/cell_fit.h"
#include "planner/planner.h"
#include "shared/system/fan_out.h"
#include "sim/physics/rollout/ode_rollout.h"
#include "tests/support/planned.h"
#include "tests/support/whole_run.h"

namespace tenon::tests {
namespace {

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

using Plans = std::map<std::string, Plan>;  // by start

// As `tenon-plan --cell` makes it.
Plan plan_of(const Start& start) {
  const planner::CellFit fit = planner::fit_to_cell(box_task(), gantry_cell());
  planner::PlannerOptions options;
  options.threads = 2;
  options.assumptions = fit.assumptions;
  const sim::OdeRollout rollout(fit.task);
  const auto report = planner::make_plan(fit.task, start, rollout, options, [] { return 0.0; });
  if (!report.plan) throw std::runtime_error("start " + start.name + ": " + report.reason);
  return *report.plan;
}

void execute(Execution& run, const Plan& plan) {
  WholeRun::Options options;
  options.start = run.start;
  options.seed = run.seed;
  options.offset = draw_offset(box_task(), box_start(run.start), run.seed, run.distance);
  const auto result = WholeRun(gantry_cell(), box_task(), plan, options).run();
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

std::vector<Execution> execute_all(const Plans& plans, std::size_t draws) {
  std::vector<Execution> runs;
  for (const auto& [start, plan] : plans) {
    const auto base = static_cast<std::uint64_t>(1000 * std::stoi(start));
    for (std::uint64_t i = 0; i < draws; ++i) {
      Execution run;
      run.start = start;
      run.seed = base + i;
      runs.push_back(run);
    }
  }
  fan_out(runs.size(), 2, [&](std::size_t i, std::size_t /*worker*/) {
    execute(runs[i], plans.at(runs[i].start));
  });
  return runs;
}

void expect_nearly_all_at_the_goal(const std::vector<Execution>& runs) {
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

TEST(Draws, NearlyAllWithinTwoSigmasEndAtTheGoalAndTheRestSayWhy) {
  Plans plans;
  for (const Start& start : box_task().starts) plans.emplace(start.name, plan_of(start));
  expect_nearly_all_at_the_goal(execute_all(plans, 50));
}

TEST(FewDraws, OfTwoStartsNearlyAllWithinTwoSigmasEndAtTheGoalAndTheRestSayWhy) {
  const Plans plans = {{"1", box_plan("1")}, {"4", box_plan("4")}};
  expect_nearly_all_at_the_goal(execute_all(plans, 15));
}

}  // namespace
}  // namespace tenon::tests

// The result of a run of arbitrary text (tenon-exec --json), as tenon-inspect reads it back, lays
// it beside a log and puts it on the run's page.

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <string>

#include "executor/recorded/result_file.h"
#include "planner/report/run_data.h"
#include "shared/plan/plan.h"
#include "tests/fuzz/support/made_plan.h"
#include "tests/fuzz/support/refused.h"

namespace {

using namespace tenon;
using fuzz::made_plan;
using fuzz::must;

void check(const RecordedRun& run, const Plan& plan) {
  must(run.ended && std::isfinite(run.duration_s) && run.peak_force_N.has_value(),
       "a result tells of the end");
  for (const std::string& text : {run.cell, run.robot, run.message}) {
    must(fuzz::obeys_nothing(text), "names are lines");
  }
  for (const std::string& note : run.notes) must(fuzz::obeys_nothing(note), "a note is a line");
  for (const RecordedFault& fault : run.faults) {
    must(fuzz::obeys_nothing(fault.text), "a fault is a line");
  }
  for (const RecordedStep& step : run.steps) {
    must(step.step < plan.steps.size(), "a step is one of the plan's");
    must(fuzz::obeys_nothing(step.signature + step.deviation), "what it came to is a line");
    must(step.travelled.allFinite() && step.tool.position_m.allFinite() &&
             std::isfinite(step.duration_s) && std::isfinite(step.peak_force_N),
         "a step is made of numbers");
    must(std::abs(step.tool.orientation.norm() - 1.0) < 1e-9, "an orientation is a unit one");
  }
}

}  // namespace

// NOLINTNEXTLINE(readability-identifier-naming): libFuzzer's name
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const Plan plan = made_plan();
  const std::string text(fuzz::text_of(data, size));
  RecordedRun run;
  const auto read = [&] { run = executor::read_run_result("result.json", text, plan); };
  if (!fuzz::accepted(read)) return 0;
  check(run, plan);
  must(fuzz::accepted([&] { (void)executor::joined(run, run, "run.lcmlog", "result.json"); }),
       "a run is the same as itself");
  must(planner::run_json(plan, run, nullptr).size() > 2, "a run has a page");
  return 0;
}

// The log of a run of arbitrary bytes (run.lcmlog), as tenon-inspect reads it back and puts it on
// the run's page, and as tenon-monitor exports it. The monitor alone reads it behind where it is
// damaged.

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <string>

#include "executor/export/export_log.h"
#include "executor/recorded/run_log.h"
#include "planner/report/run_data.h"
#include "shared/plan/plan.h"
#include "tests/fuzz/support/made_plan.h"
#include "tests/fuzz/support/refused.h"

namespace {

using namespace tenon;
using fuzz::made_plan;
using fuzz::must;

void check(const RecordedRun& run, const Plan& plan) {
  must(!run.samples.empty() && run.cycles == run.samples.size(), "a log holds cycles");
  double before_s = -1.0;
  for (const RecordedCycle& cycle : run.samples) {
    must(std::isfinite(cycle.time_s) && cycle.time_s > before_s, "time goes on");
    must(cycle.step < static_cast<int>(plan.steps.size()), "a step is one of the plan's");
    before_s = cycle.time_s;
  }
  for (const RecordedStep& step : run.steps) {
    must(step.step < plan.steps.size(), "a step is one of the plan's");
    must(step.travelled.allFinite() && step.tool.position_m.allFinite(),
         "a step is made of numbers");
    must(std::abs(step.tool.orientation.norm() - 1.0) < 1e-9, "an orientation is a unit one");
    must(fuzz::obeys_nothing(step.signature + step.deviation), "what it came to is a line");
  }
  for (const std::string& text : {run.cell, run.robot, run.message}) {
    must(fuzz::obeys_nothing(text), "names are lines");
  }
  for (const RecordedJoint& joint : run.joints) {
    must(fuzz::obeys_nothing(joint.name), "a joint's name is a line");
  }
  for (const RecordedFault& fault : run.faults) {
    must(fuzz::obeys_nothing(fault.text), "a fault is a line");
  }
  for (const std::string& note : run.notes) must(fuzz::obeys_nothing(note), "a note is a line");
}

void check(const executor::Exported& exported) {
  must(exported.written.size() == 2, "both files are written");
  for (const auto* lines : {&exported.written, &exported.missing, &exported.notes}) {
    for (const std::string& line : *lines) {
      must(fuzz::obeys_nothing(line), "what is said of an export is a line");
    }
  }
}

}  // namespace

// NOLINTNEXTLINE(readability-identifier-naming): libFuzzer's name
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const fuzz::InputFolder folder;
  static const Plan plan = made_plan();
  const auto file = folder.put("run.lcmlog", fuzz::text_of(data, size));
  RecordedRun run;
  if (fuzz::accepted([&] { run = executor::read_run_log(file, plan); })) {
    check(run, plan);
    must(planner::run_json(plan, run, nullptr).size() > 2, "a run has a page");
  }
  executor::ExportRequest request;
  request.log = file;
  request.csv = file.parent_path() / "run.csv";
  request.mcap = file.parent_path() / "run.mcap";
  request.version = "0";
  executor::Exported exported;
  if (fuzz::accepted([&] { exported = executor::export_log(request); })) check(exported);
  return 0;
}

// tenon-exec: runs a plan on an arm over CAN. Only composes; see executor/README.md.

#include <csignal>
#include <cstdio>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "executor/dry_run/dry_run.h"
#include "executor/dry_run/plan_check.h"
#include "executor/identification/identification.h"
#include "executor/loop/controller.h"
#include "executor/loop/stop_requests.h"
#include "executor/main_exec_options.h"
#include "executor/main_exec_output.h"
#include "executor/main_exec_run.h"
#include "executor/main_exec_steps.h"
#include "executor/telemetry/run_result.h"
#include "hw/bus_load/bus_load.h"
#include "hw/bus_load/response_times.h"
#include "hw/can/open_bus.h"
#include "shared/base/error.h"
#include "shared/config/command_line.h"
#include "shared/config/load.h"
#include "shared/config/signals.h"

namespace tenon::executor {
namespace {

StopRequests stop_asked;

void obey_signals() {
  stop_on_signals(stop_asked.by_user, stop_asked.by_circumstance);
  never_be_suspended();
}

int run_plan(const Options& options, const Cell& cell, const DryRun& dry_run) {
  Controller::Parameters parameters;
  parameters.go_to_start = options.go_to_start;
  parameters.step_by_step = options.step;
  Controller controller(cell, dry_run, parameters);
  TaskRun run(options, controller, &controller.runner(), stop_asked);
  StepPrinter printer(controller.runner());
  run.add(printer);
  std::optional<UserWords> words;
  if (options.step || options.keys) words.emplace(controller, stop_asked, options.step);
  run.run();
  return run.conclude(
      gather_result(controller, run.runner(), run.records_dropped(), run.arm_fault_text()));
}

int identify(const Options& options, const Cell& cell) {
  const bool friction = !options.identify_friction.empty();
  if (options.identify_payload && cell.joint_torque) {
    throw InputError("cell '" + cell.name +
                     "': --identify-payload needs a force/torque sensor; weigh the payload");
  }
  const std::unique_ptr<Identification> identification =
      friction                   ? make_friction_identification(cell)
      : options.identify_payload ? make_payload_identification(cell)
                                 : make_contact_identification(cell, options.identify_contact);
  const ControlTask& task = identification->motion();
  print_identification(friction                   ? "friction"
                       : options.identify_payload ? "payload"
                                                  : "contact",
                       cell);
  TaskRun run(options, identification->motion(), nullptr, stop_asked);
  run.run();
  std::optional<Finding> finding;
  if (task.ending().reason == EndReason::kMeasured) finding = identification->finding();
  // Its first line is the result's message.
  if (finding) std::fputs(finding->report.substr(finding->report.find('\n') + 1).c_str(), stdout);
  RunResult result =
      gather_result(task, finding, run.runner(), run.records_dropped(), run.arm_fault_text());
  if (finding && !finding->file.empty()) {
    result.records.push_back(
        write_whole("identify_friction", options.identify_friction, finding->file));
  }
  return run.conclude(std::move(result));
}

int execute(const Options& options) {
  check_outputs(options);
  Cell cell = load_cell(options.cell);
  if (!options.can.empty()) hw::settle_buses(hw::parse_bus_uris(options.can), cell.robot);
  if (options.plan.empty() && !options.identifies()) {
    throw InputError("--plan is required; see --help");
  }
  const Plan plan = options.identifies() ? Plan{} : load_plan(options.plan);
  hw::check_bus_load(cell.robot);
  hw::check_response_times(cell.robot);
  if (options.identifies()) {
    obey_signals();
    return identify(options, cell);
  }
  DryRun run = dry_run(plan, cell);
  const std::vector<std::string> others = check_plan(plan, cell);
  run.refusals.insert(run.refusals.begin(), others.begin(), others.end());
  if (options.dry_run) report_dry_run(options.json, run, plan, cell);
  if (!run.refusals.empty()) {
    throw InputError(options.plan + ": cell '" + cell.name +
                     "' cannot execute this plan: " + run.refusals.front());
  }
  if (options.dry_run) return 0;
  obey_signals();
  print_opening(plan, cell, run);
  return run_plan(options, cell, run);
}

int parse_and_execute(int argc, char** argv) {
  const Options options = parse_options(argc, argv);
  std::signal(SIGPIPE, SIG_IGN);
  return execute(options);
}

}  // namespace
}  // namespace tenon::executor

int main(int argc, char** argv) {
  return tenon::run_main("tenon-exec",
                         [&] { return tenon::executor::parse_and_execute(argc, argv); });
}

#include "executor/main_exec_output.h"

#include <cstdio>
#include <exception>

#include "executor/dry_run/dry_run_report.h"
#include "executor/sensing/unnoticed.h"
#include "hw/bus_load/bus_load.h"
#include "hw/robot_arm/open_arm.h"
#include "shared/base/text.h"
#include "shared/config/load.h"

namespace tenon::executor {

void StepPrinter::consume(const CycleRecord& record) {
  for (; printed_ < record.steps_done; ++printed_) {
    std::printf("%s\n", step_line(runner_.report(printed_)).c_str());
    std::fflush(stdout);
  }
  if (record.awaited_step == awaited_) return;
  awaited_ = record.awaited_step;
  if (awaited_ < 0) return;
  std::printf("%s\n", waiting_line(record, runner_.plan()).c_str());
  std::fflush(stdout);
}

void HoldPrinter::consume(const CycleRecord& record) {
  if (record.stops_unheeded != unheeded_) {
    unheeded_ = record.stops_unheeded;
    std::fputs("tenon-exec: the arm goes on being held; Ctrl-C or SIGTERM alone lets it go\n",
               stderr);
  }
  if (record.hold == printed_) return;
  printed_ = record.hold;
  const std::string line = hold_line(record, cell_, hw::fault_text(record.arm_fault, cell_.robot));
  std::fprintf(stderr, "tenon-exec: %s\n", line.c_str());
}

void print_opening(const Plan& plan, const Cell& cell, const DryRun& dry_run) {
  std::string loads;
  for (const std::uint8_t bus : hw::buses_of(cell.robot)) {
    loads += ", " + hw::bus_title(cell.robot, bus) +
             format(" load at most %.0f %%", 100.0 * hw::bus_load(cell.robot, bus).worst);
  }
  std::printf("plan '%s', start '%s', %d step%s; cell '%s', robot '%s'\n", plan.task_name.c_str(),
              plan.start_name.c_str(), static_cast<int>(plan.steps.size()),
              plural(plan.steps.size()), cell.name.c_str(), cell.robot.name.c_str());
  std::printf("cycle %g ms, latency %g ms (plan allows %g ms)%s\n", 1e-3 * cell.robot.cycle_us,
              1e3 * latency_s(cell.robot), 1e3 * plan.latency_max_s, loads.c_str());
  std::printf("%s", slowed_steps(dry_run, cell).c_str());
  std::printf("%s", resolved_steps(dry_run, cell).c_str());
  std::printf("%s", unnoticed_while_taring(cell).c_str());
  std::fflush(stdout);
}

void print_identification(const char* what, const Cell& cell) {
  std::printf("identifying the %s; cell '%s', robot '%s', cycle %g ms\n", what, cell.name.c_str(),
              cell.robot.name.c_str(), 1e-3 * cell.robot.cycle_us);
  std::fflush(stdout);
}

void print_closing(const RunResult& result) {
  const CycleRunner::Statistics& s = result.statistics;
  std::printf("%s: %s\n", result.exit_code == 0 ? "done" : "failed", result.message.c_str());
  std::printf(
      "%llu cycles, %llu late, %llu with feedback missing; wake-up p50 %.0f p99 %.0f max %.0f us; "
      "compute p50 %.0f p99 %.0f max %.0f us; %llu records dropped\n",
      static_cast<unsigned long long>(s.cycles), static_cast<unsigned long long>(s.late_cycles),
      static_cast<unsigned long long>(s.incomplete_cycles), s.wakeup.percentile_us(0.5),
      s.wakeup.percentile_us(0.99), s.wakeup.max_us(), s.compute.percentile_us(0.5),
      s.compute.percentile_us(0.99), s.compute.max_us(),
      static_cast<unsigned long long>(result.records_dropped));
  if (result.exit_code != 0) std::fprintf(stderr, "tenon-exec: %s\n", result.message.c_str());
}

void print_losses(const RunResult& result) {
  const std::string losses = result.losses();
  if (!losses.empty()) std::fprintf(stderr, "tenon-exec: lost: %s\n", losses.c_str());
}

void write_json(const std::string& file, const std::string& json) {
  if (file == "-") {
    std::fputs(json.c_str(), stdout);
  } else if (!file.empty()) {
    write_file(file, json);
  }
}

RecordReport write_whole(const std::string& name, const std::string& file,
                         const std::string& text) {
  try {
    write_json(file, text);
  } catch (const std::exception& error) {
    return {name, file, 0, 1, error.what()};
  }
  return {name, file, 1, 0, ""};
}

void report_dry_run(const std::string& json_file, const DryRun& run, const Plan& plan,
                    const Cell& cell) {
  if (json_file != "-") {
    print_opening(plan, cell, run);
    std::fputs(to_table(run, cell).c_str(), stdout);
  }
  write_json(json_file, to_json(run, plan, cell));
  std::fflush(stdout);
}

}  // namespace tenon::executor

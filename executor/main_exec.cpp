// tenon-exec: runs a plan on an arm over CAN. Only composes; see executor/README.md.

#include <CLI/CLI.hpp>
#include <atomic>
#include <csignal>
#include <cstdio>
#include <memory>
#include <optional>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "executor/controller.h"
#include "executor/cycle_runner.h"
#include "executor/dry_run/dry_run.h"
#include "executor/dry_run/dry_run_report.h"
#include "executor/identification/identification.h"
#include "executor/monotonic_clock.h"
#include "executor/plan_check.h"
#include "executor/realtime.h"
#include "executor/telemetry/lcm_url.h"
#include "executor/telemetry/recorder.h"
#include "executor/telemetry/run_result.h"
#include "executor/telemetry/telemetry.h"
#include "executor/telemetry/trace.h"
#include "hw/bus_load.h"
#include "hw/can/candump_log.h"
#include "hw/can/open_bus.h"
#include "hw/can/recording_bus.h"
#include "hw/canopen_arm.h"
#include "hw/describe_fault.h"
#include "hw/frame_set.h"
#include "hw/response_times.h"
#include "shared/base/error.h"
#include "shared/config/command_line.h"
#include "shared/config/load.h"

namespace tenon::executor {
namespace {

std::atomic<bool> stop_asked{false};
static_assert(std::atomic<bool>::is_always_lock_free);

void ask_to_stop(int /*signal*/) { stop_asked.store(true, std::memory_order_relaxed); }

struct Options {
  std::string cell;
  std::string plan;
  std::string can;
  std::string rt = "prefer";
  int cpu = -1;
  bool go_to_start = false;
  bool dry_run = false;
  bool identify_payload = false;
  std::string identify_contact;  ///< direction
  std::string lcm_url = kDefaultLcmUrl;
  std::string log;
  std::string can_log;
  std::string trace;
  std::string json;
  std::string black_box = "tenon-black-box.csv";
};

// Prints a line for every finished step.
class StepPrinter : public RecordConsumer {
 public:
  explicit StepPrinter(const PlanRunner& runner) : runner_(runner) {}
  void consume(const CycleRecord& record) override {
    for (; printed_ < record.steps_done; ++printed_) {
      std::printf("%s\n", step_line(runner_.report(printed_)).c_str());
      std::fflush(stdout);
    }
  }

 private:
  const PlanRunner& runner_;
  std::size_t printed_ = 0;
};

// The frames that pass on the bus, written on the recorder's thread.
class CanLog : public RecordConsumer {
 public:
  explicit CanLog(const std::string& file) : log_(file) {}
  void consume(const CycleRecord& /*record*/) override { drain(); }
  void drain() { log_.drain(ring_); }
  [[nodiscard]] hw::CanRecordRing& ring() { return ring_; }

 private:
  hw::CanRecordRing ring_;
  hw::CandumpLog log_;
};

void ask_for_real_time(const Options& options) {
  if (options.rt == "off") return;
  RealtimeParameters parameters;
  parameters.cpu = options.cpu;
  const std::vector<std::string> missing = enter_realtime(parameters);
  if (options.rt == "require" && !missing.empty()) {
    std::string all = "--rt require";
    const char* separator = ": ";
    for (const std::string& line : missing) {
      all += separator + line;
      separator = "; ";
    }
    throw InputError(all);
  }
  for (const std::string& line : missing) std::fprintf(stderr, "real time: %s\n", line.c_str());
}

void print_opening(const Plan& plan, const Cell& cell, const DryRun& dry_run) {
  const hw::BusLoad load = hw::bus_load(cell.robot);
  std::printf("plan '%s', start '%s', %d steps; cell '%s', robot '%s'\n", plan.task_name.c_str(),
              plan.start_name.c_str(), static_cast<int>(plan.steps.size()), cell.name.c_str(),
              cell.robot.name.c_str());
  std::printf("cycle %g ms, latency %g ms (plan allows %g), bus load at most %.0f %%\n",
              1e-3 * cell.robot.cycle_us, 1e3 * latency_s(cell.robot), 1e3 * plan.latency_max_s,
              100.0 * load.worst);
  std::printf("%s", slowed_steps(dry_run, cell).c_str());
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

std::vector<std::pair<std::string, std::uint64_t>> named(const hw::CanopenArm::Counters& c) {
  return {{"joint_frames_missing", c.joint_frames_missing},
          {"wrenches_missing", c.wrenches_missing},
          {"wrench_halves_torn", c.wrench_halves_torn},
          {"late_frames", c.late_frames},
          {"malformed_frames", c.malformed_frames},
          {"unexpected_frames", c.unexpected_frames},
          {"emergencies", c.emergencies},
          {"send_failures", c.send_failures},
          {"invalid_setpoints", c.invalid_setpoints}};
}

// To a file, or to standard output for "-"; nowhere where no name is given.
void write_json(const std::string& file, const std::string& json) {
  if (file == "-") {
    std::fputs(json.c_str(), stdout);
  } else if (!file.empty()) {
    write_file(file, json);
  }
}

void report_dry_run(const Options& options, const DryRun& run, const Plan& plan, const Cell& cell) {
  if (options.json != "-") {
    print_opening(plan, cell, run);
    std::fputs(to_table(run, cell).c_str(), stdout);
  }
  write_json(options.json, to_json(run, plan, cell));
  std::fflush(stdout);
}

// What must hold before the bus is opened.
void check_outputs(const Options& options) {
  if (options.can.empty()) throw InputError("--can is required, but for --dry-run; see --help");
  if (options.can.rfind("slcan-listen:", 0) == 0) {
    throw InputError("--can " + options.can +
                     ": listens for an arm that would have to call; give slcan://HOST:PORT");
  }
  if (options.lcm_url != "none") check_lcm_url(options.lcm_url);
  check_writable(options.black_box);
}

// One task on the arm: bus, loop, and everything that writes along.
class TaskRun {
 public:
  /// @param steps of the plan that the task runs, null where it runs none
  TaskRun(const Options& options, ControlTask& task, const PlanRunner* steps)
      : options_(options),
        task_(task),
        bus_(hw::open_bus(options.can, robot().bitrate_bps, hw::master_frames(robot()))),
        can_log_(options.can_log.empty() ? nullptr : std::make_unique<CanLog>(options.can_log)),
        logged_bus_(can_log_ ? std::make_unique<hw::RecordingBus>(*bus_, can_log_->ring())
                             : nullptr),
        arm_(robot(), logged_bus_ ? static_cast<CanBus&>(*logged_bus_) : *bus_),
        runner_(arm_, task, recorder_.get(), {}),
        telemetry_(outputs(options), robot().joints.size(), steps, *recorder_) {
    recorder_->add(telemetry_);
    if (can_log_) recorder_->add(*can_log_);
  }

  /// Before run(); outlives it.
  void add(RecordConsumer& consumer) { recorder_->add(consumer); }

  /// To the end of the task. @throws what the bring-up throws
  void run() {
    recorder_->start();
    std::exception_ptr failure;
    std::thread real_time([&] {
      try {
        run_arm();
      } catch (...) {
        failure = std::current_exception();
      }
    });
    real_time.join();
    recorder_->stop();
    if (can_log_) can_log_->drain();
    if (failure) std::rethrow_exception(failure);
  }

  [[nodiscard]] const CycleRunner& runner() const { return runner_; }
  [[nodiscard]] std::uint64_t records_dropped() const { return recorder_->dropped(); }
  [[nodiscard]] std::string arm_fault_text() const {
    return hw::describe(task_.ending().arm_fault, robot());
  }

  /// Tells what came of it, everywhere. @return the exit status
  int conclude(RunResult result) {
    result.arm_counters = named(arm_.counters());
    telemetry_.publish_summary(result, task_.record());
    print_closing(result);
    if (result.ended_badly()) {
      runner_.black_box().write_csv(options_.black_box);
      std::fprintf(stderr, "tenon-exec: the last second is in %s\n", options_.black_box.c_str());
    }
    write_json(options_.json, to_json(result, task_.cell()));
    return result.exit_code;
  }

 private:
  static std::vector<std::shared_ptr<lcm::LCM>> outputs(const Options& options) {
    std::vector<std::string> warnings;
    auto opened = open_telemetry(options.lcm_url, options.log, warnings);
    for (const std::string& line : warnings) std::fprintf(stderr, "%s\n", line.c_str());
    return opened;
  }

  // Everything that lives on the real-time thread: real time, the drives' bring-up, the run. Asked
  // to stop during the bring-up, the run ends before anything is enabled.
  void run_arm() {
    ask_for_real_time(options_);
    constexpr std::int64_t kPoll_ns = 1'000'000;
    std::int64_t now_ns = MonotonicClock::now_ns();
    while (!stop_asked.load(std::memory_order_relaxed) && !arm_.prepare(now_ns)) {
      if (arm_.state() == ArmState::kFault) throw InputError(hw::describe(arm_.fault(), robot()));
      arm_.wait(kPoll_ns);
      now_ns = MonotonicClock::now_ns();
    }
    runner_.run(stop_asked);
  }

  [[nodiscard]] const Robot& robot() const { return task_.cell().robot; }

  const Options& options_;
  ControlTask& task_;
  std::unique_ptr<CanBus> bus_;
  std::unique_ptr<CanLog> can_log_;
  std::unique_ptr<hw::RecordingBus> logged_bus_;
  hw::CanopenArm arm_;
  std::unique_ptr<Recorder> recorder_ = std::make_unique<Recorder>();
  CycleRunner runner_;
  Telemetry telemetry_;
};

int run_plan(const Options& options, const Cell& cell, const DryRun& dry_run) {
  Controller::Parameters parameters;
  parameters.go_to_start = options.go_to_start;
  Controller controller(cell, dry_run, parameters);
  TaskRun run(options, controller, &controller.runner());
  StepPrinter printer(controller.runner());
  run.add(printer);
  std::optional<TraceWriter> trace;
  if (!options.trace.empty()) run.add(trace.emplace(options.trace, controller.runner()));
  run.run();
  return run.conclude(
      gather_result(controller, run.runner(), run.records_dropped(), run.arm_fault_text()));
}

int identify(const Options& options, const Cell& cell) {
  const std::unique_ptr<Identification> identification =
      options.identify_payload ? make_payload_identification(cell)
                               : make_contact_identification(cell, options.identify_contact);
  const ControlTask& task = identification->motion();
  std::printf("identifying the %s; cell '%s', robot '%s', cycle %g ms\n",
              options.identify_payload ? "payload" : "contact", cell.name.c_str(),
              cell.robot.name.c_str(), 1e3 * task.cycle_s());
  std::fflush(stdout);
  TaskRun run(options, identification->motion(), nullptr);
  run.run();
  std::optional<Finding> finding;
  if (task.ending().reason == EndReason::kMeasured) finding = identification->finding();
  // Its first line is the result's message.
  if (finding) std::fputs(finding->report.substr(finding->report.find('\n') + 1).c_str(), stdout);
  return run.conclude(
      gather_result(task, finding, run.runner(), run.records_dropped(), run.arm_fault_text()));
}

int execute(const Options& options) {
  if (!options.dry_run) check_outputs(options);
  if (!options.json.empty() && options.json != "-") check_writable(options.json);
  const Cell cell = load_cell(options.cell);
  const bool identifies = options.identify_payload || !options.identify_contact.empty();
  if (options.plan.empty() && !identifies) throw InputError("--plan is required; see --help");
  const Plan plan = identifies ? Plan{} : load_plan(options.plan);
  hw::check_bus_load(cell.robot);
  hw::check_response_times(cell.robot);
  if (identifies) return identify(options, cell);
  DryRun run = dry_run(plan, cell);
  const std::vector<std::string> others = check_plan(plan, cell);
  run.refusals.insert(run.refusals.begin(), others.begin(), others.end());
  if (options.dry_run) report_dry_run(options, run, plan, cell);
  if (!run.refusals.empty()) {
    throw InputError(options.plan + ": cell '" + cell.name +
                     "' cannot execute this plan: " + run.refusals.front());
  }
  if (options.dry_run) return 0;
  print_opening(plan, cell, run);
  return run_plan(options, cell, run);
}

int parse_and_execute(int argc, char** argv) {
  Options options;
  CLI::App app{"Executes a plan of guarded moves on an arm over CAN."};
  app.footer(
      "Example:\n  tenon-exec --cell hw/cells/gantry3.yaml --plan plan.tnp \\\n"
      "             --can slcan://127.0.0.1:29536 --log run.lcmlog --json result.json\n\n"
      "Exit status: 0 the plan is done (--dry-run: can be) or something identified, 1 it failed or "
      "was stopped, 2 bad input.");
  app.set_version_flag("--version", TENON_VERSION);
  app.add_option("--cell", options.cell, "cell file (YAML)")->required();
  std::vector<CLI::Option*> of_a_plan = {
      app.add_option("--plan", options.plan, "plan file (.tnp)"),
      app.add_flag("--dry-run", options.dry_run,
                   "only go through the plan with the cell's arm in mind; needs no --can"),
      app.add_flag("--go-to-start", options.go_to_start, "move to the plan's start first"),
      app.add_option("--trace", options.trace, "inputs of every guarded move, to replay")};
  app.add_option("--can", options.can, "socketcan:can0, slcan:/dev/ttyACM0 or slcan://HOST:PORT");
  app.add_option("--rt", options.rt, "real time: require, prefer or off")
      ->check(CLI::IsMember({"require", "prefer", "off"}))
      ->capture_default_str();
  app.add_option("--cpu", options.cpu, "processor for the control loop")
      ->check(CLI::Range(0, 1023));
  CLI::Option* payload = app.add_flag("--identify-payload", options.identify_payload,
                                      "instead of a plan: payload and sensor bias, in some poses");
  CLI::Option* contact = app.add_option(
      "--identify-contact", options.identify_contact,
      "instead of a plan: stiffness and lag at what stands along x, -x, y, -y, z or -z");
  contact->excludes(payload);
  for (CLI::Option* option : of_a_plan) option->excludes(payload)->excludes(contact);
  app.add_option("--lcm-url", options.lcm_url, "where telemetry goes, or none")
      ->capture_default_str();
  app.add_option("--log", options.log, "telemetry log for lcm-logplayer");
  app.add_option("--can-log", options.can_log, "frames in candump's format");
  app.add_option("--json", options.json, "result, - for standard output");
  app.add_option("--black-box", options.black_box, "the last second as CSV, after a fault")
      ->capture_default_str();
  parse(app, argc, argv);
  std::signal(SIGINT, &ask_to_stop);
  std::signal(SIGTERM, &ask_to_stop);
  std::signal(SIGPIPE, SIG_IGN);
  return execute(options);
}

}  // namespace
}  // namespace tenon::executor

int main(int argc, char** argv) {
  return tenon::run_main("tenon-exec",
                         [&] { return tenon::executor::parse_and_execute(argc, argv); });
}

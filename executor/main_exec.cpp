// tenon-exec: runs a plan on an arm over CAN. Only composes; see executor/README.md.

#include <CLI/CLI.hpp>
#include <atomic>
#include <csignal>
#include <cstdio>
#include <memory>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "executor/controller.h"
#include "executor/cycle_runner.h"
#include "executor/dry_run/dry_run.h"
#include "executor/dry_run/dry_run_report.h"
#include "executor/identification/identification.h"
#include "executor/identification/identification_runner.h"
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

// Everything that lives on the real-time thread: real time, the drives' bring-up, the run. Asked to
// stop during the bring-up, the run ends before anything is enabled.
template <typename Runner>
void run_arm(const Options& options, const Robot& robot, Arm& arm, Runner& runner) {
  ask_for_real_time(options);
  constexpr std::int64_t kPoll_ns = 1'000'000;
  std::int64_t now_ns = MonotonicClock::now_ns();
  while (!stop_asked.load(std::memory_order_relaxed) && !arm.prepare(now_ns)) {
    if (arm.state() == ArmState::kFault) throw InputError(hw::describe(arm.fault(), robot));
    arm.wait(kPoll_ns);
    now_ns = MonotonicClock::now_ns();
  }
  runner.run(stop_asked);
}

// What the work threw, if it did.
template <typename Work>
std::exception_ptr on_real_time_thread(Work work) {
  std::exception_ptr failure;
  std::thread real_time([&] {
    try {
      work();
    } catch (...) {
      failure = std::current_exception();
    }
  });
  real_time.join();
  return failure;
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

int run_plan(const Options& options, const Cell& cell, const DryRun& dry_run) {
  const Plan& plan = dry_run.plan;
  const std::unique_ptr<CanBus> bus =
      hw::open_bus(options.can, cell.robot.bitrate_bps, hw::master_frames(cell.robot));
  std::unique_ptr<CanLog> can_log;
  std::optional<hw::RecordingBus> recording_bus;
  if (!options.can_log.empty()) {
    can_log = std::make_unique<CanLog>(options.can_log);
    recording_bus.emplace(*bus, can_log->ring());
  }
  hw::CanopenArm arm(cell.robot, recording_bus ? static_cast<CanBus&>(*recording_bus) : *bus);

  Controller::Parameters parameters;
  parameters.go_to_start = options.go_to_start;
  Controller controller(cell, dry_run, parameters);
  const auto recorder = std::make_unique<Recorder>();
  CycleRunner runner(arm, controller, recorder.get(), {});

  std::vector<std::string> warnings;
  Telemetry telemetry(open_telemetry(options.lcm_url, options.log, warnings), controller,
                      *recorder);
  for (const std::string& line : warnings) std::fprintf(stderr, "%s\n", line.c_str());
  StepPrinter printer(controller.runner());
  recorder->add(telemetry);
  recorder->add(printer);
  std::optional<TraceWriter> trace;
  if (!options.trace.empty()) {
    trace.emplace(options.trace, controller.runner());
    recorder->add(*trace);
  }
  if (can_log != nullptr) recorder->add(*can_log);

  recorder->start();
  const std::exception_ptr failure =
      on_real_time_thread([&] { run_arm(options, cell.robot, arm, runner); });
  recorder->stop();
  if (can_log != nullptr) can_log->drain();
  if (failure) std::rethrow_exception(failure);

  const RunResult result = gather_result(controller, runner, recorder->dropped(),
                                         hw::describe(controller.ending().arm_fault, cell.robot));
  telemetry.publish_summary(result, controller.record());
  print_closing(result);
  if (result.exit_code != 0 && result.reason != EndReason::kStopRequested) {
    runner.black_box().write_csv(options.black_box);
    std::fprintf(stderr, "tenon-exec: the last second is in %s\n", options.black_box.c_str());
  }
  write_json(options.json, to_json(result, plan, cell));
  return result.exit_code;
}

int identify(const Options& options, const Cell& cell) {
  const std::unique_ptr<Identification> identification =
      options.identify_payload ? make_payload_identification(cell)
                               : make_contact_identification(cell, options.identify_contact);
  const std::unique_ptr<CanBus> bus =
      hw::open_bus(options.can, cell.robot.bitrate_bps, hw::master_frames(cell.robot));
  hw::CanopenArm arm(cell.robot, *bus);
  IdentificationRunner runner(arm, identification->motion());
  const std::exception_ptr failure =
      on_real_time_thread([&] { run_arm(options, cell.robot, arm, runner); });
  if (failure) std::rethrow_exception(failure);

  const Ending& ending = identification->motion().ending();
  if (ending.reason != EndReason::kNone) {
    const std::string fault = hw::describe(ending.arm_fault, cell.robot);
    std::fprintf(stderr, "tenon-exec: %s\n", describe(ending, Plan{}, cell, fault).c_str());
    return 1;
  }
  std::fputs(identification->report().c_str(), stdout);
  return identification->found() ? 0 : 1;
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
      "Exit status: 0 the plan is done (--dry-run: can be), 1 it failed or was stopped, 2 bad "
      "input.");
  app.set_version_flag("--version", TENON_VERSION);
  app.add_option("--cell", options.cell, "cell file (YAML)")->required();
  CLI::Option* plan = app.add_option("--plan", options.plan, "plan file (.tnp)");
  app.add_option("--can", options.can, "socketcan:can0, slcan:/dev/ttyACM0 or slcan://HOST:PORT");
  app.add_flag("--dry-run", options.dry_run,
               "only go through the plan with the cell's arm in mind; needs no --can");
  app.add_option("--rt", options.rt, "real time: require, prefer or off")
      ->check(CLI::IsMember({"require", "prefer", "off"}))
      ->capture_default_str();
  app.add_option("--cpu", options.cpu, "processor for the control loop")
      ->check(CLI::Range(0, 1023));
  app.add_flag("--go-to-start", options.go_to_start, "move to the plan's start first");
  CLI::Option* payload = app.add_flag("--identify-payload", options.identify_payload,
                                      "instead of a plan: payload and sensor bias, in some poses");
  app.add_option("--identify-contact", options.identify_contact,
                 "instead of a plan: stiffness and lag at what stands along x, -x, y, -y, z or -z")
      ->excludes(plan)
      ->excludes(payload);
  payload->excludes(plan);
  app.add_option("--lcm-url", options.lcm_url, "where telemetry goes, or none")
      ->capture_default_str();
  app.add_option("--log", options.log, "telemetry log for lcm-logplayer");
  app.add_option("--can-log", options.can_log, "frames in candump's format");
  app.add_option("--trace", options.trace, "inputs of every guarded move, to replay");
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

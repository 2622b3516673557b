// tenon-exec: runs a plan on an arm over CAN. Only composes; see executor/README.md.

#include <CLI/CLI.hpp>
#include <atomic>
#include <csignal>
#include <cstdio>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

#include "executor/controller.h"
#include "executor/cycle_runner.h"
#include "executor/monotonic_clock.h"
#include "executor/plan_check.h"
#include "executor/realtime.h"
#include "executor/recorder.h"
#include "executor/run_result.h"
#include "executor/telemetry.h"
#include "executor/trace.h"
#include "hw/bus_load.h"
#include "hw/can/candump_log.h"
#include "hw/can/open_bus.h"
#include "hw/can/recording_bus.h"
#include "hw/canopen_arm.h"
#include "hw/describe_fault.h"
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

// Everything that lives on the real-time thread: real time, the drives' bring-up, the run.
void run_arm(const Options& options, const Robot& robot, Arm& arm, CycleRunner& runner) {
  if (options.rt != "off") {
    RealtimeParameters parameters;
    parameters.cpu = options.cpu;
    const std::vector<std::string> missing = enter_realtime(parameters);
    if (options.rt == "require" && !missing.empty()) {
      throw InputError("--rt require: " + missing.front());
    }
    for (const std::string& line : missing) std::fprintf(stderr, "real time: %s\n", line.c_str());
  }
  constexpr std::int64_t kPoll_ns = 1'000'000;
  std::int64_t now_ns = MonotonicClock::now_ns();
  while (!arm.prepare(now_ns)) {
    if (arm.state() == ArmState::kFault) throw InputError(hw::describe(arm.fault(), robot));
    if (stop_asked.load(std::memory_order_relaxed)) {
      throw std::runtime_error("stopped while the drives were being configured");
    }
    arm.wait(kPoll_ns);
    now_ns = MonotonicClock::now_ns();
  }
  runner.run(stop_asked);
}

void print_opening(const Plan& plan, const Cell& cell) {
  const hw::BusLoad load = hw::bus_load(cell.robot);
  std::printf("plan '%s', start '%s', %d steps; cell '%s', robot '%s'\n", plan.task_name.c_str(),
              plan.start_name.c_str(), static_cast<int>(plan.steps.size()), cell.name.c_str(),
              cell.robot.name.c_str());
  std::printf("cycle %g ms, latency %g ms (plan allows %g), bus load at most %.0f %%\n",
              1e-3 * cell.robot.cycle_us, 1e3 * latency_s(cell.robot), 1e3 * plan.latency_max_s,
              100.0 * load.worst);
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

int execute(const Options& options) {
  const Cell cell = load_cell(options.cell);
  const Plan plan = load_plan(options.plan);
  hw::check_bus_load(cell.robot);
  const std::vector<std::string> refusals = check_plan(plan, cell);
  if (!refusals.empty()) {
    throw InputError(options.plan + ": cell '" + cell.name +
                     "' cannot execute this plan: " + refusals.front());
  }
  if (options.can.rfind("slcan-listen:", 0) == 0) {
    throw InputError("--can " + options.can +
                     ": listens for an arm that would have to call; give slcan://HOST:PORT");
  }
  if (!options.json.empty() && options.json != "-") check_writable(options.json);
  check_writable(options.black_box);
  print_opening(plan, cell);

  const std::unique_ptr<CanBus> bus = hw::open_bus(options.can, cell.robot.bitrate_bps);
  std::unique_ptr<CanLog> can_log;
  std::optional<hw::RecordingBus> recording_bus;
  if (!options.can_log.empty()) {
    can_log = std::make_unique<CanLog>(options.can_log);
    recording_bus.emplace(*bus, can_log->ring());
  }
  hw::CanopenArm arm(cell.robot, recording_bus ? static_cast<CanBus&>(*recording_bus) : *bus);

  Controller::Parameters parameters;
  parameters.go_to_start = options.go_to_start;
  Controller controller(cell, plan, parameters);
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
  std::exception_ptr failure;
  std::thread real_time([&] {
    try {
      run_arm(options, cell.robot, arm, runner);
    } catch (...) {
      failure = std::current_exception();
    }
  });
  real_time.join();
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
  if (options.json == "-") {
    std::fputs(to_json(result, plan, cell).c_str(), stdout);
  } else if (!options.json.empty()) {
    write_file(options.json, to_json(result, plan, cell));
  }
  return result.exit_code;
}

int parse_and_execute(int argc, char** argv) {
  Options options;
  CLI::App app{"Executes a plan of guarded moves on an arm over CAN."};
  app.footer(
      "Example:\n  tenon-exec --cell hw/cells/gantry3.yaml --plan plan.tnp \\\n"
      "             --can slcan://127.0.0.1:29536 --log run.lcmlog --json result.json\n\n"
      "Exit status: 0 the plan is done, 1 it failed or was stopped, 2 bad input.");
  app.set_version_flag("--version", TENON_VERSION);
  app.add_option("--cell", options.cell, "cell file (YAML)")->required();
  app.add_option("--plan", options.plan, "plan file (.tnp)")->required();
  app.add_option("--can", options.can, "socketcan:can0, slcan:/dev/ttyACM0 or slcan://HOST:PORT")
      ->required();
  app.add_option("--rt", options.rt, "real time: require, prefer or off")
      ->check(CLI::IsMember({"require", "prefer", "off"}))
      ->capture_default_str();
  app.add_option("--cpu", options.cpu, "processor for the control loop")
      ->check(CLI::Range(0, 1023));
  app.add_flag("--go-to-start", options.go_to_start, "move to the plan's start first");
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

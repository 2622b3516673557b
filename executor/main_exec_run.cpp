#include "executor/main_exec_run.h"

#include <array>
#include <cstdio>
#include <exception>
#include <thread>
#include <utility>

#include "executor/loop/realtime.h"
#include "executor/main_exec_output.h"
#include "hw/bus_load/bus_load.h"
#include "hw/can/candump_log.h"
#include "hw/can/metered_bus.h"
#include "hw/can/open_bus.h"
#include "hw/can/recording_bus.h"
#include "hw/robot_arm/open_arm.h"
#include "shared/base/error.h"
#include "shared/config/signals.h"
#include "shared/system/monotonic_clock.h"

namespace tenon::executor {

/// The frames that pass on the bus, written on the recorder's thread.
class CanLog : public RecordConsumer {
 public:
  explicit CanLog(const std::string& file)
      : log_(file, {"can0", "can1"}, 1000 * wall_clock_us() - monotonic_now_ns()) {}
  void consume(const CycleRecord& /*record*/) override { drain(); }
  void drain() { log_.drain(ring_); }
  [[nodiscard]] RecordReport close() { return log_.close(ring_); }
  [[nodiscard]] hw::CanRecordRing& ring() { return ring_; }

 private:
  hw::CanRecordRing ring_;
  hw::CandumpLog log_;
};

namespace {

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

TelemetryOutputs outputs(const Options& options) {
  std::vector<std::string> warnings;
  auto opened = open_telemetry(options.lcm_url, options.log, warnings);
  for (const std::string& line : warnings) std::fprintf(stderr, "%s\n", line.c_str());
  return opened;
}

std::vector<std::pair<std::string, std::uint64_t>> named(const hw::ArmCounters& c) {
  return {{"joint_frames_missing", c.joint_frames_missing},
          {"wrenches_missing", c.wrenches_missing},
          {"wrench_halves_torn", c.wrench_halves_torn},
          {"late_frames", c.late_frames},
          {"malformed_frames", c.malformed_frames},
          {"unexpected_frames", c.unexpected_frames},
          {"emergencies", c.emergencies},
          {"send_failures", c.send_failures},
          {"invalid_setpoints", c.invalid_setpoints},
          {"unbraked_axes", c.unbraked_axes}};
}

/// On each bus.
std::array<std::uint32_t, BusPair::kBuses> frames_at_once(const Robot& robot) {
  return {hw::master_frames(robot, kArmBus), hw::master_frames(robot, kSensorBus)};
}

}  // namespace

TaskRun::TaskRun(const Options& options, ControlTask& task, const PlanRunner* steps,
                 StopRequests& stop)
    : options_(options),
      task_(task),
      stop_(stop),
      buses_(std::make_unique<hw::Buses>(hw::parse_bus_uris(options.can), robot(),
                                         frames_at_once(robot()))),
      can_log_(options.can_log.empty() ? nullptr : std::make_unique<CanLog>(options.can_log)),
      logged_bus_(can_log_ ? std::make_unique<hw::RecordingBus>(bus(), can_log_->ring()) : nullptr),
      metered_bus_(std::make_unique<hw::MeteredBus>(logged_bus_ ? static_cast<CanBus&>(*logged_bus_)
                                                                : bus())),
      arm_(hw::open_arm(task.cell(), *metered_bus_)),
      recorder_(std::make_unique<Recorder>()),
      runner_(*arm_, task, recorder_.get(), {}),
      telemetry_(outputs(options), task.cell(), steps, *recorder_,
                 {[this] { return metered_bus_->traffic(); }, hw::BusLoad::kWorstAllowed}),
      hold_printer_(task.cell()) {
  recorder_->add(telemetry_);
  recorder_->add(hold_printer_);
  if (can_log_) recorder_->add(*can_log_);
  if (!options.trace.empty() && steps != nullptr) {
    recorder_->add(trace_.emplace(options.trace, *steps));
  }
}

TaskRun::~TaskRun() = default;

CanBus& TaskRun::bus() const { return buses_->all(); }

void TaskRun::run() {
  for (const std::string& remark : hw::start_remarks(robot())) {
    std::fprintf(stderr, "tenon-exec: %s\n", remark.c_str());
  }
  telemetry_.publish_setup();
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
  if (failure) {
    tell_lost_records();
    std::rethrow_exception(failure);
  }
}

// Everything that lives on the real-time thread: real time, the drives' bring-up, the run. Asked to
// stop during the bring-up, the run ends before anything is enabled.
void TaskRun::run_arm() {
  ask_for_real_time(options_);
  constexpr std::int64_t kPoll_ns = 1'000'000;
  std::int64_t now_ns = monotonic_now_ns();
  while (!stop_.any() && !arm_->prepare(now_ns)) {
    if (arm_->state() == ArmState::kFault) throw InputError(hw::fault_text(arm_->fault(), robot()));
    arm_->wait(kPoll_ns);
    now_ns = monotonic_now_ns();
  }
  for (const std::string& note : arm_->notes()) {
    std::fprintf(stderr, "tenon-exec: %s\n", note.c_str());
  }
  runner_.run(stop_);
}

std::string TaskRun::arm_fault_text() const {
  return hw::fault_text(task_.ending().arm_fault, robot());
}

// A record that the recorder's ring has lost is lost to both files that it feeds.
std::vector<RecordReport> TaskRun::close_records() {
  std::vector<RecordReport> reports;
  const auto add = [&](RecordReport report) {
    if (recorder_->dropped() > 0) report.lose(recorder_->dropped(), "written too slowly");
    reports.push_back(std::move(report));
  };
  if (const RecordReport* log = telemetry_.close_log()) add(*log);
  if (can_log_) reports.push_back(can_log_->close());
  if (trace_) {
    trace_->close();
    add(trace_->report());
  }
  return reports;
}

void TaskRun::tell_lost_records() {
  RunResult none;
  none.records = close_records();
  print_losses(none);
}

void TaskRun::keep_black_box(RunResult& result) const {
  if (!result.ended_badly()) return;
  result.records.push_back(runner_.black_box().write_csv(options_.black_box));
  if (!result.records.back().whole()) return;
  std::fprintf(stderr, "tenon-exec: the last second is in %s\n", options_.black_box.c_str());
}

int TaskRun::conclude(RunResult result) {
  result.arm_counters = named(arm_->counters());
  result.bus = bus().status();
  telemetry_.publish_summary(result, task_.record());
  result.unpublished = telemetry_.failures();
  for (RecordReport& report : close_records()) result.records.push_back(std::move(report));
  print_closing(result);
  result.output_lost = !output_arrived();
  keep_black_box(result);
  const RecordReport json = write_whole("json", options_.json, to_json(result, task_.cell()));
  if (!json.whole()) result.records.push_back(json);
  if (const std::uint64_t axes = arm_->counters().unbraked_axes; axes > 0) {
    std::fprintf(stderr,
                 "tenon-exec: told to stop, %s did not brake and lost voltage; see to the drives "
                 "before the next run\n",
                 axes == 1 ? "one axis" : (std::to_string(axes) + " axes").c_str());
  }
  print_losses(result);
  return result.exit_status();
}

}  // namespace tenon::executor

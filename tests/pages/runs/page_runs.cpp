// Runs for the run's page, executed in virtual time against the virtual arm and written down as
// tenon-exec does: NAME.lcmlog and NAME.json for each.
//
//   page_runs FOLDER
//
// box: to its end. fault: a drive that falls silent in step 2. missed: an environment that is
// nowhere near where the plan looks for it. Some cycles of each are late.

#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "executor/telemetry/recorder.h"
#include "executor/telemetry/run_result.h"
#include "executor/telemetry/telemetry.h"
#include "hw/arm/describe_fault.h"
#include "shared/config/load.h"
#include "sim/cell/faults/fault_spec.h"
#include "tests/support/places.h"
#include "tests/support/whole_run.h"

namespace {

using namespace tenon;

/// Records as they come: in virtual time nobody needs a thread for them.
class Drained final : public executor::CycleSink {
 public:
  explicit Drained(executor::Recorder& recorder) : recorder_(recorder) {}

  void record(const executor::CycleRecord& record) noexcept override {
    now_ns_ = record.time_ns;
    recorder_.record(record);
    recorder_.drain();
  }

  /// Of the cycle that was recorded last.
  [[nodiscard]] std::int64_t now_ns() const { return now_ns_; }

 private:
  executor::Recorder& recorder_;
  std::int64_t now_ns_ = 0;
};

/// How late the loop wakes: by more than a period once in about two seconds.
std::int64_t lateness_ns(std::int64_t due_ns, const Cell& cell) {
  const std::int64_t cycle_ns = std::int64_t{1000} * cell.robot.cycle_us;
  return due_ns / cycle_ns % 997 == 996 ? cycle_ns + cycle_ns / 5 : cycle_ns / 33;
}

void write_run(const std::filesystem::path& folder, const std::string& name,
               const tests::WholeRun::Options& options) {
  const Cell cell = load_cell(tests::gantry_cell_file());
  const Task task = load_task(tests::box_task_file());
  const Plan plan = load_plan(tests::shared_plan("box_4_gantry3"));
  const auto recorder = std::make_unique<executor::Recorder>();
  Drained sink(*recorder);
  tests::WholeRun run(cell, task, plan, options, &sink);
  std::vector<std::string> warnings;
  executor::BusView bus;
  // In virtual time, so that the page of a run is the same byte for byte whenever it is made.
  bus.now_ns = [&sink] { return sink.now_ns(); };
  bus.traffic = [&cell, &sink] {
    const double bits = 1e-9 * static_cast<double>(sink.now_ns()) * cell.robot.bitrate_bps;
    CanBusTraffic traffic;
    traffic.nominal_bits = static_cast<std::uint64_t>(0.4 * bits);
    traffic.worst_bits = static_cast<std::uint64_t>(0.5 * bits);
    return traffic;
  };
  bus.load_most = 0.85;
  const std::string log = folder / (name + ".lcmlog");
  executor::Telemetry telemetry(executor::open_telemetry("none", log, warnings), cell,
                                &run.controller().runner(), *recorder, bus);
  recorder->add(telemetry);
  telemetry.publish_setup();
  const tests::WholeRun::Result ended =
      run.run_on_clock([&cell](std::int64_t due_ns) { return lateness_ns(due_ns, cell); });
  const std::string fault = hw::fault_text(run.arm().fault(), cell.robot);
  const executor::RunResult result =
      executor::gather_result(run.controller(), run.runner(), 0, fault);
  telemetry.publish_summary(result, run.controller().record());
  (void)telemetry.close_log();
  write_file(folder / (name + ".json"), executor::to_json(result, cell));
  std::printf("%s: %s\n", name.c_str(), ended.reason.c_str());
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 2) return 2;
  tests::WholeRun::Options options;
  options.start = "4";
  options.seed = 3;
  options.offset[0] = -0.034;
  options.offset[1] = 0.0094;
  write_run(argv[1], "box", options);
  tests::WholeRun::Options missed = options;
  missed.offset[0] = 0.3;
  write_run(argv[1], "missed", missed);
  options.faults = {sim::parse_fault("silent-node:node=2,at=step:2")};
  write_run(argv[1], "fault", options);
  options.faults = {sim::parse_fault("forged-force:at=step:2,force_N=80,duration_s=0.1")};
  write_run(argv[1], "forced", options);
  return 0;
}

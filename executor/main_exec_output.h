#pragma once
// What tenon-exec prints, and the JSON that it writes.

#include <cstdint>
#include <string>

#include "executor/dry_run/dry_run.h"
#include "executor/motion/plan_runner.h"
#include "executor/telemetry/recorder.h"
#include "executor/telemetry/run_result.h"
#include "shared/cell/cell.h"
#include "shared/plan/plan.h"
#include "shared/system/record_file.h"

namespace tenon::executor {

/// Prints a line for every finished step, and for one that waits, on the recorder's thread.
class StepPrinter : public RecordConsumer {
 public:
  /// @param runner whose reports are printed; must outlive this
  explicit StepPrinter(const PlanRunner& runner) : runner_(runner) {}
  void consume(const CycleRecord& record) override;

 private:
  const PlanRunner& runner_;
  std::size_t printed_ = 0;
  std::int32_t awaited_ = -1;
};

/// Says at once, on standard error, that the run is over and a joint held until the user stops, and
/// where it is not held any more; and where it goes on being held though something would end it. On
/// the recorder's thread.
class HoldPrinter : public RecordConsumer {
 public:
  explicit HoldPrinter(const Cell& cell) : cell_(cell) {}
  void consume(const CycleRecord& record) override;

 private:
  Cell cell_;
  Hold printed_ = Hold::kNone;
  std::uint32_t unheeded_ = 0;
};

/// What is about to run where, and how the dry run slowed it.
void print_opening(const Plan& plan, const Cell& cell, const DryRun& dry_run);

/// What is about to be identified.
void print_identification(const char* what, const Cell& cell);

/// What came of a run; the message on standard error too, where it failed.
void print_closing(const RunResult& result);

/// What was lost of its output, on standard error; nothing where nothing was.
void print_losses(const RunResult& result);

/// To a file, or to standard output for "-"; nowhere where no name is given.
/// @throws InputError where the file cannot be written
void write_json(const std::string& file, const std::string& json);

/// The same, of a run that is over: a file that cannot be written ends nothing any more.
/// @param name of the option that asked for it, as in "identify_friction"
[[nodiscard]] RecordReport write_whole(const std::string& name, const std::string& file,
                                       const std::string& text);

/// The table, and the JSON; the JSON alone where it goes to standard output.
void report_dry_run(const std::string& json_file, const DryRun& run, const Plan& plan,
                    const Cell& cell);

}  // namespace tenon::executor

#pragma once
// Every input of every guarded move, bit for bit, to a file and back: what was executed can be
// replayed into GuardedMove. A text file; doubles are hexadecimal, so nothing is rounded.
//
//   tenon-trace 2
//   m STEP SIGNATURE TIMEOUT_US V(8)       a move begins, with these contacts held, at these speeds
//                                          (SpeedLimits in its order; the dry run may slow a step)
//   i TIME_NS P(3) Q(4, w first) W(6) FRESH SP(3) SQ(4)   an input, and the setpoint it led to
//                                          (the move's own time, which stands while it is paused)
//   r STEP OUTCOME SIGNATURE DECIDED_NS DURATION_NS       how the move of the step ended
//   g                                      records were lost here; what follows cannot be replayed

#include <cstdint>
#include <filesystem>
#include <optional>
#include <vector>

#include "executor/motion/plan_runner.h"
#include "executor/telemetry/recorder.h"
#include "shared/system/record_file.h"

namespace tenon::executor {

class TraceWriter : public RecordConsumer {
 public:
  /// @param runner whose reports are written; must outlive this
  /// @throws InputError where the file cannot be written
  TraceWriter(const std::filesystem::path& file, const PlanRunner& runner);
  void consume(const CycleRecord& record) override;
  void close() { file_.close(); }
  [[nodiscard]] const RecordReport& report() const { return file_.report(); }

 private:
  RecordFile file_;
  const PlanRunner& runner_;
  std::size_t steps_written_ = 0;
  std::optional<std::uint64_t> last_sequence_;
};

struct TracedInput {
  GuardedMove::Input input;
  Pose setpoint;
};

struct TracedMove {
  std::size_t step = 0;
  ContactSignature signature_before;
  std::optional<Pose> held;  ///< the setpoint as the move before left it
  std::uint32_t timeout_us = 0;
  SpeedLimits speeds;
  std::vector<TracedInput> inputs;
  bool complete = false;  ///< the run lasted to its end; then the rest means something
  Outcome outcome = Outcome::kTimeout;
  ContactSignature signature;
  std::int64_t decided_ns = 0;
  std::int64_t duration_ns = 0;
};

/// The move as it was executed: the plan's, at the speeds of the trace.
[[nodiscard]] MoveParameters move_parameters(const Plan& plan, const TracedMove& traced);

/// @throws InputError naming file and line for anything that is not such a trace, or has a gap
[[nodiscard]] std::vector<TracedMove> read_trace(const std::filesystem::path& file);

}  // namespace tenon::executor

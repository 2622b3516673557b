#pragma once
// A run as the log of its telemetry tells it, message by message. Takes whatever comes; what makes
// no sense is left out and counted. Offline; one thread.

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>

#include "executor/faults/end_reason.h"
#include "executor/recorded/event_file.h"
#include "shared/plan/plan.h"
#include "shared/run/recorded_run.h"

namespace tenon {
class cycle_state_t;
class run_setup_t;
class run_status_t;
class run_summary_t;
class step_event_t;
}  // namespace tenon

namespace tenon::executor {

/// The last run of a log that holds several.
/// @throws InputError where the file cannot be read, is no log or a damaged one, holds no cycle of
/// a run, or one of another plan
[[nodiscard]] RecordedRun read_run_log(const std::filesystem::path& file, const Plan& plan);

class RunLog {
 public:
  /// @param name of the file, for messages  @param plan outlives this
  RunLog(std::string name, const Plan& plan) : name_(std::move(name)), plan_(plan) {}

  /// @throws InputError where it is of another plan
  void take(const LoggedEvent& event);
  /// After the last event. @param breaks_off the file ends within an event
  [[nodiscard]] RecordedRun finish(bool breaks_off);

 private:
  /// What the messages of one run have told so far.
  struct Seen {
    std::optional<std::int64_t> start_ns;  ///< monotonic, of the first cycle
    std::int64_t sequence = -1;            ///< of the last cycle
    std::int8_t state = -1;
    EndReason reason = EndReason::kNone;
    double ended_s = 0.0;
    bool setup = false;
    bool bus_bad = false;
    std::int8_t slipped_joint = -1;
    std::int8_t arm_fault = 0;
  };

  template <typename Message>
  void take_message(const LoggedEvent& event);
  void take(const tenon::run_setup_t& message);
  void take(const tenon::cycle_state_t& message);
  void take(const tenon::run_status_t& message);
  void take(const tenon::step_event_t& message);
  void take(const tenon::run_summary_t& message);
  void begin_anew();
  void check_plan(const tenon::run_setup_t& message) const;
  void follow_state(const tenon::cycle_state_t& message, double time_s);
  void add_fault(double time_s, const std::string& text) { run_.faults.push_back({time_s, text}); }
  [[nodiscard]] double since_start_s(std::int64_t monotonic_ns) const;
  void note_what_is_missing(bool breaks_off);

  std::string name_;
  const Plan& plan_;
  RecordedRun run_;
  Seen seen_;
  std::uint64_t runs_ = 1;
  std::uint64_t malformed_ = 0;
};

}  // namespace tenon::executor

#pragma once
// What happens in a run, in words: states, ends of steps, waits, faults, the end. Each is told
// once, by the message that tells it first. Pure; allocates.

#include <cstdint>
#include <string>
#include <vector>

#include "executor/export/message_columns.h"

namespace tenon::executor {

/// The numbers are Foxglove's.
enum class EventLevel : std::uint8_t { kInfo = 2, kWarning = 3, kError = 4 };

struct RunEvent {
  EventLevel level = EventLevel::kInfo;
  std::string text;  ///< one line
};

class RunEvents {
 public:
  explicit RunEvents(std::vector<JointName> joints) : joints_(std::move(joints)) {}

  [[nodiscard]] std::vector<RunEvent> of(const tenon::cycle_state_t& message);
  [[nodiscard]] std::vector<RunEvent> of(const tenon::step_event_t& message);
  [[nodiscard]] std::vector<RunEvent> of(const tenon::run_status_t& message);
  [[nodiscard]] std::vector<RunEvent> of(const tenon::run_setup_t& message);
  [[nodiscard]] std::vector<RunEvent> of(const tenon::run_summary_t& message);

 private:
  [[nodiscard]] std::string slip_text(const tenon::run_status_t& message) const;

  std::vector<JointName> joints_;
  std::int8_t state_ = -1;
  std::int8_t end_reason_ = 0;
  std::int16_t awaited_step_ = -1;
  std::int8_t slipped_joint_ = -1;
  bool paused_ = false;
  bool bus_bad_ = false;
};

}  // namespace tenon::executor

#pragma once
// Gets a run message by message, in the order of its log, and makes a file of it. One thread.

#include <cstdint>

#include "executor/export/message_columns.h"
#include "executor/export/run_events.h"

namespace tenon::executor {

class RunWriter {
 public:
  RunWriter() = default;
  RunWriter(const RunWriter&) = delete;
  RunWriter& operator=(const RunWriter&) = delete;
  virtual ~RunWriter() = default;

  // Events come behind the message that tells them.
  virtual void take(const Timed<tenon::cycle_state_t>& message) = 0;
  virtual void take(const Timed<tenon::step_event_t>& message) = 0;
  virtual void take(const Timed<tenon::run_status_t>& /*message*/) {}
  virtual void take(const Timed<tenon::run_setup_t>& /*message*/) {}
  virtual void take(const Timed<tenon::run_summary_t>& /*message*/) {}
  virtual void take(const RunEvent& event, std::int64_t since_ns) = 0;
};

}  // namespace tenon::executor

#pragma once
// A run as one table of CSV: a row a cycle, the columns of a cycle, and behind them what happened
// in it: `outcome` where a step ended, `event` in words. Bytes leave by a function. One thread.

#include <functional>
#include <optional>
#include <string>
#include <string_view>

#include "executor/export/run_writer.h"

namespace tenon::executor {

class CsvRun final : public RunWriter {
 public:
  using Sink = std::function<void(std::string_view bytes)>;

  /// Writes the head.
  CsvRun(Sink sink, Columns<tenon::cycle_state_t> columns);

  using RunWriter::take;
  void take(const Timed<tenon::cycle_state_t>& message) override;
  void take(const Timed<tenon::step_event_t>& message) override;
  void take(const RunEvent& event, std::int64_t since_ns) override;
  /// The last row.
  void finish() { end_row(); }

 private:
  void end_row();

  Sink sink_;
  Columns<tenon::cycle_state_t> columns_;
  std::optional<Timed<tenon::cycle_state_t>> cycle_;  ///< whose row is not yet written
  std::string outcome_;
  std::string events_;
};

}  // namespace tenon::executor

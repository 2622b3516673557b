#include "executor/export/csv_run.h"

#include <utility>

namespace tenon::executor {

CsvRun::CsvRun(Sink sink, Columns<tenon::cycle_state_t> columns)
    : sink_(std::move(sink)), columns_(std::move(columns)) {
  sink_(columns_.csv_head() + ",outcome,event\r\n");
}

void CsvRun::take(const Timed<tenon::cycle_state_t>& message) {
  end_row();
  cycle_ = message;
}

void CsvRun::take(const Timed<tenon::step_event_t>& message) {
  outcome_ = outcome_text(message.message.outcome);
}

void CsvRun::take(const RunEvent& event, std::int64_t /*since_ns*/) {
  events_ += (events_.empty() ? "" : "; ") + event.text;
}

void CsvRun::end_row() {
  if (!cycle_) return;
  std::string row;
  columns_.add_csv_row(*cycle_, row);
  row += ',';
  add_csv(std::exchange(outcome_, {}), row);
  row += ',';
  add_csv(std::exchange(events_, {}), row);
  row += "\r\n";
  sink_(row);
  cycle_.reset();
}

}  // namespace tenon::executor

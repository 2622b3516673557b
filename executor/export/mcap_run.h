#pragma once
// A run as MCAP: a channel for each kind of message, what happens as Foxglove's log, and where the
// tool is and is commanded to be as its frames. Times are the run's clock set to the wall's where
// the first cycle was published, so that cycles are as far apart as they were. One thread.

#include <cstdint>
#include <optional>
#include <string>

#include "executor/export/log_scan.h"
#include "executor/export/mcap_writer.h"
#include "executor/export/run_writer.h"

namespace tenon::executor {

class McapRun final : public RunWriter {
 public:
  /// @param version of Tenon  @param run outlives this
  McapRun(McapWriter::Sink sink, const std::string& version, const LoggedRun& run);

  void take(const Timed<tenon::cycle_state_t>& message) override;
  void take(const Timed<tenon::step_event_t>& message) override { put(steps_, message); }
  void take(const Timed<tenon::run_status_t>& message) override { put(statuses_, message); }
  void take(const Timed<tenon::run_setup_t>& message) override { put(setups_, message); }
  void take(const Timed<tenon::run_summary_t>& message) override { put(summaries_, message); }
  void take(const RunEvent& event, std::int64_t since_ns) override;
  /// @param notes of what is not in it, one line each; empty: nothing
  void finish(const std::string& log, const std::string& notes);

  [[nodiscard]] std::uint64_t messages() const { return writer_.messages(); }

 private:
  template <typename Message>
  struct Topic {
    Columns<Message> columns;
    std::uint16_t channel;
  };
  template <typename Message>
  [[nodiscard]] Topic<Message> topic(const char* name, const char* type, Columns<Message> columns);
  template <typename Message>
  void put(const Topic<Message>& topic, const Timed<Message>& message) {
    writer_.add(topic.channel, time_ns(message.since_ns), topic.columns.json(message));
  }
  void put_frame(std::uint16_t channel, const char* name, std::int64_t time_ns,
                 const double (&position_m)[3], const double (&orientation_wxyz)[4]);
  [[nodiscard]] std::int64_t time_ns(std::int64_t since_ns) const;

  McapWriter writer_;
  const LoggedRun& run_;
  std::string version_;
  Topic<tenon::cycle_state_t> cycles_;
  Topic<tenon::step_event_t> steps_;
  Topic<tenon::run_status_t> statuses_;
  Topic<tenon::run_setup_t> setups_;
  Topic<tenon::run_summary_t> summaries_;
  std::uint16_t events_;
  std::uint16_t tool_;
  std::uint16_t commanded_;
  std::optional<std::int64_t> framed_ns_;  ///< when frames were put last
};

}  // namespace tenon::executor

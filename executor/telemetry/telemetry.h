#pragma once
// Publishes a run over LCM: every cycle, every finished step, and a summary. Outbound only; nothing
// that arrives over LCM can move the arm. Lives on the recorder's thread, never on the real-time
// one: publishing allocates, locks and may block.

#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "executor/motion/plan_runner.h"
#include "executor/telemetry/event_log.h"
#include "executor/telemetry/recorder.h"
#include "executor/telemetry/run_result.h"

namespace lcm {
class LCM;
}

namespace tenon::executor {

inline constexpr const char* kDefaultLcmUrl = "udpm://239.255.76.67:7667?ttl=0";
inline constexpr const char* kCycleChannel = "TENON_CYCLE";
inline constexpr const char* kStepChannel = "TENON_STEP";
inline constexpr const char* kRunChannel = "TENON_RUN";

/// Where telemetry goes to; either may be missing.
struct TelemetryOutputs {
  std::shared_ptr<lcm::LCM> network;
  std::unique_ptr<EventLog> log;
};

/// A network that cannot be opened is left out and said in `warnings`.
/// @throws InputError where the log cannot be written, or the URL is none (lcm_url.h).
/// @param url an LCM URL, or "none"  @param log a file for lcm-logplayer, or empty
[[nodiscard]] TelemetryOutputs open_telemetry(const std::string& url,
                                              const std::filesystem::path& log,
                                              std::vector<std::string>& warnings);

class Telemetry : public RecordConsumer {
 public:
  /// @param steps of the plan that runs, null where none does  @param recorder whose losses are
  /// told; both outlive this
  Telemetry(TelemetryOutputs outputs, std::size_t joint_count, const PlanRunner* steps,
            const Recorder& recorder);

  void consume(const CycleRecord& record) override;
  void publish_summary(const RunResult& result, const CycleRecord& last);

  /// Messages that LCM could not send.
  [[nodiscard]] std::uint64_t failures() const { return failures_; }
  /// The log, closed; null where there is none.
  [[nodiscard]] const RecordReport* close_log();

 private:
  void publish_cycle(const CycleRecord& record);
  void publish_step(const CycleRecord& record, std::size_t index);
  template <typename Message>
  void publish(const char* channel, const Message& message);

  TelemetryOutputs outputs_;
  std::size_t joint_count_;
  const PlanRunner* steps_;
  const Recorder& recorder_;
  std::size_t steps_published_ = 0;
  std::uint64_t failures_ = 0;
};

}  // namespace tenon::executor

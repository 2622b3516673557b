#pragma once
// Publishes a run over LCM: what it is measured by, every cycle, what cycles do not tell, every
// finished step, and a summary. Outbound only; nothing that arrives over LCM can move the arm.
// Lives on the recorder's thread, never on the real-time one: publishing allocates, locks and may
// block.

#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "executor/motion/plan_runner.h"
#include "executor/record/channels.h"
#include "executor/telemetry/event_log.h"
#include "executor/telemetry/recorder.h"
#include "executor/telemetry/run_result.h"
#include "shared/cell/cell.h"
#include "shared/ports/can_bus.h"
#include "shared/system/monotonic_clock.h"

namespace lcm {
class LCM;
}

namespace tenon {
class run_setup_t;
}

namespace tenon::executor {

inline constexpr const char* kDefaultLcmUrl = "udpm://239.255.76.67:7667?ttl=0";

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

/// What telemetry tells of the bus.
struct BusView {
  std::function<CanBusTraffic()> traffic{};  ///< called on the recorder's thread; empty: not known
  double load_most = 1.0;                    ///< fraction of the bus that its frames may take
  std::function<std::int64_t()> now_ns = monotonic_now_ns;  ///< what its rates are taken by
};

class Telemetry : public RecordConsumer {
 public:
  /// @param steps of the plan that runs, null where none does  @param recorder whose losses are
  /// told; both outlive this
  Telemetry(TelemetryOutputs outputs, const Cell& cell, const PlanRunner* steps,
            const Recorder& recorder, BusView bus = {});
  ~Telemetry() override;

  /// What the run is measured by; before the recorder's thread begins.
  void publish_setup() { publish_setup_at(0); }
  void consume(const CycleRecord& record) override;
  void publish_summary(const RunResult& result, const CycleRecord& last);

  /// Messages that LCM could not send.
  [[nodiscard]] std::uint64_t failures() const { return failures_; }
  /// The log, closed; null where there is none.
  [[nodiscard]] const RecordReport* close_log();

 private:
  void publish_setup_at(std::int64_t time_ns);
  void publish_status(const CycleRecord& record);
  void publish_cycle(const CycleRecord& record);
  void publish_step(const CycleRecord& record, std::size_t index);
  template <typename Message>
  void publish(const char* channel, const Message& message);

  TelemetryOutputs outputs_;
  std::size_t joint_count_;
  std::uint32_t bitrate_bps_;
  const PlanRunner* steps_;
  const Recorder& recorder_;
  BusView bus_;
  std::unique_ptr<tenon::run_setup_t> setup_;
  std::int64_t setup_told_ns_ = 0;
  std::int64_t status_told_ns_ = 0;
  std::int64_t statuses_ = 0;
  std::int32_t awaited_told_ = -1;
  bool paused_told_ = false;
  std::uint8_t end_told_ = 0;
  CanBusTraffic traffic_told_;
  std::int64_t traffic_read_ns_ = 0;
  std::size_t steps_published_ = 0;
  std::uint64_t failures_ = 0;
};

}  // namespace tenon::executor

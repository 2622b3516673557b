#include "executor/telemetry/telemetry.h"

#include <algorithm>
#include <lcm/lcm-cpp.hpp>
#include <utility>

#include "executor/telemetry/setup_message.h"
#include "lcmtypes/tenon/cycle_state_t.hpp"
#include "lcmtypes/tenon/run_setup_t.hpp"
#include "lcmtypes/tenon/run_status_t.hpp"
#include "lcmtypes/tenon/run_summary_t.hpp"
#include "lcmtypes/tenon/step_event_t.hpp"
#include "shared/base/error.h"
#include "shared/system/lcm_url.h"
#include "shared/system/monotonic_clock.h"

namespace tenon::executor {
namespace {

constexpr std::int64_t kSetupPeriod_ns = 1'000'000'000;
constexpr std::int64_t kStatusPeriod_ns = 100'000'000;

void fill(const PoseData& pose, double (&position_m)[3], double (&orientation_wxyz)[4]) {
  std::copy(pose.position_m.begin(), pose.position_m.end(), position_m);
  std::copy(pose.orientation_wxyz.begin(), pose.orientation_wxyz.end(), orientation_wxyz);
}

}  // namespace

TelemetryOutputs open_telemetry(const std::string& url, const std::filesystem::path& log,
                                std::vector<std::string>& warnings) {
  TelemetryOutputs outputs;
  if (url != "none") {
    check_lcm_publishes(url);
    check_lcm_url(url);
    const bool routed = has_multicast_route(url);
    auto network = routed ? std::make_shared<lcm::LCM>(url) : nullptr;
    if (network != nullptr && network->good()) {
      outputs.network = std::move(network);
    } else {
      warnings.push_back("telemetry: " +
                         (routed
                              ? url + " cannot be opened"
                              : "no multicast route for " + url + " (" + kSetMulticastRoute + ")") +
                         "; nothing is published" + (log.empty() ? "" : " but the log is written"));
    }
  }
  if (!log.empty()) outputs.log = std::make_unique<EventLog>(log);
  return outputs;
}

Telemetry::Telemetry(TelemetryOutputs outputs, const Cell& cell, const PlanRunner* steps,
                     const Recorder& recorder, BusView bus)
    : outputs_(std::move(outputs)),
      joint_count_(cell.robot.joints.size()),
      bitrate_bps_(cell.robot.bitrate_bps),
      steps_(steps),
      recorder_(recorder),
      bus_(std::move(bus)),
      setup_(std::make_unique<tenon::run_setup_t>(
          setup_message(cell, steps == nullptr ? nullptr : &steps->plan()))) {
  setup_->bus_load_most = bus_.load_most;
}

Telemetry::~Telemetry() = default;

template <typename Message>
void Telemetry::publish(const char* channel, const Message& message) {
  std::vector<std::uint8_t> bytes(static_cast<std::size_t>(message.getEncodedSize()));
  message.encode(bytes.data(), 0, static_cast<int>(bytes.size()));
  if (outputs_.log != nullptr) outputs_.log->add(message.utime, channel, bytes);
  if (outputs_.network == nullptr) return;
  const auto size = static_cast<unsigned>(bytes.size());
  if (outputs_.network->publish(channel, bytes.data(), size) != 0) ++failures_;
}

void Telemetry::consume(const CycleRecord& record) {
  if (record.sequence == 0 || record.time_ns - setup_told_ns_ >= kSetupPeriod_ns) {
    publish_setup_at(record.time_ns);
  }
  publish_cycle(record);
  const bool changed = record.awaited_step != awaited_told_ ||
                       (record.pace <= 0.0) != paused_told_ || record.end_reason != end_told_;
  if (changed || statuses_ == 0 || record.time_ns - status_told_ns_ >= kStatusPeriod_ns) {
    publish_status(record);
  }
  while (steps_ != nullptr && steps_published_ < record.steps_done)
    publish_step(record, steps_published_++);
}

const RecordReport* Telemetry::close_log() {
  if (outputs_.log == nullptr) return nullptr;
  outputs_.log->close();
  return &outputs_.log->report();
}

void Telemetry::publish_setup_at(std::int64_t time_ns) {
  setup_told_ns_ = time_ns;
  setup_->utime = wall_clock_us();
  setup_->monotonic_ns = time_ns;
  publish(kSetupChannel, *setup_);
  ++setup_->sequence;
}

void Telemetry::publish_status(const CycleRecord& record) {
  status_told_ns_ = record.time_ns;
  awaited_told_ = record.awaited_step;
  paused_told_ = record.pace <= 0.0;
  end_told_ = record.end_reason;
  tenon::run_status_t message{};
  message.utime = wall_clock_us();
  message.sequence = statuses_++;
  message.monotonic_ns = record.time_ns;
  message.awaited_step = static_cast<std::int16_t>(record.awaited_step);
  message.pace = record.pace;
  message.arm_fault = static_cast<std::int8_t>(record.arm_fault.kind);
  message.arm_fault_node = record.arm_fault.node;
  message.slipped_joint = static_cast<std::int8_t>(record.slip.joint);
  message.slipped = record.slip.moved;
  message.brakes_unwatched = static_cast<std::int32_t>(record.brakes_unwatched);
  if (bus_.traffic) {
    const CanBusTraffic traffic = bus_.traffic();
    const std::int64_t now_ns = bus_.now_ns();
    const bool first = traffic_read_ns_ == 0;
    tell_bus(traffic, traffic_told_,
             first ? 0.0 : 1e-9 * static_cast<double>(now_ns - traffic_read_ns_), bitrate_bps_,
             message);
    traffic_told_ = traffic;
    traffic_read_ns_ = now_ns;
  }
  publish(kStatusChannel, message);
}

void Telemetry::publish_cycle(const CycleRecord& record) {
  tenon::cycle_state_t message{};
  message.utime = wall_clock_us();
  message.sequence = static_cast<std::int64_t>(record.sequence);
  message.monotonic_ns = record.time_ns;
  message.motion_ns = record.motion_ns;
  message.state = static_cast<std::int8_t>(record.state);
  message.arm_state = static_cast<std::int8_t>(record.arm_state);
  message.end_reason = static_cast<std::int8_t>(record.end_reason);
  message.step = static_cast<std::int16_t>(record.step);
  message.phase = static_cast<std::int8_t>(record.phase);
  message.signature = static_cast<std::int16_t>(record.signature);
  fill(record.pose, message.pose_position_m, message.pose_orientation_wxyz);
  fill(record.setpoint, message.setpoint_position_m, message.setpoint_orientation_wxyz);
  fill(record.commanded, message.commanded_position_m, message.commanded_orientation_wxyz);
  std::copy(record.velocity.begin(), record.velocity.end(), message.velocity);
  std::copy(record.wrench.begin(), record.wrench.end(), message.wrench);
  message.wrench_fresh = record.wrench_fresh ? 1 : 0;
  message.joint_count = static_cast<std::int8_t>(joint_count_);
  const auto end = static_cast<std::ptrdiff_t>(joint_count_);
  message.joint_position.assign(record.position.begin(), record.position.begin() + end);
  message.joint_commanded.assign(record.position_commanded.begin(),
                                 record.position_commanded.begin() + end);
  message.joints_fresh = static_cast<std::int32_t>(record.joints_fresh);
  message.wakeup_late_s = 1e-9 * static_cast<double>(record.wakeup_late_ns);
  message.compute_s = 1e-9 * static_cast<double>(record.compute_ns);
  message.late_cycles = static_cast<std::int32_t>(record.late_cycles);
  message.records_dropped = static_cast<std::int64_t>(recorder_.dropped());
  publish(kCycleChannel, message);
}

void Telemetry::publish_step(const CycleRecord& record, std::size_t index) {
  const StepReport& report = steps_->report(index);
  const GuardedMove::Result& result = report.result;
  tenon::step_event_t message{};
  message.utime = wall_clock_us();
  message.sequence = static_cast<std::int64_t>(index);
  message.monotonic_ns = record.time_ns;
  message.step = static_cast<std::int16_t>(report.step);
  message.outcome = static_cast<std::int8_t>(result.outcome);
  message.deviation = static_cast<std::int8_t>(report.transition.deviation);
  message.deviation_index = static_cast<std::int16_t>(report.transition.index);
  message.successor = static_cast<std::int16_t>(report.transition.successor);
  message.signature_before = static_cast<std::int16_t>(report.signature_before.bits);
  message.signature = static_cast<std::int16_t>(result.signature.bits);
  for (int axis = 0; axis < 6; ++axis) {
    message.commanded[axis] = report.commanded[axis];
    message.travelled[axis] = result.travelled[axis];
  }
  fill(data_of(result.pose), message.position_m, message.orientation_wxyz);
  message.decided_s = 1e-9 * static_cast<double>(result.decided_ns);
  message.duration_s = 1e-9 * static_cast<double>(result.duration_ns);
  message.peak_force_N = result.peak_force_N;
  publish(kStepChannel, message);
}

void Telemetry::publish_summary(const RunResult& result, const CycleRecord& last) {
  tenon::run_summary_t message{};
  message.utime = wall_clock_us();
  message.sequence = static_cast<std::int64_t>(result.statistics.cycles);
  message.monotonic_ns = last.time_ns;
  message.plan = result.task;
  message.start = result.start;
  message.end_reason = static_cast<std::int8_t>(result.reason);
  message.message = result.message;
  message.exit_code = static_cast<std::int8_t>(result.exit_code);
  message.steps = static_cast<std::int16_t>(result.steps.size());
  message.late_cycles = static_cast<std::int64_t>(result.statistics.late_cycles);
  message.incomplete_cycles = static_cast<std::int64_t>(result.statistics.incomplete_cycles);
  message.records_dropped = static_cast<std::int64_t>(result.records_dropped);
  message.peak_force_N = result.peak_force_N;
  message.wakeup_late_max_s = 1e-6 * result.statistics.wakeup.max_us();
  message.compute_max_s = 1e-6 * result.statistics.compute.max_us();
  publish(kRunChannel, message);
}

}  // namespace tenon::executor

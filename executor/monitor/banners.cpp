#include "executor/faults/fault_table.h"
#include "executor/monitor/blocks.h"
#include "executor/monitor/dashboard.h"
#include "executor/states/state_machine.h"
#include "shared/base/text.h"

namespace tenon::executor {
namespace {

constexpr double kBringUpMost_s = 20.0;

EndReason reason_of(int number) {
  return number >= 0 && number <= static_cast<int>(kLastEndReason) ? static_cast<EndReason>(number)
                                                                   : EndReason::kNone;
}

bool as_it_should(EndReason reason) {
  return reason == EndReason::kPlanDone || reason == EndReason::kMeasured;
}

Banner of_summary(const tenon::run_summary_t& summary) {
  if (summary.exit_code == 0) return {Style::kGoodBanner, "DONE: " + summary.message};
  if (reason_of(summary.end_reason) == EndReason::kStopRequested) {
    return {Style::kWarnBanner, "STOPPED: " + summary.message};
  }
  return {Style::kBadBanner, "FAILED: " + summary.message};
}

// While the arm still comes to rest.
Banner of_ending(const RunModel& model, EndReason reason, const char* state) {
  ArmFaultKind arm_fault = ArmFaultKind::kNone;
  int node = 0;
  if (model.status && reason == EndReason::kArmFault) {
    arm_fault = static_cast<ArmFaultKind>(model.status->message.arm_fault);
    node = model.status->message.arm_fault_node;
  }
  const FaultRow* row = fault_row(reason, arm_fault);
  std::string name = row == nullptr ? to_string(reason) : full_name(*row);
  if (node > 0) name += format(" at node %d", node);
  if (as_it_should(reason)) return {Style::kGoodBanner, "DONE: " + name + ", " + state};
  if (reason == EndReason::kStopRequested) {
    return {Style::kWarnBanner, "STOPPED on request, " + std::string(state)};
  }
  return {Style::kBadBanner, "FAULT " + name + ", " + state};
}

void add_waits(const RunModel& model, std::vector<Banner>& banners) {
  const tenon::run_status_t& status = model.status->message;
  if (status.slipped_joint >= 0) {
    banners.push_back({Style::kBadBanner,
                       format("BRAKE of joint %s does not hold: it moved by %.3g m or rad",
                              joint_name(model, status.slipped_joint).c_str(), status.slipped)});
  }
  if (status.bus_known != 0 && (status.bus_off != 0 || status.bus_up == 0)) {
    banners.push_back({Style::kBadBanner, status.bus_off != 0 ? "BUS OFF" : "BUS DOWN"});
  }
  if (model.summary) return;
  if (status.awaited_step >= 0) {
    banners.push_back(
        {Style::kWarnBanner, format("STEP %d WAITS for Enter in tenon-exec", status.awaited_step)});
  } else if (status.pace <= 0.0) {
    banners.push_back({Style::kWarnBanner, "PAUSED: r and Enter in tenon-exec goes on"});
  }
}

Banner before_cycles(const RunModel& model, const std::string& source, std::int64_t now_ns) {
  if (!model.setup) return {Style::kWarnBanner, "WAITING: nothing has come yet from " + source};
  const double age_s = RunModel::age_s(*model.setup, now_ns);
  const std::string text = format("BRING-UP: no cycle yet, announced %.1f s ago", age_s);
  return {age_s > kBringUpMost_s ? Style::kBadBanner : Style::kWarnBanner, text};
}

std::string live(const RunModel& model, const char* state) {
  std::string text = std::string("LIVE: ") + state;
  const int step = model.cycle->message.step;
  if (model.setup && step >= 0) {
    text += format(", step %d (%d of %d)", step, step + 1, model.setup->message.step_count);
  }
  return text;
}

}  // namespace

bool stale(const RunModel& model, bool source_ended, std::int64_t now_ns) {
  return !source_ended && model.cycle && !model.summary &&
         RunModel::age_s(*model.cycle, now_ns) > kStaleAfter_s;
}

std::vector<Banner> banners(const RunModel& model, const std::string& source, bool source_ended,
                            const std::string& source_lacks, std::int64_t now_ns) {
  std::vector<Banner> banners;
  if (model.summary) banners.push_back(of_summary(model.summary->message));
  const char* state = "";
  if (model.cycle) {
    state = to_string(static_cast<State>(model.cycle->message.state));
    const EndReason reason = reason_of(model.cycle->message.end_reason);
    if (!model.summary && reason != EndReason::kNone)
      banners.push_back(of_ending(model, reason, state));
  }
  if (stale(model, source_ended, now_ns)) {
    banners.push_back({Style::kBadBanner, format("STALE: no cycle for %.1f s; what is shown is old",
                                                 RunModel::age_s(*model.cycle, now_ns))});
  }
  if (model.status) add_waits(model, banners);
  if (source_ended) {
    banners.push_back(source_lacks.empty()
                          ? Banner{Style::kWarnBanner, "END of " + source}
                          : Banner{Style::kBadBanner, "END, not whole: " + source_lacks});
  } else if (!model.cycle && !model.summary) {
    banners.push_back(before_cycles(model, source, now_ns));
  }
  if (banners.empty()) banners.push_back({Style::kGoodBanner, live(model, state)});
  return banners;
}

}  // namespace tenon::executor

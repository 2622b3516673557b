#include "executor/telemetry/run_result.h"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "shared/base/text.h"

namespace tenon::executor {
namespace {

using Json = nlohmann::ordered_json;

constexpr const char* kOutputLost = "; standard output could not be written whole";

Json json_of(const Vector6& v) { return {v[0], v[1], v[2], v[3], v[4], v[5]}; }

Json json_of(const Histogram& histogram) {
  return {{"p50_us", histogram.percentile_us(0.5)},
          {"p99_us", histogram.percentile_us(0.99)},
          {"p999_us", histogram.percentile_us(0.999)},
          {"max_us", histogram.max_us()}};
}

Json json_of(const StepReport& report) {
  const GuardedMove::Result& result = report.result;
  const Vector3& p = result.pose.position_m;
  const Eigen::Quaterniond& q = result.pose.orientation;
  Json json = {{"step", report.step},
               {"commanded", json_of(report.commanded)},
               {"outcome", to_string(result.outcome)},
               {"deviation", describe(report.transition)},
               {"travelled", json_of(result.travelled)},
               {"signature_before", tenon::to_string(report.signature_before)},
               {"signature", tenon::to_string(result.signature)},
               {"position_m", {p.x(), p.y(), p.z()}},
               {"orientation_wxyz", {q.w(), q.x(), q.y(), q.z()}},
               {"peak_force_N", result.peak_force_N},
               {"decided_s", 1e-9 * static_cast<double>(result.decided_ns)},
               {"duration_s", 1e-9 * static_cast<double>(result.duration_ns)}};
  const Successor next = report.transition.successor;
  if (next == kSuccessorDone) {
    json["next"] = "done";
  } else if (next == kSuccessorFail) {
    json["next"] = "fail";
  } else {
    json["next"] = next;
  }
  return json;
}

// "+x 0.100 m", or "(0.1, 0.05, 0) m" where more than one axis moves.
std::string displacement_text(const Vector6& displacement) {
  int moving = 0;
  int last = 0;
  for (int axis = 0; axis < 6; ++axis) {
    if (displacement[axis] == 0.0) continue;
    ++moving;
    last = axis;
  }
  if (moving == 1) {
    const double way = displacement[last];
    return format("%c%s %.3f %s", way < 0.0 ? '-' : '+', axis_name(last), std::abs(way),
                  axis_unit(last));
  }
  std::string all =
      format("(%.3f, %.3f, %.3f) m", displacement[0], displacement[1], displacement[2]);
  if (!displacement.tail<3>().isZero(0.0)) {
    all += format(" (%.3f, %.3f, %.3f) rad", displacement[3], displacement[4], displacement[5]);
  }
  return all;
}

Json json_of(const Finding& finding) {
  Json json = {{"status", finding.status}};
  for (const auto& [name, values] : finding.values) {
    json[name] = values.size() == 1 ? Json(values.front()) : Json(values);
  }
  return json;
}

Json json_of(const BrakeSlip& slip, const Cell& cell) {
  if (slip.joint < 0) return nullptr;
  return {{"joint", cell.robot.joints[static_cast<std::size_t>(slip.joint)].name},
          {"moved", slip.moved},
          {"bound", slip.bound}};
}

Json json_of(const RecordReport& report) {
  return {{"name", report.name},
          {"file", report.file},
          {"written", report.written},
          {"lost", report.lost},
          {"reason", report.reason}};
}

Json json_of(const CanBusStatus& bus) {
  return {{"sent", bus.sent},
          {"received", bus.received},
          {"send_failures", bus.send_failures},
          {"malformed", bus.malformed},
          {"error_frames", bus.error_frames},
          {"overruns", bus.overruns}};
}

const char* name_of(Hold hold) {
  switch (hold) {
    case Hold::kNone:
      return "none";
    case Hold::kHeld:
      return "held";
    case Hold::kLost:
      return "lost";
    case Hold::kRefused:
      return "refused";
  }
  return "?";
}

// What a run of a plan and an identification have in common. @param plan whose names messages use
RunResult common_result(const ControlTask& task, const Plan& plan, const CycleRunner& runner,
                        std::uint64_t records_dropped, const std::string& arm_fault_text) {
  const Ending& ending = task.ending();
  RunResult result;
  result.reason = ending.reason;
  result.arm_fault = ending.arm_fault.kind;
  result.message = describe(ending, plan, task.cell(), arm_fault_text);
  result.disable_confirmed = task.finished() && ending.disable_confirmed;
  result.slip = ending.slip;
  result.hold = ending.hold;
  result.brakes_unwatched = ending.brakes_unwatched;
  result.statistics = runner.statistics();
  result.records_dropped = records_dropped;
  result.cycle_s = task.cycle_s();
  result.duration_s = result.cycle_s * static_cast<double>(result.statistics.cycles);
  result.blind_cycles = task.blind_cycles();
  result.peak_force_N = task.peak_force_N();
  result.peak_torque_Nm = task.peak_torque_Nm();
  return result;
}

// A loop that wakes up later than the plan's latency allows sees contacts, and their end, too late:
// what follows is no fault of the plan or the parts. Empty where it never did.
std::string lateness(const Plan& plan, const Cell& cell, const CycleRunner::Statistics& loop) {
  const double late_ms = 1e-3 * loop.wakeup.max_us();
  const double allowed_ms =
      std::max(1e-3 * cell.robot.cycle_us, 1e3 * (plan.latency_max_s - latency_s(cell.robot)));
  if (late_ms <= allowed_ms) return {};
  return format("; the loop woke up %.3g ms late, where the plan allows %.3g ms: that may be why",
                late_ms, allowed_ms);
}

// The drives have the last word.
void conclude(RunResult& result, const ControlTask& task, bool success) {
  const bool named = result.reason == EndReason::kNotDisabled;
  if (task.finished() && !task.ending().disable_confirmed && !named) {
    result.message += "; the arm did not confirm that it is disabled";
  }
  const bool brakes_seen = result.slip.joint < 0 && result.brakes_unwatched == 0;
  result.exit_code = success && result.disable_confirmed && brakes_seen ? 0 : 1;
}

/// What the arm's fault ended, the run or its being held. Null: nothing.
const FaultRow* arms_part(const RunResult& result) {
  const bool ended_it = result.reason == EndReason::kArmFault || result.hold == Hold::kLost ||
                        result.hold == Hold::kRefused;
  return ended_it ? fault_row(EndReason::kArmFault, result.arm_fault) : nullptr;
}

}  // namespace

bool RunResult::ended_badly() const {
  const bool orderly = reason == EndReason::kMeasured || reason == EndReason::kNothingMet;
  const bool in_its_brakes = disable_confirmed && slip.joint < 0 && brakes_unwatched == 0;
  return exit_code != 0 && reason != EndReason::kStopRequested && !(orderly && in_its_brakes);
}

int RunResult::exit_status() const {
  const bool whole = std::all_of(records.begin(), records.end(),
                                 [](const RecordReport& report) { return report.whole(); });
  return exit_code == 0 && (!whole || output_lost) ? 1 : exit_code;
}

std::string RunResult::losses() const {
  std::vector<std::string> all;
  for (const RecordReport& report : records) {
    if (!report.whole()) all.push_back(loss_text(report));
  }
  const auto tell = [&](std::uint64_t count, const char* what) {
    if (count > 0) all.push_back(std::to_string(count) + " " + what);
  };
  tell(unpublished, "messages not published");
  tell(bus.send_failures, "CAN frames not sent");
  tell(bus.overruns, "CAN frames lost on receiving");
  std::string text;
  for (const std::string& one : all) text += (text.empty() ? "" : "; ") + one;
  return text;
}

RunResult gather_result(const Controller& controller, const CycleRunner& runner,
                        std::uint64_t records_dropped, const std::string& arm_fault_text) {
  const Plan& plan = controller.plan();
  RunResult result = common_result(controller, plan, runner, records_dropped, arm_fault_text);
  result.task = plan.task_name;
  result.start = plan.start_name;
  if (result.reason == EndReason::kPlanFailed || result.reason == EndReason::kNotAtGoal) {
    result.message += lateness(plan, controller.cell(), result.statistics);
  }
  for (std::size_t i = 0; i < controller.runner().report_count(); ++i) {
    result.steps.push_back(controller.runner().report(i));
  }
  conclude(result, controller, result.reason == EndReason::kPlanDone);
  return result;
}

RunResult gather_result(const ControlTask& task, const std::optional<Finding>& finding,
                        const CycleRunner& runner, std::uint64_t records_dropped,
                        const std::string& arm_fault_text) {
  RunResult result = common_result(task, Plan{}, runner, records_dropped, arm_fault_text);
  result.finding = finding;
  if (finding) result.message = finding->report.substr(0, finding->report.find('\n'));
  conclude(result, task, finding && finding->found);
  return result;
}

std::string to_json(const RunResult& result, const Cell& cell) {
  Json json = {{"status", result.exit_code == 0 ? "done" : "failed"},
               {"reason", to_string(result.reason)},
               {"message", result.message + (result.output_lost ? kOutputLost : "")},
               {"exit_code", result.exit_status()},
               {"disable_confirmed", result.disable_confirmed},
               {"task", result.task},
               {"start", result.start},
               {"cell", cell.name},
               {"robot", cell.robot.name},
               {"duration_s", result.duration_s},
               {"peak_force_N", result.peak_force_N},
               {"peak_torque_Nm", result.peak_torque_Nm}};
  if (const FaultRow* fault = arms_part(result)) json["arm_fault"] = fault->arm_fault_name;
  json["brake_slip"] = json_of(result.slip, cell);
  json["hold"] = name_of(result.hold);
  json["brakes_unwatched"] = Json::array();
  for (std::size_t i = 0; i < cell.robot.joints.size(); ++i) {
    if ((result.brakes_unwatched >> i & 1U) != 0) {
      json["brakes_unwatched"].push_back(cell.robot.joints[i].name);
    }
  }
  json["steps"] = Json::array();
  for (const StepReport& report : result.steps) json["steps"].push_back(json_of(report));
  if (result.finding) json["finding"] = json_of(*result.finding);
  json["cycle"] = {{"period_s", result.cycle_s},
                   {"cycles", result.statistics.cycles},
                   {"late_cycles", result.statistics.late_cycles},
                   {"incomplete_cycles", result.statistics.incomplete_cycles},
                   {"blind_cycles", result.blind_cycles},
                   {"wakeup_late", json_of(result.statistics.wakeup)},
                   {"compute", json_of(result.statistics.compute)},
                   {"records_dropped", result.records_dropped}};
  json["arm"] = Json::object();
  for (const auto& [name, count] : result.arm_counters) json["arm"][name] = count;
  json["bus"] = json_of(result.bus);
  json["unpublished"] = result.unpublished;
  json["records"] = Json::array();
  for (const RecordReport& report : result.records) json["records"].push_back(json_of(report));
  return json.dump(2) + "\n";
}

std::string step_line(const StepReport& report) {
  const GuardedMove::Result& result = report.result;
  const double way_m = result.travelled.head<3>().norm();
  std::string line =
      format("step %2d: %s -> %s (holds %s) after %.4f m, %.1f N, %.2f s",
             static_cast<int>(report.step), displacement_text(report.commanded).c_str(),
             to_string(result.outcome), tenon::to_string(result.signature).c_str(), way_m,
             result.peak_force_N, 1e-9 * static_cast<double>(result.duration_ns));
  if (report.transition.deviation != Deviation::kNone) line += "; " + describe(report.transition);
  return line;
}

std::string waiting_line(const CycleRecord& record, const Plan& plan) {
  const auto step = static_cast<std::size_t>(record.awaited_step);
  return format("step %2d waits: %s; Enter runs it, Ctrl-C stops", record.awaited_step,
                displacement_text(plan.steps[step].displacement).c_str());
}

std::string hold_line(const CycleRecord& record, const Cell& cell,
                      const std::string& arm_fault_text) {
  if (record.hold == Hold::kNone) return {};
  if (record.hold == Hold::kHeld) {
    return describe(record.slip, cell) +
           "; it is held under power: support it, then stop this program (Ctrl-C)";
  }
  return describe(record.slip, cell) + "; it was " +
         describe(record.hold, record.arm_fault, arm_fault_text);
}

}  // namespace tenon::executor

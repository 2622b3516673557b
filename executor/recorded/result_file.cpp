#include "executor/recorded/result_file.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <nlohmann/json.hpp>
#include <utility>
#include <vector>

#include "executor/recorded/named.h"
#include "shared/base/error.h"
#include "shared/base/printable.h"
#include "shared/base/text.h"

namespace tenon::executor {
namespace {

using Json = nlohmann::json;

/// The values of a result by key. What is not there, or of another kind, is refused by name.
class Keys {
 public:
  Keys(const std::string& file, const Json& json, std::string where)
      : file_(file), json_(json), where_(std::move(where)) {
    if (!json_.is_object()) refuse("", "must be an object");
  }

  [[nodiscard]] const Json& at(const char* key) const {
    if (!json_.contains(key)) refuse(key, "is missing");
    return json_[key];
  }
  [[nodiscard]] std::string text(const char* key) const {
    if (!at(key).is_string()) refuse(key, "must be a text");
    return printable(at(key).get<std::string>());
  }
  [[nodiscard]] double number(const char* key) const { return number(key, at(key)); }
  [[nodiscard]] std::uint64_t count(const char* key) const {
    if (!at(key).is_number_unsigned()) refuse(key, "must be a count");
    return at(key).get<std::uint64_t>();
  }
  [[nodiscard]] const Json& list(const char* key) const {
    if (!at(key).is_array()) refuse(key, "must be a list");
    return at(key);
  }
  [[nodiscard]] std::vector<double> numbers(const char* key, std::size_t size) const {
    if (list(key).size() != size) refuse(key, format("must have %zu numbers", size));
    std::vector<double> values;
    for (const Json& value : at(key)) values.push_back(number(key, value));
    return values;
  }
  [[nodiscard]] Keys object(const char* key) const { return {file_, at(key), where_ + key + '.'}; }
  [[nodiscard]] const std::string& file() const { return file_; }
  [[noreturn]] void refuse(const std::string& key, const std::string& what) const {
    throw InputError(file_ + ": " + where_ + key + " " + what +
                     "; give the file that tenon-exec wrote with --json");
  }

 private:
  [[nodiscard]] double number(const char* key, const Json& value) const {
    if (!value.is_number() || !std::isfinite(value.get<double>())) refuse(key, "must be a number");
    return value.get<double>();
  }

  const std::string& file_;
  const Json& json_;
  std::string where_;
};

Outcome outcome_of(const Keys& keys) {
  const std::string name = keys.text("outcome");
  const auto* found = std::find_if(kOutcomes.begin(), kOutcomes.end(),
                                   [&](Outcome outcome) { return name == to_string(outcome); });
  if (found == kOutcomes.end()) keys.refuse("outcome", "= " + name + " is no outcome of a move");
  return *found;
}

Successor successor_of(const Keys& keys) {
  const Json& next = keys.at("next");
  if (next == "done") return kSuccessorDone;
  if (next == "fail") return kSuccessorFail;
  const std::uint64_t step = keys.count("next");
  if (step >= kMaxSteps) keys.refuse("next", "must be a step, done or fail");
  return static_cast<Successor>(step);
}

Pose pose_of(const Keys& keys) {
  const std::vector<double> p = keys.numbers("position_m", 3);
  const std::vector<double> q = keys.numbers("orientation_wxyz", 4);
  const Vector3 position_m(p.data());
  const Eigen::Quaterniond orientation(q[0], q[1], q[2], q[3]);
  if (!is_pose(Vector3::Zero(), orientation)) {
    keys.refuse("orientation_wxyz", "must be a unit quaternion");
  }
  if (!is_pose(position_m, orientation)) keys.refuse("position_m", "is where no tool can be");
  return {position_m, orientation.normalized()};
}

RecordedStep step_of(const Keys& keys, const Plan& plan) {
  RecordedStep step;
  step.step = keys.count("step");
  if (step.step >= plan.steps.size()) {
    keys.refuse("step", format("= %zu, the plan has %zu steps: it is of another plan", step.step,
                               plan.steps.size()));
  }
  step.outcome = outcome_of(keys);
  step.deviation = keys.text("deviation");
  if (step.deviation == "as planned") step.deviation.clear();
  step.successor = successor_of(keys);
  step.signature = keys.text("signature");
  step.travelled = Vector6(keys.numbers("travelled", 6).data());
  step.tool = pose_of(keys);
  step.duration_s = keys.number("duration_s");
  step.peak_force_N = keys.number("peak_force_N");
  return step;
}

/// The way on that the plan has from a step's outcome must be the one that was taken.
void check_way(const std::string& file, const RecordedStep& step, const Plan& plan) {
  const Successor planned = plan.steps[step.step].rule(step.outcome).successor;
  if (step.successor == kSuccessorFail || step.successor == planned) return;
  throw InputError(
      format("%s: is of another plan of '%s': step %zu went on after %s, where the "
             "plan given goes another way; give the plan that was executed",
             file.c_str(), plan.task_name.c_str(), step.step, to_string(step.outcome)));
}

void take_cycles(const Keys& cycle, RecordedRun& run) {
  run.cycles = cycle.count("cycles");
  run.late_cycles = cycle.count("late_cycles");
  run.incomplete_cycles = cycle.count("incomplete_cycles");
  run.records_dropped = cycle.count("records_dropped");
  run.wakeup_late_max_s = 1e-6 * cycle.object("wakeup_late").number("max_us");
  run.compute_max_s = 1e-6 * cycle.object("compute").number("max_us");
}

void take_losses(const Keys& keys, RecordedRun& run) {
  for (const Json& entry : keys.list("records")) {
    const Keys record(keys.file(), entry, "records: ");
    if (record.count("lost") == 0) continue;
    run.notes.push_back(format("%llu records of %s are lost: ",
                               static_cast<unsigned long long>(record.count("lost")),
                               record.text("file").c_str()) +
                        record.text("reason") + ".");
  }
}

}  // namespace

RecordedRun read_run_result(const std::string& name, const std::string& text, const Plan& plan) {
  const Json json = Json::parse(text, nullptr, false);
  if (json.is_discarded()) {
    throw InputError(name + ": is no whole JSON; give the file that tenon-exec wrote with --json");
  }
  const Keys keys(name, json, "");
  check_named(name, keys.text("task"), keys.text("start"), plan);
  RecordedRun run;
  run.cell = keys.text("cell");
  run.robot = keys.text("robot");
  run.message = keys.text("message");
  run.ended = true;
  run.done = keys.text("status") == "done";
  run.duration_s = keys.number("duration_s");
  run.peak_force_N = keys.number("peak_force_N");
  for (const Json& entry : keys.list("steps")) {
    run.steps.push_back(step_of(Keys(name, entry, format("steps[%zu].", run.steps.size())), plan));
    check_way(name, run.steps.back(), plan);
    if (run.steps.back().deviation.empty()) continue;
    run.faults.push_back(
        {std::nullopt, format("step %zu: ", run.steps.back().step) + run.steps.back().deviation});
  }
  take_cycles(keys.object("cycle"), run);
  take_losses(keys, run);
  const std::string reason = keys.text("reason");
  if (!run.done && reason != "stop_requested" && run.faults.empty()) {
    run.faults.push_back({std::nullopt, run.message});
  }
  return run;
}

RecordedRun joined(RecordedRun log, const RecordedRun& result, const std::string& log_name,
                   const std::string& result_name) {
  const auto differ = [&](const std::string& what) {
    throw InputError(result_name + ": is of another run than " + log_name + ": " + what);
  };
  const bool whole = log.ended;
  if (!whole) {
    log.faults.insert(log.faults.end(), result.faults.begin(), result.faults.end());
  }
  if (log.steps.size() > result.steps.size() ||
      (whole && log.steps.size() != result.steps.size())) {
    differ(format("%zu steps, the log has %zu", result.steps.size(), log.steps.size()));
  }
  for (std::size_t i = 0; i < log.steps.size(); ++i) {
    const RecordedStep& a = log.steps[i];
    const RecordedStep& b = result.steps[i];
    constexpr double kSame = 1e-9;
    const bool same = a.step == b.step && a.outcome == b.outcome &&
                      std::abs(a.duration_s - b.duration_s) < kSame &&
                      (a.travelled - b.travelled).norm() < kSame;
    if (!same) differ(format("its step %zu ended elsewhere", b.step));
  }
  log.message = result.message;
  log.done = result.done;
  log.ended = true;
  log.peak_force_N = result.peak_force_N;
  log.cycles = result.cycles;
  log.late_cycles = result.late_cycles;
  log.incomplete_cycles = result.incomplete_cycles;
  log.notes.insert(log.notes.end(), result.notes.begin(), result.notes.end());
  return log;
}

}  // namespace tenon::executor

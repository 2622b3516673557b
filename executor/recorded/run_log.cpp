#include "executor/recorded/run_log.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>
#include <vector>

#include "executor/record/channels.h"
#include "executor/recorded/known.h"
#include "executor/recorded/named.h"
#include "executor/states/ending.h"
#include "executor/states/state_machine.h"
#include "lcmtypes/received/received.h"
#include "lcmtypes/tenon/cycle_state_t.hpp"
#include "lcmtypes/tenon/run_setup_t.hpp"
#include "lcmtypes/tenon/run_status_t.hpp"
#include "lcmtypes/tenon/run_summary_t.hpp"
#include "lcmtypes/tenon/step_event_t.hpp"
#include "shared/base/error.h"
#include "shared/base/printable.h"
#include "shared/base/text.h"

namespace tenon::executor {
namespace {

// Two and a half hours at 500 Hz.
constexpr std::size_t kCyclesMax = 4'500'000;

/// Unknown where it is no pose.
std::array<float, 7> floats_of(const double (&position_m)[3], const double (&wxyz)[4]) {
  std::array<float, 7> pose = RecordedCycle::unknown<7>();
  const Eigen::Quaterniond q(wxyz[0], wxyz[1], wxyz[2], wxyz[3]);
  if (!is_pose(Vector3(position_m), q)) return pose;
  const Eigen::Quaterniond unit = q.normalized();
  for (std::size_t i = 0; i < 3; ++i) pose.at(i) = static_cast<float>(position_m[i]);
  pose[3] = static_cast<float>(unit.w());
  pose[4] = static_cast<float>(unit.x());
  pose[5] = static_cast<float>(unit.y());
  pose[6] = static_cast<float>(unit.z());
  return pose;
}

void copy_joints(const std::vector<double>& from, std::array<float, kMaxJoints>& to) {
  to.fill(RecordedCycle::kUnknown);
  for (std::size_t i = 0; i < std::min(from.size(), kMaxJoints); ++i) {
    to.at(i) = static_cast<float>(from[i]);
  }
}

/// What the message does not say stands in the plan.
Transition with_travel(Transition transition, const double (&travelled)[6], const Envelope& seen) {
  const int axis = transition.index;
  if (transition.deviation != Deviation::kTravelOutside || axis < 0 || axis >= 6) return transition;
  transition.travelled = travelled[axis];
  transition.travelled_min = seen.travelled_min[axis];
  transition.travelled_max = seen.travelled_max[axis];
  return transition;
}

std::uint64_t counted(std::int64_t value) {
  return static_cast<std::uint64_t>(std::max<std::int64_t>(value, 0));
}

}  // namespace

RecordedRun read_run_log(const std::filesystem::path& file, const Plan& plan) {
  EventFile events(file);
  RunLog log(file.string(), plan);
  while (const std::optional<LoggedEvent> event = events.next()) log.take(*event);
  return log.finish(events.breaks_off());
}

void RunLog::take(const LoggedEvent& event) {
  if (event.channel == kCycleChannel) take_message<tenon::cycle_state_t>(event);
  if (event.channel == kSetupChannel) take_message<tenon::run_setup_t>(event);
  if (event.channel == kStatusChannel) take_message<tenon::run_status_t>(event);
  if (event.channel == kStepChannel) take_message<tenon::step_event_t>(event);
  if (event.channel == kRunChannel) take_message<tenon::run_summary_t>(event);
}

template <typename Message>
void RunLog::take_message(const LoggedEvent& event) {
  if (const std::optional<Message> message = decoded<Message>(event.message)) {
    take(*message);
  } else {
    ++malformed_;
  }
}

void RunLog::begin_anew() {
  run_ = {};
  seen_ = {};
  ++runs_;
}

double RunLog::since_start_s(std::int64_t monotonic_ns) const {
  if (!seen_.start_ns) return 0.0;
  return std::max(
      0.0, 1e-9 * (static_cast<double>(monotonic_ns) - static_cast<double>(*seen_.start_ns)));
}

void RunLog::check_plan(const tenon::run_setup_t& m) const {
  check_named(name_, m.plan, m.start, plan_);
  const auto other = [&](const std::string& what) {
    throw InputError(name_ + ": is of another plan of '" + plan_.task_name + "': " + what +
                     "; give the plan that was executed");
  };
  const std::size_t count = plan_.steps.size();
  if (m.displacement.size() != count) {
    other(format("%zu steps, the plan has %zu", m.displacement.size(), count));
  }
  for (std::size_t i = 0; i < count; ++i) {
    const Step& step = plan_.steps[i];
    const Vector6 told(m.displacement[i].data());
    const ContactThresholds& thresholds = plan_.parameter_sets[step.parameter_set].thresholds;
    if (told != step.displacement) other(format("step %zu goes another way", i));
    if (m.force_on_N[i] != thresholds.force_on_N) {
      other(format("step %zu has a contact from %g N, the plan's from %g N", i, m.force_on_N[i],
                   thresholds.force_on_N));
    }
  }
}

void RunLog::take(const tenon::run_setup_t& m) {
  if (m.sequence == 0 && !run_.samples.empty()) begin_anew();
  if (seen_.setup) return;
  check_plan(m);
  seen_.setup = true;
  run_.cell = printable(m.cell);
  run_.robot = printable(m.robot);
  run_.limits = {m.cycle_s, m.force_fault_N, m.torque_fault_Nm, m.bus_load_most};
  run_.joints = joints_of(m);
}

void RunLog::take(const tenon::cycle_state_t& m) {
  if (m.step < -1 || m.step >= static_cast<int>(plan_.steps.size())) {
    ++malformed_;
    return;
  }
  if (m.sequence <= seen_.sequence && !run_.samples.empty()) {
    // A message that the network has brought twice, or late, is no new run.
    if (m.sequence != 0) return;
    begin_anew();
  }
  if (!seen_.start_ns) seen_.start_ns = m.monotonic_ns;
  seen_.sequence = m.sequence;
  RecordedCycle cycle;
  cycle.time_s = since_start_s(m.monotonic_ns);
  if (!run_.samples.empty() && cycle.time_s <= run_.samples.back().time_s) return;
  if (run_.samples.size() == kCyclesMax) {
    throw InputError(
        format("%s: holds a run of more than %zu cycles, which are too many for a page",
               name_.c_str(), kCyclesMax));
  }
  const auto state = static_cast<State>(m.state);
  cycle.step = m.step;
  cycle.signature = static_cast<std::uint16_t>(m.signature);
  if (knows_joints(state)) cycle.tool = floats_of(m.pose_position_m, m.pose_orientation_wxyz);
  if (commands(state)) {
    cycle.commanded = floats_of(m.commanded_position_m, m.commanded_orientation_wxyz);
  }
  for (std::size_t i = 0; knows_forces(state) && i < 6; ++i) {
    cycle.wrench.at(i) = static_cast<float>(m.wrench[i]);
  }
  copy_joints(knows_joints(state) ? m.joint_position : std::vector<double>{}, cycle.joints);
  copy_joints(commands(state) ? m.joint_commanded : std::vector<double>{}, cycle.commanded_joints);
  cycle.wakeup_late_s = static_cast<float>(m.wakeup_late_s);
  cycle.compute_s = static_cast<float>(m.compute_s);
  cycle.late_cycles = m.late_cycles;
  run_.records_dropped = counted(m.records_dropped);
  follow_state(m, cycle.time_s);
  run_.samples.push_back(cycle);
}

void RunLog::follow_state(const tenon::cycle_state_t& m, double time_s) {
  if (m.state != seen_.state) {
    seen_.state = m.state;
    run_.states.push_back({time_s, to_string(static_cast<State>(m.state))});
  }
  if (seen_.reason == EndReason::kNone && m.end_reason != 0) {
    seen_.reason = static_cast<EndReason>(m.end_reason);
    seen_.ended_s = time_s;
  }
}

void RunLog::take(const tenon::run_status_t& m) {
  const double time_s = since_start_s(m.monotonic_ns);
  if (m.bus_known != 0) {
    run_.bus.push_back({time_s, m.bus_load, m.bus_load_worst});
    const bool bad = m.bus_up == 0 || m.bus_off != 0 || m.error_passive != 0;
    if (bad && !seen_.bus_bad) {
      add_fault(time_s, m.bus_up == 0    ? "the bus is down"
                        : m.bus_off != 0 ? "the bus is off: its controller has given up"
                                         : "the bus is error passive: frames are not acknowledged");
    }
    seen_.bus_bad = bad;
  }
  if (m.slipped_joint >= 0 && seen_.slipped_joint < 0) {
    seen_.slipped_joint = m.slipped_joint;
    const auto joint = static_cast<std::size_t>(static_cast<std::uint8_t>(m.slipped_joint));
    const bool named = joint < run_.joints.size();
    const std::string name = named ? run_.joints[joint].name : std::to_string(joint);
    add_fault(time_s,
              format("the brake of joint %s does not hold: it moved by %.3g %s", name.c_str(),
                     m.slipped, named && run_.joints[joint].linear ? "m" : "rad"));
  }
  seen_.arm_fault = m.arm_fault;
}

void RunLog::take(const tenon::step_event_t& m) {
  const double* q = m.orientation_wxyz;
  const Eigen::Quaterniond orientation(q[0], q[1], q[2], q[3]);
  const bool sound = Vector6(m.travelled).allFinite() &&
                     is_pose(Vector3(m.position_m), orientation) && std::isfinite(m.duration_s) &&
                     std::isfinite(m.peak_force_N);
  if (m.step < 0 || m.step >= static_cast<int>(plan_.steps.size()) || m.outcome < 0 ||
      m.outcome >= static_cast<int>(kOutcomes.size()) || !sound) {
    ++malformed_;
    return;
  }
  // A log of lcm-logger may have some twice.
  if (m.sequence != static_cast<std::int64_t>(run_.steps.size())) return;
  RecordedStep step;
  step.step = static_cast<std::size_t>(m.step);
  step.outcome = static_cast<Outcome>(m.outcome);
  step.successor = static_cast<Successor>(m.successor);
  if (m.deviation > 0 && m.deviation <= static_cast<int>(Deviation::kPlaceOutside)) {
    const int index = m.deviation_index < ContactSignature::kBits ? m.deviation_index : -1;
    const auto deviation = static_cast<Deviation>(m.deviation);
    step.deviation = describe(with_travel({step.successor, deviation, index}, m.travelled,
                                          plan_.steps[step.step].rule(step.outcome).envelope));
    add_fault(since_start_s(m.monotonic_ns), format("step %d: ", m.step) + step.deviation);
  }
  step.signature = tenon::to_string(ContactSignature{static_cast<std::uint16_t>(m.signature)});
  step.travelled = Vector6(m.travelled);
  step.tool.position_m = Vector3(m.position_m);
  step.tool.orientation = orientation.normalized();
  step.duration_s = m.duration_s;
  step.peak_force_N = m.peak_force_N;
  run_.steps.push_back(std::move(step));
}

void RunLog::take(const tenon::run_summary_t& m) {
  if (run_.samples.empty()) return;
  check_named(name_, m.plan, m.start, plan_);
  run_.ended = true;
  run_.done = m.exit_code == 0;
  run_.message = printable(m.message);
  run_.peak_force_N = m.peak_force_N;
  run_.incomplete_cycles = counted(m.incomplete_cycles);
  run_.records_dropped = counted(m.records_dropped);
  run_.wakeup_late_max_s = m.wakeup_late_max_s;
  run_.compute_max_s = m.compute_max_s;
}

void RunLog::note_what_is_missing(bool breaks_off) {
  const auto note = [&](const std::string& text) { run_.notes.push_back(text); };
  if (runs_ > 1) {
    note(format("The log holds %llu runs; this is the last.",
                static_cast<unsigned long long>(runs_)));
  }
  if (!run_.ended) {
    note(format("The log %s after %.2f s: how the run went on is not in it.",
                breaks_off ? "breaks off within a message" : "ends before the run does",
                run_.duration_s));
  }
  if (!seen_.setup) {
    note(
        "The log does not say what the run was measured by, nor which plan it was beyond its "
        "name.");
  }
  if (run_.records_dropped > 0) {
    note(format("%llu cycles are not in the log: telemetry did not keep up.",
                static_cast<unsigned long long>(run_.records_dropped)));
  }
  if (malformed_ > 0) {
    note(format("%llu messages of the log make no sense and are left out.",
                static_cast<unsigned long long>(malformed_)));
  }
}

RecordedRun RunLog::finish(bool breaks_off) {
  if (run_.samples.empty()) {
    throw InputError(name_ +
                     ": holds no cycle of a run; give the file that tenon-exec wrote with --log");
  }
  run_.cycles = run_.samples.size();
  run_.duration_s = run_.samples.back().time_s;
  run_.late_cycles = counted(run_.samples.back().late_cycles);
  for (const RecordedCycle& cycle : run_.samples) {
    run_.wakeup_late_max_s = std::max<double>(run_.wakeup_late_max_s, cycle.wakeup_late_s);
    run_.compute_max_s = std::max<double>(run_.compute_max_s, cycle.compute_s);
  }
  if (is_fault(seen_.reason)) {
    const std::string text = run_.message.empty()
                                 ? named(seen_.reason, static_cast<std::uint8_t>(seen_.arm_fault))
                                 : run_.message;
    // A step that went another way than planned has told it already.
    const bool told = std::any_of(run_.faults.begin(), run_.faults.end(),
                                  [&](const RecordedFault& fault) { return fault.text == text; });
    if (!told) add_fault(seen_.ended_s, text);
  }
  std::stable_sort(
      run_.faults.begin(), run_.faults.end(),
      [](const RecordedFault& a, const RecordedFault& b) { return a.time_s < b.time_s; });
  note_what_is_missing(breaks_off);
  return std::move(run_);
}

}  // namespace tenon::executor

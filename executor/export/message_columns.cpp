#include "executor/export/message_columns.h"

#include <algorithm>
#include <array>

#include "executor/faults/fault_table.h"
#include "executor/states/ending.h"
#include "shared/base/printable.h"
#include "shared/base/text.h"
#include "shared/motion/contact_signature.h"
#include "shared/motion/outcome.h"
#include "shared/plan/transition.h"

namespace tenon::executor {
namespace {

using Step = tenon::step_event_t;
using Status = tenon::run_status_t;
using Setup = tenon::run_setup_t;
using Summary = tenon::run_summary_t;

std::string contacts_text(std::int16_t bits) {
  return to_string(ContactSignature{static_cast<std::uint16_t>(bits)});
}

std::string next_text(int successor) {
  if (successor == kSuccessorDone) return "done";
  if (successor == kSuccessorFail) return "fail";
  return std::to_string(successor);
}

/// A field of a message as a number, a count, a truth or a text.
template <typename Message, typename Field>
auto get(Field Message::*field) {
  return [field](const Message& m) -> Value { return m.*field; };
}
template <typename Message, typename Field>
auto get_count(Field Message::*field) {
  return [field](const Message& m) -> Value { return std::int64_t{m.*field}; };
}
template <typename Message, typename Field>
auto get_truth(Field Message::*field) {
  return [field](const Message& m) -> Value { return m.*field != 0; };
}
template <typename Message>
auto get_text(std::string Message::*field) {
  return [field](const Message& m) -> Value { return printable(m.*field); };
}

/// As get() and its like, of a bus that the message knows.
template <typename Get>
auto of_bus(Get get_of) {
  return [get_of](const Status& m) -> Value { return m.bus_known != 0 ? get_of(m) : Value{}; };
}

void add_six(Columns<Step>& columns, const std::string& name, const std::string& meaning,
             double (Step::*field)[6]) {
  for (std::size_t i = 0; i < 6; ++i) {
    columns.number(name + '_' + axis_key(static_cast<int>(i)), meaning,
                   [=](const Step& m) -> Value { return (m.*field)[i]; });
  }
}

}  // namespace

const char* outcome_text(int outcome) {
  if (outcome < 0 || outcome >= static_cast<int>(kOutcomes.size())) return "?";
  return to_string(static_cast<Outcome>(outcome));
}

std::string deviation_text(const Step& m) {
  if (m.deviation <= 0 || m.deviation > static_cast<int>(Deviation::kPlaceOutside)) return {};
  const int index = m.deviation_index < ContactSignature::kBits ? m.deviation_index : -1;
  return describe(
      {static_cast<Successor>(m.successor), static_cast<Deviation>(m.deviation), index});
}

Columns<tenon::step_event_t> step_columns() {
  Columns<Step> columns;
  columns.count("step", "that has ended", get_count(&Step::step));
  columns.text("outcome", "that ended it",
               [](const Step& m) -> Value { return std::string(outcome_text(m.outcome)); });
  columns.count("outcome_number", "the same as a number", get_count(&Step::outcome));
  columns.text("deviation", "from the plan; none where it went as planned",
               [](const Step& m) -> Value {
                 const std::string text = deviation_text(m);
                 return text.empty() ? Value{} : Value{text};
               });
  columns.text("next", "step, done or fail",
               [](const Step& m) -> Value { return next_text(m.successor); });
  columns.text("contacts_before", "that it began with",
               [](const Step& m) -> Value { return contacts_text(m.signature_before); });
  columns.text("contacts", "that it settled with",
               [](const Step& m) -> Value { return contacts_text(m.signature); });
  add_six(columns, "commanded", "displacement, task axes", &Step::commanded);
  add_six(columns, "travelled", "displacement, task axes", &Step::travelled);
  for (std::size_t i = 0; i < 3; ++i) {
    columns.number("tool_" + axis_key(static_cast<int>(i)), "settled, in the task frame",
                   [i](const Step& m) -> Value { return m.position_m[i]; });
  }
  for (std::size_t i = 0; i < 4; ++i) {
    columns.number(std::string("tool_q") + "wxyz"[i], "settled, in the task frame, quaternion",
                   [i](const Step& m) -> Value { return m.orientation_wxyz[i]; });
  }
  columns.number("decided_s", "from its start to its outcome", get(&Step::decided_s));
  columns.number("duration_s", "settling included", get(&Step::duration_s));
  columns.number("peak_force_N", "largest force over the move", get(&Step::peak_force_N));
  return columns;
}

Columns<tenon::run_status_t> status_columns() {
  Columns<Status> columns;
  columns.count("awaited_step", "that waits for the user's word", [](const Status& m) -> Value {
    return m.awaited_step < 0 ? Value{} : Value{std::int64_t{m.awaited_step}};
  });
  columns.number("pace", "of the moves' time against motion time, 0: paused", get(&Status::pace));
  columns.count("slipped_joint", "whose brake did not hold", [](const Status& m) -> Value {
    return m.slipped_joint < 0 ? Value{} : Value{std::int64_t{m.slipped_joint}};
  });
  columns.number("slipped", "by m or rad", [](const Status& m) -> Value {
    return m.slipped_joint < 0 ? Value{} : Value{m.slipped};
  });
  columns.count("brakes_unwatched", "bit i: nobody could see whether joint i's brake holds",
                get_count(&Status::brakes_unwatched));
  columns.count("arm_fault", "kind of the arm's fault, 0: none", get_count(&Status::arm_fault));
  columns.count("arm_fault_node", "on the bus, 0: none is meant",
                get_count(&Status::arm_fault_node));
  columns.truth("bus_up", "", of_bus(get_truth(&Status::bus_up)));
  columns.truth("bus_off", "", of_bus(get_truth(&Status::bus_off)));
  columns.truth("bus_error_passive", "", of_bus(get_truth(&Status::error_passive)));
  columns.number("bus_load", "fraction taken since the last status, without stuff bits",
                 of_bus(get(&Status::bus_load)));
  columns.number("bus_load_worst", "the same with all stuff bits that can be",
                 of_bus(get(&Status::bus_load_worst)));
  columns.number("bus_frames_hz", "since the last status", of_bus(get(&Status::frame_rate_hz)));
  columns.count("bus_sent", "frames since the start", of_bus(get_count(&Status::sent)));
  columns.count("bus_received", "frames since the start", of_bus(get_count(&Status::received)));
  columns.count("bus_send_failures", "refused by the transport",
                of_bus(get_count(&Status::send_failures)));
  columns.count("bus_malformed", "since the start", of_bus(get_count(&Status::malformed)));
  columns.count("bus_error_frames", "since the start", of_bus(get_count(&Status::error_frames)));
  columns.count("bus_overruns", "since the start", of_bus(get_count(&Status::overruns)));
  return columns;
}

Columns<tenon::run_setup_t> setup_columns(const std::vector<JointName>& joints) {
  Columns<Setup> columns;
  columns.text("plan", "name of its task; empty for an identification", get_text(&Setup::plan));
  columns.text("start", "name of the nominal start", get_text(&Setup::start));
  columns.text("cell", "", get_text(&Setup::cell));
  columns.text("robot", "", get_text(&Setup::robot));
  columns.count("step_count", "of the plan", get_count(&Setup::step_count));
  columns.number("cycle_s", "period of the control cycle", get(&Setup::cycle_s));
  columns.number("force_fault_N", "of the cell: beyond, the run ends", get(&Setup::force_fault_N));
  columns.number("torque_fault_Nm", "the same", get(&Setup::torque_fault_Nm));
  columns.number("force_limit_N", "of the plan: a held tool is pulled no harder",
                 get(&Setup::force_limit_N));
  columns.number("torque_limit_Nm", "the same", get(&Setup::torque_limit_Nm));
  columns.number("bus_load_most", "fraction that the robot's frames may take",
                 get(&Setup::bus_load_most));
  columns.text("compliant_axes", "that yield", [](const Setup& m) -> Value {
    return axis_list(static_cast<std::uint8_t>(m.compliant_axes));
  });
  const auto limit = [&](std::size_t i, const std::string& name,
                         std::vector<double> Setup::*field) {
    columns.number("joint_" + joints[i].name + name + joints[i].unit, "limit",
                   [i, field](const Setup& m) -> Value {
                     return i < (m.*field).size() ? Value{(m.*field)[i]} : Value{};
                   });
  };
  for (std::size_t i = 0; i < joints.size(); ++i) {
    limit(i, "_lower", &Setup::joint_lower);
    limit(i, "_upper", &Setup::joint_upper);
  }
  return columns;
}

Columns<tenon::run_summary_t> summary_columns() {
  Columns<Summary> columns;
  columns.text("plan", "name of its task; empty for an identification", get_text(&Summary::plan));
  columns.text("start", "name of the nominal start", get_text(&Summary::start));
  columns.text("end_reason", "as result.json has it", [](const Summary& m) -> Value {
    return std::string(to_string(static_cast<EndReason>(m.end_reason)));
  });
  columns.text("message", "how it ended", get_text(&Summary::message));
  columns.count("exit_code", "0 done, 1 not", get_count(&Summary::exit_code));
  columns.count("steps", "finished", get_count(&Summary::steps));
  columns.count("cycles", "of the run", get_count(&Summary::sequence));
  columns.count("late_cycles", "periods skipped", get_count(&Summary::late_cycles));
  columns.count("incomplete_cycles", "of which feedback was missing",
                get_count(&Summary::incomplete_cycles));
  columns.count("records_dropped", "cycles that telemetry lost",
                get_count(&Summary::records_dropped));
  columns.number("peak_force_N", "since the tare", get(&Summary::peak_force_N));
  columns.number("wakeup_late_max_s", "", get(&Summary::wakeup_late_max_s));
  columns.number("compute_max_s", "", get(&Summary::compute_max_s));
  return columns;
}

}  // namespace tenon::executor

#include <array>
#include <utility>

#include "executor/export/message_columns.h"
#include "executor/faults/fault_table.h"
#include "executor/recorded/known.h"
#include "executor/states/state_machine.h"
#include "shared/base/text.h"
#include "shared/motion/contact_signature.h"

namespace tenon::executor {
namespace {

using Cycle = tenon::cycle_state_t;
using CycleColumns = Columns<Cycle>;

State state_of(const Cycle& m) { return static_cast<State>(m.state); }
bool runs_a_step(const Cycle& m) { return m.step >= 0; }

constexpr std::array<const char*, 6> kArmStates = {"unconfigured", "disabled", "enabling",
                                                   "enabled",      "stopping", "fault"};
constexpr std::array<const char*, 4> kPhases = {"moving", "probing", "settling", "done"};

template <std::size_t kCount>
Value word(const std::array<const char*, kCount>& words, int number) {
  if (number < 0 || number >= static_cast<int>(kCount)) return {};
  return std::string(words.at(static_cast<std::size_t>(number)));
}

/// @param known whether the field means something in a state
template <typename Array>
void add_array(CycleColumns& columns, std::size_t i, std::string name, std::string meaning,
               Array Cycle::*field, bool (*known)(State)) {
  columns.number(std::move(name), std::move(meaning), [=](const Cycle& m) -> Value {
    if (!known(state_of(m))) return {};
    return (m.*field)[i];
  });
}

void add_pose(CycleColumns& columns, const std::string& name, const std::string& meaning,
              double (Cycle::*position_m)[3], double (Cycle::*orientation_wxyz)[4],
              bool (*known)(State)) {
  for (std::size_t i = 0; i < 3; ++i) {
    add_array(columns, i, name + '_' + axis_key(static_cast<int>(i)), meaning, position_m, known);
  }
  for (std::size_t i = 0; i < 4; ++i) {
    add_array(columns, i, name + "_q" + "wxyz"[i], meaning + ", quaternion", orientation_wxyz,
              known);
  }
}

void add_state(CycleColumns& columns) {
  columns.count("cycle", "cycles since the start of the run",
                [](const Cycle& m) -> Value { return m.sequence; });
  columns.number("motion_s", "motion time: one period a cycle",
                 [](const Cycle& m) -> Value { return seconds(m.motion_ns); });
  columns.text("state", "of the executor",
               [](const Cycle& m) -> Value { return std::string(to_string(state_of(m))); });
  columns.count("state_number", "the same as a number",
                [](const Cycle& m) -> Value { return std::int64_t{m.state}; });
  columns.text("arm_state", "of the drives",
               [](const Cycle& m) { return word(kArmStates, m.arm_state); });
  columns.text("end_reason", "why the run ends, as result.json has it; none while it goes on",
               [](const Cycle& m) -> Value {
                 if (m.end_reason == 0) return {};
                 return std::string(to_string(static_cast<EndReason>(m.end_reason)));
               });
  columns.count("step", "of the plan; none where none runs", [](const Cycle& m) -> Value {
    if (!runs_a_step(m)) return {};
    return std::int64_t{m.step};
  });
  columns.text("phase", "of the step's guarded move", [](const Cycle& m) -> Value {
    return runs_a_step(m) ? word(kPhases, m.phase) : Value{};
  });
  columns.text("contacts", "that the tool holds: where the environment pushes it",
               [](const Cycle& m) -> Value {
                 const auto bits = static_cast<std::uint16_t>(m.signature);
                 return to_string(ContactSignature{bits});
               });
  columns.count("contact_bits", "the same: bit 2a is +, bit 2a + 1 is - of axis a",
                [](const Cycle& m) -> Value {
                  return std::int64_t{static_cast<std::uint16_t>(m.signature)};
                });
}

void add_motion(CycleColumns& columns) {
  add_pose(columns, "tool", "measured tool tip in the task frame", &Cycle::pose_position_m,
           &Cycle::pose_orientation_wxyz, knows_joints);
  add_pose(columns, "setpoint", "of the compliance law", &Cycle::setpoint_position_m,
           &Cycle::setpoint_orientation_wxyz, commands);
  add_pose(columns, "commanded", "what the compliance law made of it", &Cycle::commanded_position_m,
           &Cycle::commanded_orientation_wxyz, commands);
  for (std::size_t i = 0; i < 6; ++i) {
    const std::string key = axis_key(static_cast<int>(i));
    add_array(columns, i, "velocity_" + key + "ps", "commanded", &Cycle::velocity, commands);
  }
}

void add_wrench(CycleColumns& columns, const std::optional<tenon::run_setup_t>& setup) {
  for (std::size_t i = 0; i < 6; ++i) {
    const char axis = "xyzxyz"[i];
    add_array(columns, i, i < 3 ? format("force_%c_N", axis) : format("torque_%c_Nm", axis),
              "on the tool by the environment, task axes at the tip", &Cycle::wrench, knows_forces);
  }
  columns.truth("wrench_fresh", "a new sample of the sensor in this cycle",
                [](const Cycle& m) -> Value { return m.wrench_fresh != 0; });
  if (!setup) return;
  const auto threshold = [&](const char* name, const std::vector<double>& of_steps) {
    columns.number(name, "threshold of a contact in the step that runs",
                   [of_steps](const Cycle& m) -> Value {
                     const auto step = static_cast<std::size_t>(m.step);
                     if (!runs_a_step(m) || step >= of_steps.size()) return {};
                     return of_steps[step];
                   });
  };
  threshold("contact_from_N", setup->force_on_N);
  threshold("contact_from_Nm", setup->torque_on_Nm);
}

void add_joints(CycleColumns& columns, const std::vector<JointName>& joints) {
  const auto add = [&](std::size_t i, const std::string& name, const char* meaning,
                       std::vector<double> Cycle::*field, bool (*known)(State)) {
    columns.number(name, meaning, [=](const Cycle& m) -> Value {
      if (!known(state_of(m)) || i >= (m.*field).size()) return {};
      return (m.*field)[i];
    });
  };
  for (std::size_t i = 0; i < joints.size(); ++i) {
    const char* name = joints[i].name.c_str();
    const char* unit = joints[i].unit.c_str();
    add(i, format("joint_%s%s", name, unit), "measured", &Cycle::joint_position, knows_joints);
    add(i, format("joint_%s_commanded%s", name, unit), "commanded", &Cycle::joint_commanded,
        commands);
  }
  columns.count("joints_fresh", "bit i: joint i answered in this cycle",
                [](const Cycle& m) -> Value { return std::int64_t{m.joints_fresh}; });
}

void add_timing(CycleColumns& columns) {
  columns.number("wakeup_late_s", "from the due time to being awake",
                 [](const Cycle& m) -> Value { return m.wakeup_late_s; });
  columns.number("compute_s", "from the last feedback to the last setpoint",
                 [](const Cycle& m) -> Value { return m.compute_s; });
  columns.count("late_cycles", "periods skipped so far",
                [](const Cycle& m) -> Value { return std::int64_t{m.late_cycles}; });
  columns.count("records_dropped", "cycles that telemetry lost so far",
                [](const Cycle& m) -> Value { return m.records_dropped; });
}

}  // namespace

Columns<tenon::cycle_state_t> cycle_columns(const std::vector<JointName>& joints,
                                            const std::optional<tenon::run_setup_t>& setup) {
  CycleColumns columns;
  add_state(columns);
  add_motion(columns);
  add_wrench(columns, setup);
  add_joints(columns, joints);
  add_timing(columns);
  return columns;
}

}  // namespace tenon::executor

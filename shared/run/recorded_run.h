#pragma once
// A run of a plan as it is looked at afterwards: what its telemetry and its result told of it, as
// plain data. Who reads the files (executor/recorded) need not know how it is shown, and who shows
// it (planner/report) need not know the files. Any thread.

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "shared/math/pose.h"
#include "shared/motion/contact_signature.h"
#include "shared/motion/outcome.h"
#include "shared/plan/plan.h"
#include "shared/ports/arm.h"

namespace tenon {

/// One control cycle. A run has hundreds of thousands: floats, as precise as sensors are. What is
/// not known in a cycle is not a number.
struct RecordedCycle {
  static constexpr float kUnknown = std::numeric_limits<float>::quiet_NaN();

  template <std::size_t kCount>
  [[nodiscard]] static constexpr std::array<float, kCount> unknown() {
    std::array<float, kCount> values{};
    values.fill(kUnknown);
    return values;
  }

  double time_s = 0.0;                            ///< since the first cycle
  std::int16_t step = -1;                         ///< that runs
  std::uint16_t signature = 0;                    ///< contact bits
  std::array<float, 7> tool = unknown<7>();       ///< measured in the task frame: m, then w x y z
  std::array<float, 7> commanded = unknown<7>();  ///< the same by the compliance law
  std::array<float, 6> wrench = unknown<6>();     ///< external, task axes at the tool, N and Nm
  std::array<float, kMaxJoints> joints{};         ///< measured, m or rad
  std::array<float, kMaxJoints> commanded_joints{};
  float wakeup_late_s = 0.0F;
  float compute_s = 0.0F;
  std::int32_t late_cycles = 0;  ///< periods skipped so far
};

/// A finished step of the plan.
struct RecordedStep {
  std::size_t step = 0;
  Outcome outcome = Outcome::kReached;
  std::string deviation;  ///< from the plan, one line; empty: none
  Successor successor = kSuccessorFail;
  std::string signature;                ///< contacts that it settled with, as "-x +z" or "none"
  Vector6 travelled = Vector6::Zero();  ///< m and rad
  Pose tool;                            ///< settled, in the task frame
  double duration_s = 0.0;              ///< settling included
  double peak_force_N = 0.0;
};

/// The bus over the time since the status before.
struct RecordedBus {
  double time_s = 0.0;
  double load = 0.0;        ///< fraction taken, without stuff bits
  double load_worst = 0.0;  ///< with all that can be
};

/// Something that went wrong, or may have.
struct RecordedFault {
  std::optional<double> time_s;  ///< where it is known
  std::string text;              ///< one line
};

/// From when on the executor was in a state.
struct RecordedState {
  double from_s = 0.0;
  std::string name;
};

struct RecordedJoint {
  std::string name;
  bool linear = false;  ///< m, else rad
  double lower = 0.0;
  double upper = 0.0;
};

/// What the run was measured by, beyond what the plan says.
struct RecordedLimits {
  double cycle_s = 0.0;
  double force_fault_N = 0.0;
  double torque_fault_Nm = 0.0;
  double bus_load_most = 1.0;  ///< fraction that its frames may take
};

struct RecordedRun {
  std::string cell;
  std::string robot;
  std::string message;  ///< how it ended, one line; empty: nobody told
  bool ended = false;   ///< its end was told
  bool done = false;    ///< and it was the plan's
  double duration_s = 0.0;
  std::optional<double> peak_force_N;  ///< since the tare
  std::uint64_t cycles = 0;
  std::uint64_t late_cycles = 0;
  std::uint64_t incomplete_cycles = 0;  ///< of which feedback was missing
  std::uint64_t records_dropped = 0;    ///< cycles that are in no file
  double wakeup_late_max_s = 0.0;
  double compute_max_s = 0.0;

  std::optional<RecordedLimits> limits;
  std::vector<RecordedJoint> joints;
  std::vector<RecordedCycle> samples;  ///< ascending in time; empty without a log
  std::vector<RecordedStep> steps;
  std::vector<RecordedState> states;
  std::vector<RecordedBus> bus;
  std::vector<RecordedFault> faults;
  std::vector<std::string> notes;  ///< what is not there, or could not be read; one line each
};

}  // namespace tenon

#pragma once
// A task of the control cycle, from the arm's feedback to its joint setpoints: what all tasks have
// in common. It waits for the drives, tares the sensor at rest, holds at the end, disables and sees
// that the brakes hold; it watches the arm from the first cycle to the last, and remembers why the
// run ended (state_machine.h draws the states). How the tool or the joints move in between is the
// derived class's: the run of a plan (controller.h), the motion of an identification
// (identification/). That class says what a cycle came to; the state changes here alone.
//
// Plain code without clock, bus or thread; time is an argument. Real-time but for the constructor:
// no allocation, no lock, no throw. One thread.

#include <cstdint>
#include <optional>
#include <variant>

#include "executor/faults/fault_bounds.h"
#include "executor/faults/fault_table.h"
#include "executor/loop/supervision.h"
#include "executor/motion/joint_command.h"
#include "executor/motion/tool_kinematics.h"
#include "executor/record/cycle_record.h"
#include "executor/sensing/brake_watch.h"
#include "executor/sensing/drift_watch.h"
#include "executor/sensing/effort_watch.h"
#include "executor/sensing/joint_torque_wrench.h"
#include "executor/sensing/sensor_tare.h"
#include "executor/states/ending.h"
#include "executor/states/state_machine.h"
#include "shared/cell/cell.h"
#include "shared/motion/stiff_contact.h"
#include "shared/ports/arm.h"

namespace tenon::executor {

class ControlTask {
 public:
  struct Parameters {
    int tare_samples = kTareSamples;
    double tare_motion_max = 2e-4;  ///< m or rad that a joint may move while taring
    double enable_timeout_s = kEnableTimeout_s;
    double disable_timeout_s = kDisableTimeout_s;
    double hold_s = 0.2;
    double quick_stop_s = 0.5;  ///< left to the drives to ramp down; more where a joint needs more
    double brake_watch_s =
        kBrakeWatch_s;  ///< after the drives are off; more than a brake takes to close
    double brake_creep_s = kBrakeCreep_s;  ///< at the most, while a joint moves on within its play
    BrakeWatch::Parameters brakes;
    Supervision::Parameters supervision;
    FaultMask masked;  ///< in tests alone: these end no run
  };

  struct Command {
    ArmRequest request = ArmRequest::kDisabled;
    JointVector position{};
  };

  ControlTask(const ControlTask&) = delete;
  ControlTask& operator=(const ControlTask&) = delete;
  virtual ~ControlTask() = default;

  /// One cycle. @param now_ns monotonic, for the record; motion goes by the cycle count, so a late
  /// cycle stretches the motion and never makes it jump.
  [[nodiscard]] Command cycle(std::int64_t now_ns, const ArmFeedback& heard) noexcept;

  /// Ends the run: on the user's request, because the loop is too late, or the bus too bad. A
  /// request counts once: who holds an arm whose brake failed goes on until the next one.
  void request_stop() noexcept { stop_requested_ = true; }
  /// The same by nobody's word, such as an end of input: ends the work, and lets go of no arm that
  /// is held; there it is only counted.
  void request_end() noexcept { end_requested_ = true; }
  void report_overruns(std::uint64_t late_cycles) noexcept;
  void report_poor_feedback(std::uint64_t incomplete_cycles) noexcept;

  /// Guarded moves take no samples for the next few cycles; the limits on force and torque keep
  /// watching. To be called where the SYNC of the coming cycle is late, or answers are missing: the
  /// drives ran out of setpoints, stopped and go on, and the sensor feels the payload's inertia of
  /// a motion that nobody commanded.
  void distrust_samples() noexcept {
    supervision_.distrust_samples(shaken_cycles(cell_.robot.measurement_delay_cycles));
  }

  [[nodiscard]] State state() const noexcept { return state_; }
  [[nodiscard]] bool finished() const noexcept { return state_ == State::kFinished; }
  [[nodiscard]] const Ending& ending() const noexcept { return ending_; }
  /// Of the last cycle.
  [[nodiscard]] const CycleRecord& record() const noexcept { return record_; }
  [[nodiscard]] const Cell& cell() const noexcept { return cell_; }
  [[nodiscard]] double cycle_s() const noexcept { return cycle_s_; }
  /// Cycles since the tare in which guarded moves could see no sample.
  [[nodiscard]] std::uint64_t blind_cycles() const noexcept { return supervision_.blind_cycles(); }
  /// At which the arm may stop its drives by itself; none once they have been told to go off. An
  /// arm that is held then may lean on what is put under it.
  [[nodiscard]] ForceLimit force_limit() const noexcept;
  /// Holding needs no sensor: what becomes of it then lets nothing fall.
  [[nodiscard]] bool relies_on_sensor() const noexcept { return state_ != State::kCatching; }
  /// Largest external force and torque since the tare, N and Nm.
  [[nodiscard]] double peak_force_N() const noexcept { return supervision_.peak_force_N(); }
  [[nodiscard]] double peak_torque_Nm() const noexcept { return supervision_.peak_torque_Nm(); }

 protected:
  /// Copies the cell, as sensed_cell(). @throws InputError for a robot without joints
  ControlTask(const Cell& cell, const Parameters& parameters);

  /// What a state came to in a cycle: nothing yet, what leads to the next one, or the run's end.
  using Turn = std::variant<std::monostate, Event, Ending>;

  // What a task adds.
  /// A state has just begun. What it comes to by that alone is taken in the same cycle.
  [[nodiscard]] virtual Turn on_enter(State state) = 0;
  /// One cycle of kApproaching, kRunning and kStopping, which are the task's own.
  [[nodiscard]] virtual Turn approach() = 0;
  [[nodiscard]] virtual Turn run(const ArmFeedback& feedback) = 0;
  [[nodiscard]] virtual Turn ramp_down() = 0;
  /// One cycle of kHolding.
  [[nodiscard]] virtual Turn hold() { return held(); }
  /// The drives are off, and the brakes have what they hold.
  /// @return what there is against the end that stands
  [[nodiscard]] virtual std::optional<Ending> seen_in_brakes() { return std::nullopt; }
  /// The run ends for this reason, in the state that it is still in.
  virtual void on_ending(const Ending& /*ending*/) {}
  /// Commands the joints of this cycle, from kApproaching to kHolding.
  /// @return why they cannot follow; they then stand as they stood
  [[nodiscard]] virtual std::optional<Ending> command_joints() = 0;
  /// After that, and after what a refusal led to: joints that have left their way ramp down.
  /// @return the velocity commanded to the tool, task axes
  [[nodiscard]] virtual Vector6 complete_motion() = 0;
  /// Fills in what the common part of a record does not tell.
  virtual void write_motion(CycleRecord& record) = 0;

  /// Has it held for long enough?
  [[nodiscard]] Turn held() const;
  /// The tool waits in free air. @return that the wrench moves all the same
  [[nodiscard]] std::optional<Ending> wait_in_free_air();
  /// It does so no more.
  void leave_free_air() { drift_watch_.restart(); }
  /// The sensor's zero has moved, in its axes, N and Nm.
  void move_zero(const Vector6& by) { supervision_.move_zero(by); }

  [[nodiscard]] double time_in_state_s() const;
  [[nodiscard]] std::int64_t motion_ns() const { return motion_ns_; }
  [[nodiscard]] const ToolKinematics& kinematics() const { return kinematics_; }
  [[nodiscard]] const Supervision& supervision() const { return supervision_; }
  [[nodiscard]] JointCommand& joints() { return joints_; }
  /// Where the joints' efforts tell the force; else null.
  [[nodiscard]] const JointTorqueWrench* joint_torque() const {
    return joint_torque_ ? &*joint_torque_ : nullptr;
  }
  [[nodiscard]] const JointCommand& joints() const { return joints_; }

 private:
  void take(const Turn& turn);
  void take_requests();
  [[nodiscard]] std::optional<Event> event_of(const Turn& turn);
  [[nodiscard]] Turn enter_state(State state);
  [[nodiscard]] Event remember(const Ending& ending);
  [[nodiscard]] bool following() const;
  [[nodiscard]] bool moving() const;
  [[nodiscard]] ArmRequest request() const;
  [[nodiscard]] std::uint32_t all_joints() const;

  [[nodiscard]] Turn act(const ArmFeedback& feedback);
  [[nodiscard]] Turn wait_for_drives(const ArmFeedback& feedback) const;
  [[nodiscard]] Turn tare(const ArmFeedback& feedback);
  [[nodiscard]] Turn end_tare();
  [[nodiscard]] std::optional<Ending> watch_drift(const Vector6& sample);
  [[nodiscard]] Turn wait_for_rest(const ArmFeedback& feedback);
  [[nodiscard]] Turn wait_for_disabled(const ArmFeedback& feedback);
  [[nodiscard]] std::uint32_t joints_off(const ArmFeedback& feedback) const;
  void watch_efforts(const ArmFeedback& feedback);
  void follow_brakes(const ArmFeedback& feedback);
  [[nodiscard]] Turn watch_brakes(const ArmFeedback& feedback);
  [[nodiscard]] bool brakes_under_watch() const;
  void name_unseen();
  void name_not_disabled(std::uint32_t off);
  [[nodiscard]] Turn keep_power(const ArmFeedback& feedback);
  void write_record(std::int64_t now_ns, const ArmFeedback& feedback, const Command& command);

  Cell cell_;
  Parameters parameters_;
  double cycle_s_;
  std::int64_t cycle_ns_;
  ToolKinematics kinematics_;
  std::optional<JointTorqueWrench> joint_torque_;
  std::optional<EffortWatch> effort_watch_;  ///< where those efforts are used
  Supervision supervision_;
  SensorTare sensor_tare_;
  int unsteady_tares_ = 0;
  DriftWatch drift_watch_;
  BrakeWatch brake_watch_;
  std::optional<Ending> drift_;  ///< of the tare
  JointCommand joints_;

  State state_ = State::kWaiting;
  std::int64_t state_since_ns_ = 0;
  bool power_asked_ = false;  ///< in any cycle
  std::int64_t motion_ns_ = 0;
  std::uint64_t sequence_ = 0;
  bool stop_requested_ = false;
  bool end_requested_ = false;
  std::uint32_t stops_unheeded_ = 0;
  Ending ending_;

  JointVector tare_low_{};
  JointVector tare_high_{};
  JointVector rest_at_{};  ///< where the joints were when they last moved
  int rest_cycles_ = 0;
  CycleRecord record_;
};

}  // namespace tenon::executor

#pragma once
// One control cycle: from the arm's feedback to its joint setpoints. Plain code without clock, bus
// or thread; time is an argument. A run is
// waiting for the drives, taring, approaching the plan's start, running the plan, holding,
// disabling; state_machine.h draws them. A stop on request ramps the tool down with bounded jerk
// and stays compliant; where the tool has no way on (reach, a joint's limit or speed) and on the
// way to the start the joints ramp down; a force fault or a fault of the arm leaves the ramp to the
// drives.
//
// Real-time but for the constructor: no allocation, no lock, no throw. One thread.

#include <cstdint>
#include <optional>

#include "executor/admittance.h"
#include "executor/dry_run/dry_run.h"
#include "executor/ending.h"
#include "executor/joint_command.h"
#include "executor/joint_move.h"
#include "executor/plan_runner.h"
#include "executor/sensor_tare.h"
#include "executor/state_machine.h"
#include "executor/stop_profile.h"
#include "executor/supervision.h"
#include "executor/telemetry/cycle_record.h"
#include "executor/tool_kinematics.h"
#include "shared/cell/cell.h"
#include "shared/plan/plan.h"
#include "shared/ports/arm.h"

namespace tenon::executor {

class Controller {
 public:
  struct Parameters {
    bool go_to_start = false;
    double start_tolerance_m = 2e-3;
    double start_tolerance_rad = 0.02;
    double start_tolerance_joint = 0.3;  ///< m or rad; more is another branch of the arm
    int tare_samples = 200;
    double tare_motion_max = 2e-4;  ///< m or rad that a joint may move while taring
    double enable_timeout_s = 5.0;
    double disable_timeout_s = 3.0;
    double hold_s = 0.2;
    double quick_stop_s = 0.5;  ///< left to the drives to ramp down
    Supervision::Parameters supervision;
  };

  struct Command {
    ArmRequest request = ArmRequest::kDisabled;
    JointVector position{};
  };

  /// Copies cell and plan, as the dry run slowed it; look at its refusals and at check_plan()
  /// first.
  /// @throws InputError for a robot without joints or a plan without steps.
  Controller(const Cell& cell, const DryRun& dry_run, const Parameters& parameters);
  /// The same after a dry run of its own.
  Controller(const Cell& cell, const Plan& plan, const Parameters& parameters)
      : Controller(cell, dry_run(plan, cell), parameters) {}
  Controller(const Controller&) = delete;
  Controller& operator=(const Controller&) = delete;

  /// One cycle. @param now_ns monotonic, for the record; motion goes by the cycle count, so a late
  /// cycle stretches the motion and never makes it jump.
  Command cycle(std::int64_t now_ns, const ArmFeedback& feedback) noexcept;

  /// Ends the run: on the user's request, because the loop is too late, or the bus too bad.
  void request_stop() noexcept { stop_requested_ = true; }
  void report_overruns(std::uint64_t late_cycles) noexcept;
  void report_poor_feedback(std::uint64_t incomplete_cycles) noexcept;

  /// The SYNC of the coming cycle was late, or its answers were: the drives ran out of setpoints,
  /// stopped and go on, and the sensor feels the payload's inertia of a motion that nobody
  /// commanded. Guarded moves take no samples for the few cycles that this lasts; the limits on
  /// force and torque keep watching.
  void report_late_sync() noexcept {
    constexpr int kStopAndGo = 3;
    supervision_.be_blind(kStopAndGo + cell_.robot.measurement_delay_cycles);
  }

  [[nodiscard]] State state() const noexcept { return state_; }
  [[nodiscard]] bool finished() const noexcept { return state_ == State::kFinished; }
  [[nodiscard]] const Ending& ending() const noexcept { return ending_; }
  [[nodiscard]] const PlanRunner& runner() const noexcept { return runner_; }
  /// Of the last cycle.
  [[nodiscard]] const CycleRecord& record() const noexcept { return record_; }
  [[nodiscard]] const Cell& cell() const noexcept { return cell_; }
  /// What is executed: the dry run's.
  [[nodiscard]] const Plan& plan() const noexcept { return plan_; }
  [[nodiscard]] double cycle_s() const noexcept { return cycle_s_; }
  /// Largest external force and torque since the tare, N and Nm.
  [[nodiscard]] double peak_force_N() const noexcept { return supervision_.peak_force_N(); }
  [[nodiscard]] double peak_torque_Nm() const noexcept { return supervision_.peak_torque_Nm(); }

 private:
  void process_event(Event event);
  void enter_state(State state);
  /// Remembers why the run ends; a fault takes precedence over an orderly end, else the first
  /// stays.
  void end(const Ending& ending);
  [[nodiscard]] bool following() const;
  [[nodiscard]] ArmRequest request() const;

  // What a state does in a cycle.
  void act(const ArmFeedback& feedback);
  void tare(const ArmFeedback& feedback);
  void start_approach();
  void approach();
  void run_plan();
  void ramp_down();
  void wait_for_rest();
  void wait_for_disabled(const ArmFeedback& feedback);

  // Giving out.
  void move_tool();
  void leave_the_tool();
  void yield_here();
  void write_record(std::int64_t now_ns, const ArmFeedback& feedback, const Command& command);

  [[nodiscard]] const ParameterSet& parameters_of_step() const {
    return plan_.parameter_sets[plan_.steps[runner_.step()].parameter_set];
  }
  [[nodiscard]] std::optional<Ending> off_start() const;
  [[nodiscard]] Pose pose_for_move() const;
  [[nodiscard]] double time_in_state_s() const;
  [[nodiscard]] double on_threshold(int axis) const;
  [[nodiscard]] int touching_axis(std::uint8_t axes) const;

  Cell cell_;
  Plan plan_;
  std::optional<JointVector> start_;  ///< joints, as the dry run found them
  Parameters parameters_;
  double cycle_s_;
  std::int64_t cycle_ns_;
  ToolKinematics kinematics_;
  Supervision supervision_;
  Admittance admittance_;
  PlanRunner runner_;
  SensorTare sensor_tare_;
  JointCommand joints_;

  State state_ = State::kWaiting;
  std::int64_t state_since_ns_ = 0;
  std::int64_t motion_ns_ = 0;
  std::uint64_t sequence_ = 0;
  bool stop_requested_ = false;
  Ending ending_;

  JointVector tare_low_{};
  JointVector tare_high_{};
  JointVector rest_at_{};  ///< where the joints were when they last moved
  int rest_cycles_ = 0;
  int touch_samples_ = 0;

  GuardedMove::Setpoint setpoint_;
  GuardedMove::Phase phase_ = GuardedMove::Phase::kDone;
  JointMove approach_;
  StopProfile stop_;
  bool tool_left_ = false;              ///< the joints ramp down or hold by themselves
  Pose commanded_;                      ///< tool pose behind the commanded joints
  Vector6 velocity_ = Vector6::Zero();  ///< its, m/s and rad/s
  CycleRecord record_;
};

}  // namespace tenon::executor

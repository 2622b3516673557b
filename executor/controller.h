#pragma once
// One control cycle: from the arm's feedback to its joint setpoints. Plain code without clock, bus
// or thread; time is an argument. A run is
// waiting for the drives, taring, approaching the plan's start, running the plan, holding,
// disabling; state_machine.h draws them. Stopping on request, on contact during the approach, or on
// a failed plan ramps the command down with bounded jerk and stays compliant; a force fault, a
// broken limit or a fault of the arm leaves the ramp to the drives.
//
// Real-time but for the constructor: no allocation, no lock, no throw. One thread.

#include <cstdint>
#include <optional>

#include "executor/admittance.h"
#include "executor/cycle_record.h"
#include "executor/ending.h"
#include "executor/plan_runner.h"
#include "executor/sensor_tare.h"
#include "executor/state_machine.h"
#include "executor/stop_profile.h"
#include "executor/tool_kinematics.h"
#include "executor/wrench_estimator.h"
#include "shared/cell/cell.h"
#include "shared/motion/motion_profile.h"
#include "shared/plan/plan.h"
#include "shared/ports/arm.h"

namespace tenon::executor {

class Controller {
 public:
  struct Parameters {
    bool go_to_start = false;
    double start_tolerance_m = 2e-3;
    double start_tolerance_rad = 0.02;
    int tare_samples = 200;
    double tare_motion_max = 2e-4;  ///< m or rad that a joint may move while taring
    double enable_timeout_s = 5.0;
    double disable_timeout_s = 3.0;
    double hold_s = 0.2;
    double quick_stop_s = 0.5;     ///< left to the drives to ramp down
    int feedback_misses_max = 10;  ///< cycles in a row
    double wrench_age_max_s = 0.05;
  };

  struct Command {
    ArmRequest request = ArmRequest::kDisabled;
    JointVector position{};
  };

  /// Copies plan and cell. Check them with check_plan() first.
  /// @throws InputError for a robot without joints or a plan without steps.
  Controller(const Cell& cell, const Plan& plan, const Parameters& parameters);
  Controller(const Controller&) = delete;
  Controller& operator=(const Controller&) = delete;

  /// One cycle. @param now_ns monotonic, for the record; motion goes by the cycle count, so a late
  /// cycle stretches the motion and never makes it jump.
  Command cycle(std::int64_t now_ns, const ArmFeedback& feedback) noexcept;

  /// Ends the run in the next cycle: on the user's request, or because the loop is too late.
  void request_stop() noexcept { stop_requested_ = true; }
  void report_overruns(std::uint64_t late_cycles) noexcept;

  /// The SYNC of the coming cycle was late, or its answers were: the drives ran out of setpoints,
  /// stopped and go on, and the sensor feels the payload's inertia of a motion that nobody
  /// commanded. Guarded moves take no samples for the few cycles that this lasts; the limits on
  /// force and torque keep watching.
  void report_late_sync() noexcept {
    constexpr int kStopAndGo = 3;
    blind_cycles_ = kStopAndGo + cell_.robot.measurement_delay_cycles;
  }

  [[nodiscard]] State state() const noexcept { return state_; }
  [[nodiscard]] bool finished() const noexcept { return state_ == State::kFinished; }
  [[nodiscard]] const Ending& ending() const noexcept { return ending_; }
  [[nodiscard]] const PlanRunner& runner() const noexcept { return runner_; }
  /// Of the last cycle.
  [[nodiscard]] const CycleRecord& record() const noexcept { return record_; }
  [[nodiscard]] const Cell& cell() const noexcept { return cell_; }
  [[nodiscard]] const Plan& plan() const noexcept { return plan_; }
  [[nodiscard]] double cycle_s() const noexcept { return cycle_s_; }
  /// Largest external force and torque since the tare, N and Nm.
  [[nodiscard]] double peak_force_N() const noexcept { return peak_force_N_; }
  [[nodiscard]] double peak_torque_Nm() const noexcept { return peak_torque_Nm_; }

 private:
  void process_event(Event event);
  void enter_state(State state);
  /// Remembers why the run ends; a fault takes precedence over an orderly end, else the first
  /// stays.
  void end(const Ending& ending);

  // Taking in.
  void take_joints(const ArmFeedback& feedback);
  void take_wrench(const ArmFeedback& feedback);
  void watch_arm(const ArmFeedback& feedback);
  void watch_force(const ArmFeedback& feedback);

  // What a state does in a cycle.
  void act(const ArmFeedback& feedback);
  void tare(const ArmFeedback& feedback);
  void approach();
  void run_plan();
  void ramp_down();
  void wait_for_rest();

  // Giving out.
  void move_tool();
  void command_joints(const Pose& tool);
  [[nodiscard]] const ParameterSet& parameters_of_step() const {
    return plan_.parameter_sets[plan_.steps[runner_.step()].parameter_set];
  }
  [[nodiscard]] Pose pose_for_move() const;
  [[nodiscard]] double time_in_state_s() const;
  [[nodiscard]] int touching_axis() const;
  void stop_setpoint_here();
  void start_approach();
  [[nodiscard]] ArmRequest request() const;
  void write_record(std::int64_t now_ns, const ArmFeedback& feedback, const Command& command);

  Cell cell_;
  Plan plan_;
  Parameters parameters_;
  double cycle_s_;
  std::int64_t cycle_ns_;
  ToolKinematics kinematics_;
  WrenchEstimator wrench_;
  Admittance admittance_;
  PlanRunner runner_;
  SensorTare sensor_tare_;

  State state_ = State::kWaiting;
  std::int64_t state_since_ns_ = 0;
  std::int64_t motion_ns_ = 0;
  std::uint64_t sequence_ = 0;
  bool stop_requested_ = false;
  Ending ending_;

  JointVector measured_{};
  std::array<int, kMaxJoints> misses_{};
  bool known_ = false;  ///< every joint has answered at least once
  Pose tool_;           ///< measured
  JointVector tare_low_{};
  JointVector tare_high_{};
  JointVector rest_at_{};  ///< where the joints were when they last moved
  int rest_cycles_ = 0;
  bool tared_ = false;
  std::int64_t wrench_age_ns_ = 0;
  int blind_cycles_ = 0;        ///< left, see report_late_sync()
  bool wrench_usable_ = false;  ///< a fresh sample that guarded moves may see
  double peak_force_N_ = 0.0;
  double peak_torque_Nm_ = 0.0;
  int touch_samples_ = 0;

  GuardedMove::Setpoint setpoint_;
  GuardedMove::Phase phase_ = GuardedMove::Phase::kDone;
  MotionProfile approach_;
  Pose approach_from_;
  Vector6 approach_along_ = Vector6::Zero();
  StopProfile stop_;
  JointVector joints_{};  ///< commanded
  Pose commanded_;        ///< tool pose behind joints_
  CycleRecord record_;
};

}  // namespace tenon::executor

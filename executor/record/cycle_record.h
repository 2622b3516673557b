#pragma once
// Everything that one control cycle saw, decided and commanded: what telemetry publishes, the black
// box keeps and a trace is made of. Plain data, copied through a ring.

#include <array>
#include <cstddef>
#include <cstdint>
#include <type_traits>

#include "executor/states/brake_slip.h"
#include "executor/states/state_machine.h"
#include "shared/math/pose.h"
#include "shared/motion/guarded_move.h"
#include "shared/ports/arm.h"

namespace tenon::executor {

/// A pose as bytes.
struct PoseData {
  std::array<double, 3> position_m{};
  std::array<double, 4> orientation_wxyz{1.0, 0.0, 0.0, 0.0};
};

[[nodiscard]] inline PoseData data_of(const Pose& pose) {
  const auto& q = pose.orientation;
  return {{pose.position_m.x(), pose.position_m.y(), pose.position_m.z()},
          {q.w(), q.x(), q.y(), q.z()}};
}
[[nodiscard]] inline Pose pose_of(const PoseData& data) {
  const auto& q = data.orientation_wxyz;
  return {Vector3(data.position_m[0], data.position_m[1], data.position_m[2]),
          Eigen::Quaterniond(q[0], q[1], q[2], q[3])};
}
[[nodiscard]] inline std::array<double, 6> data_of(const Vector6& v) {
  return {v[0], v[1], v[2], v[3], v[4], v[5]};
}
[[nodiscard]] inline Vector6 vector_of(const std::array<double, 6>& data) {
  return Vector6(data.data());
}

struct CycleRecord {
  std::uint64_t sequence = 0;  ///< cycles since the start
  std::int64_t time_ns = 0;    ///< monotonic, when the cycle was due
  std::int64_t motion_ns = 0;  ///< motion time: one period a cycle, however late the clock is
  State state = State::kWaiting;
  ArmState arm_state = ArmState::kUnconfigured;
  ArmRequest request = ArmRequest::kDisabled;
  std::uint8_t end_reason = 0;
  ArmFault arm_fault;  ///< of the Ending, as the next two
  Hold hold = Hold::kNone;
  std::uint32_t stops_unheeded = 0;  ///< so far: asked by nobody's word to let go of a held arm
  BrakeSlip slip;
  std::uint32_t brakes_unwatched = 0;  ///< bit i: of joint i

  // What the guarded move got and gave; valid while a move runs (moving).
  bool moving = false;
  bool move_started = false;  ///< the first input of a move
  bool wrench_fresh = false;  ///< a new sample, and not a distrusted one
  GuardedMove::Phase phase = GuardedMove::Phase::kDone;
  /// The move's own time: it runs slower while the user pauses it, by at least 1 ns a cycle.
  std::int64_t move_ns = 0;
  double pace = 1.0;  ///< of that time against motion_ns; 0: paused
  std::int32_t step = -1;
  std::int32_t awaited_step = -1;  ///< that waits for the user's word; -1: none
  /// Reports that PlanRunner holds by now. They are written once and before this record, so who
  /// gets the record may read them.
  std::uint32_t steps_done = 0;
  std::uint16_t signature_before = 0;
  std::uint16_t signature = 0;
  PoseData pose;                     ///< measured tool in task frame, as the move saw it
  std::array<double, 6> wrench{};    ///< external, task axes at the tool, N and Nm
  PoseData setpoint;                 ///< of the admittance law
  PoseData commanded;                ///< what the admittance law made of it
  std::array<double, 6> velocity{};  ///< commanded, m/s and rad/s

  std::array<double, 6> wrench_raw{};  ///< sensor axes
  JointVector position{};              ///< measured, m or rad
  JointVector position_commanded{};
  std::uint32_t joints_fresh = 0;

  // Filled in by the loop around the controller; zero in lockstep.
  std::int64_t wakeup_late_ns = 0;
  std::int64_t compute_ns = 0;
  std::uint32_t late_cycles = 0;  ///< periods skipped so far
};
static_assert(std::is_trivially_copyable_v<CycleRecord>);

}  // namespace tenon::executor

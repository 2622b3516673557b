#pragma once
// An arm that follows its setpoints exactly, with springy walls around its tool and a wrist
// sensor: the arm port without bus, drives or dynamics. Everything it answers is one cycle old.
// Steps with its caller; no thread, no clock. Knobs break it on purpose.

#include <cstdint>
#include <random>
#include <vector>

#include "shared/cell/cell.h"
#include "shared/kinematics/serial_chain.h"
#include "shared/ports/arm.h"

namespace tenon::executor {

/// A half space that pushes back: the tool tip feels it beyond `position_m` along `sign` * axis.
struct Wall {
  int axis = 0;
  int sign = 1;  ///< +1: solid for larger coordinates
  double position_m = 0.0;
};

class WallArm : public Arm {
 public:
  /// @param tool where the tool stands, in the task frame; the cell's gantry must reach it
  WallArm(const Cell& cell, const Pose& tool);
  /// Any arm. @param joints where it stands
  WallArm(const Cell& cell, const JointVector& joints);

  // The world.
  std::vector<Wall> walls;
  double stiffness_Npm = 5e4;
  Vector6 bias = Vector6::Zero();  ///< of the sensor, its axes
  double noise_N = 0.0;            ///< standard deviation, on forces; a thousandth on torques
  double drift_mps = 0.0;          ///< of joint 0, while it is told to stand
  double creep_mps = 0.0;          ///< of joint 0, in its brake

  // Knobs.
  bool never_enables = false;
  bool never_disables = false;
  std::uint32_t mute_joints = 0;  ///< bits: these do not answer
  bool mute_sensor = false;
  Vector6 push = Vector6::Zero();  ///< extra wrench on the tool, task axes
  ArmFault break_with;             ///< set a kind: the arm goes to fault

  [[nodiscard]] std::size_t joint_count() const noexcept override { return chain_.joint_count(); }
  [[nodiscard]] bool prepare(std::int64_t now_ns) override;
  void start_cycle(std::int64_t now_ns) noexcept override;
  [[nodiscard]] bool receive(std::int64_t now_ns, ArmFeedback& feedback) noexcept override;
  void command(std::int64_t now_ns, ArmRequest request,
               const JointVector& position) noexcept override;
  void wait(std::int64_t /*at_most_ns*/) noexcept override {}
  [[nodiscard]] ArmState state() const noexcept override { return state_; }
  [[nodiscard]] ArmFault fault() const noexcept override { return fault_; }

  [[nodiscard]] Pose tool() const;
  /// Force of the walls on the tool now, task axes.
  [[nodiscard]] Vector3 wall_force_N() const;
  [[nodiscard]] int quick_stops() const { return quick_stops_; }

 private:
  [[nodiscard]] std::uint32_t all_joints() const { return (1U << chain_.joint_count()) - 1U; }
  void follow_request();
  [[nodiscard]] Vector6 sensor_reading();

  Cell cell_;
  SerialChain chain_;
  JointVector position_{};
  JointVector setpoint_{};
  ArmRequest request_ = ArmRequest::kDisabled;
  ArmState state_ = ArmState::kUnconfigured;
  ArmFault fault_;
  int cycles_to_go_ = 0;
  int quick_stops_ = 0;
  std::uint16_t counter_ = 0;
  ArmFeedback answer_;  ///< of the previous cycle
  ArmFeedback current_;
  std::mt19937 random_{1};
};

}  // namespace tenon::executor

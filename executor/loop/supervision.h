#pragma once
// Takes in what the arm says and watches it: joints that answer and follow, a sensor that is sound
// and fresh, a force within the cell's bounds. What ends a run from outside comes back as an
// Ending. It commands nothing. Real-time, one thread, no allocation.

#include <array>
#include <cstdint>
#include <optional>

#include "executor/faults/fault_bounds.h"
#include "executor/motion/tool_kinematics.h"
#include "executor/sensing/encoder_watch.h"
#include "executor/sensing/following_watch.h"
#include "executor/sensing/frozen_watch.h"
#include "executor/sensing/wrench_estimator.h"
#include "executor/states/ending.h"
#include "shared/cell/cell.h"
#include "shared/ports/arm.h"

namespace tenon::executor {

class Supervision {
 public:
  struct Parameters {
    int feedback_misses_max = kFeedbackMissesMax;  ///< cycles in a row
    double wrench_age_max_s = kWrenchAgeMax_s;     ///< at least kWrenchSamplesMin samples
    /// Without a sample that guarded moves may see; at least kBlindSamplesMin samples.
    double blind_max_s = kBlindMax_s;
  };

  /// @param kinematics outlives this
  Supervision(const Cell& cell, const ToolKinematics& kinematics, const Parameters& parameters);

  /// Once a cycle. @param following the drives are on and follow setpoints
  /// @return what ends the run
  [[nodiscard]] std::optional<Ending> update(const ArmFeedback& feedback, bool following);

  /// For so many cycles guarded moves take no samples; the bounds on force and torque go on.
  void distrust_samples(int cycles) { distrusted_cycles_ = cycles; }
  /// From now on the mean raw reading means no contact, and the force is watched.
  /// @return that it cannot be so: without the payload it is not what the cell knows as the bias
  [[nodiscard]] std::optional<Ending> tare(const Vector6& mean_raw);
  /// What the sensor reads while nothing touches has moved so far, in its axes, N and Nm.
  void move_zero(const Vector6& by) { wrench_.move_zero(by); }
  /// Once a cycle, after update(): the velocity commanded to the tool, task axes, and the joints'
  /// positions.
  void commanded(const Vector6& velocity, const JointVector& position) {
    wrench_.commanded(velocity);
    following_watch_.commanded(position);
    encoder_watch_.commanded(position);
  }

  /// Every joint has answered at least once.
  [[nodiscard]] bool known() const { return known_; }
  [[nodiscard]] bool tared() const { return tared_; }
  [[nodiscard]] const JointVector& joints() const { return joints_; }
  [[nodiscard]] const Pose& tool() const { return tool_; }
  /// External wrench, task axes at the tool tip; of the last good sample.
  [[nodiscard]] const Vector6& wrench() const { return wrench_.external(); }
  /// The same in the sensor's axes about its origin, where its noise is what the data sheet says.
  [[nodiscard]] const Vector6& contact_at_sensor() const { return wrench_.contact(); }
  /// What the sensor reads, in its axes, as a wrench like wrench().
  [[nodiscard]] Vector6 at_tool(const Vector6& at_sensor) const {
    return wrench_.at_tool(at_sensor, tool_);
  }
  /// At which an arm may stop its drives by itself.
  [[nodiscard]] ForceLimit force_limit() const;
  /// It is a fresh sample, and guarded moves may see it.
  [[nodiscard]] bool wrench_usable() const { return wrench_usable_; }
  /// Cycles since the tare in which guarded moves could see no sample.
  [[nodiscard]] std::uint64_t blind_cycles() const { return blind_cycles_; }
  /// Largest external force and torque since the tare, N and Nm.
  [[nodiscard]] double peak_force_N() const { return peak_force_N_; }
  [[nodiscard]] double peak_torque_Nm() const { return peak_torque_Nm_; }

 private:
  [[nodiscard]] std::optional<Ending> take_joints(const ArmFeedback& feedback);
  [[nodiscard]] std::optional<Ending> take_wrench(const ArmFeedback& feedback);
  [[nodiscard]] std::optional<Ending> watch_following(const ArmFeedback& feedback, bool following);
  [[nodiscard]] std::optional<Ending> watch_arm(const ArmFeedback& feedback, bool following) const;
  [[nodiscard]] std::optional<Ending> watch_force(const ArmFeedback& feedback);
  [[nodiscard]] Ending with_laggard(Ending ending) const;

  Cell cell_;
  const ToolKinematics& kinematics_;
  Parameters parameters_;
  WrenchEstimator wrench_;
  FrozenWatch frozen_watch_;
  FollowingWatch following_watch_;
  EncoderWatch encoder_watch_;

  JointVector joints_{};
  std::array<int, kMaxJoints> misses_{};
  bool known_ = false;
  Pose tool_;
  bool tared_ = false;
  double wrench_age_s_ = 0.0;
  int distrusted_cycles_ = 0;
  bool wrench_usable_ = false;
  double blind_s_ = 0.0;
  std::uint64_t blind_cycles_ = 0;
  double peak_force_N_ = 0.0;
  double peak_torque_Nm_ = 0.0;
};

}  // namespace tenon::executor

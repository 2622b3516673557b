#pragma once
// Whether brakes hold. Remembers where each joint stood as its drive went off, and how far it has
// moved since; a joint that moved as the power went may roll out. One that goes on moving steadily
// within its play creeps, and should be watched until it is beyond. Of a joint that does not answer
// it knows nothing, and says so. Real-time, one thread, no allocation.

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>

#include "executor/faults/fault_bounds.h"
#include "executor/states/brake_slip.h"
#include "shared/cell/robot.h"
#include "shared/ports/arm.h"

namespace tenon::executor {

class BrakeWatch {
 public:
  struct Parameters {
    double play_rad = 2e-3;  ///< that a joint may move with its brake closed
    double play_m = 5e-4;
    double roll_out_s = 0.1;         ///< as far as it came in this time before, it may roll out
    double creep_s = kBrakeCreep_s;  ///< what moves by its play within this time, creeps
  };

  /// Copies what it needs of the robot.
  BrakeWatch(const Robot& robot, const Parameters& parameters);

  /// Once a cycle, from the first one. @param measured m or rad
  /// @param fresh bit i: joint i has answered in this cycle
  /// @param off bit i: and its motor has no power
  void update(const JointVector& measured, std::uint32_t fresh, std::uint32_t off);

  /// Its encoder has jumped, and it has not moved. Before the update() of the same answers.
  void shift(int joint, double by);

  /// The first joint whose drive is off and that has moved further than a brake lets it.
  [[nodiscard]] std::optional<BrakeSlip> slip() const;
  /// A joint whose drive is off has moved on in the last quarter of a second as in the one before:
  /// in the same direction, by at least half as much, and so fast that it is through its play
  /// within creep_s.
  [[nodiscard]] bool creeps() const;
  /// Bit i: whether joint i's brake holds is not known. Its drive never said that it is off, or it
  /// does not answer any more.
  [[nodiscard]] std::uint32_t unwatched() const;
  /// In a row without an answer of this joint.
  [[nodiscard]] int silent_cycles(std::size_t joint) const { return joints_[joint].silent_cycles; }

 private:
  struct JointWatch {
    double play = 0.0;         ///< m or rad
    double position = 0.0;     ///< of its last answer
    double trailing = 0.0;     ///< behind the position by roll_out_s
    double off_at = 0.0;       ///< where it stood
    double bound = 0.0;        ///< how far it may be from there
    double creep = 0.0;        ///< way in a window that is one of a brake that does not hold
    double window_from = 0.0;  ///< where its last window began
    double window_way = 0.0;   ///< way of the last whole window
    int window_cycles = 0;     ///< of the one that is not whole
    bool creeps = false;
    int silent_cycles = 0;
    bool known = false;  ///< it has answered
    bool off = false;    ///< by its last answer
  };

  void take(JointWatch& joint, double position, bool off) const;
  void watch_creep(JointWatch& joint) const;

  std::size_t joint_count_;
  int window_cycles_;
  double catching_up_;  ///< share of its distance that `trailing` makes up for in a cycle
  std::array<JointWatch, kMaxJoints> joints_{};
};

}  // namespace tenon::executor

#pragma once
// Whether drives still measure their efforts. A current sensor that is stuck, and a feedback that
// maps what nobody updates, report one value again and again. So does a drive that is well: at
// rest, and in even motion, where it has less noise than a count. What tells them apart:
//
//   - A drive that has shown noise at rest, in a tare that was steady, cannot be without it in
//     motion: there it may repeat itself for as long as that noise makes likely.
//   - Of any other, gravity, inertia and friction have to change its effort: it may repeat itself
//     until the model says that it must have changed by twice what both ends may be off by.
//
// Both ask for motion: at rest nobody is ever named. Real-time, one thread, no allocation.

#include <array>
#include <cstddef>
#include <optional>

#include "executor/faults/fault_bounds.h"
#include "shared/cell/cell.h"
#include "shared/ports/arm.h"

namespace tenon::executor {

class EffortWatch {
 public:
  struct Frozen {
    int joint = 0;
    int cycles = 0;  ///< of its motion, in a row
  };

  /// Further than its encoder rounds and its lowest bits flicker: the joint moves.
  static constexpr double kMoves_counts = 2.0;
  /// By so many residuals of friction's identification the model has to have moved.
  static constexpr double kSure = 4.0;
  /// The model, by differences of counts, is smoothed over so many cycles of a motion.
  static constexpr int kSmoothed = 8;

  /// @param cell with joint_torque
  explicit EffortWatch(const Cell& cell);

  /// A tare begins, or begins again: from now on joints rest, and show what noise they have.
  void begin_tare();
  /// It was steady.
  void end_tare();
  /// Drives that do not follow may report what they like.
  void let_go();

  /// Once a cycle in which all joints have answered and follow.
  /// @param commanded what they follow, m or rad
  /// @param external  efforts less gravity, inertia and friction, N or Nm (joint_torque_wrench.h):
  /// where an effort stands still, it is the model that moves
  /// @return the first joint whose effort cannot be measured any more
  [[nodiscard]] std::optional<Frozen> update(const ArmFeedback& feedback,
                                             const JointVector& commanded,
                                             const JointVector& external);

  /// The drive has shown noise: what it reports may be equal for so many cycles; 0: any number.
  [[nodiscard]] int cycles_max(std::size_t joint) const { return watched_[joint].cycles_max; }

 private:
  /// Too few say little.
  static constexpr int kPairsLeast = 100;
  struct Watched {
    double moves = 0.0;     ///< m or rad
    double residual = 0.0;  ///< N or Nm
    double effort = 0.0;    ///< the last
    int pairs = 0;          ///< of the tare
    int repeats = 0;        ///< of them
    int cycles_max = 0;
    // Since its effort has been the same:
    int same = 0;            ///< cycles
    int cycles = 0;          ///< of them in which it moved
    double position = 0.0;   ///< where it last was seen to move
    double commanded = 0.0;  ///< likewise
    double smoothed = 0.0;   ///< what the model leaves
    double low = 0.0;        ///< of that
    double high = 0.0;       ///< likewise
    bool has_model = false;
  };

  [[nodiscard]] bool is_frozen(const Watched& watched) const;

  std::size_t count_;
  bool known_ = false;  ///< there is an effort to compare with
  bool taring_ = false;
  bool identified_;
  std::array<Watched, kMaxJoints> watched_{};
};

}  // namespace tenon::executor

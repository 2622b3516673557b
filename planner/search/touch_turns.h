#pragma once
// Faces to touch one after the other, each with what the last one has left uncertain: where
// rotations are uncertain too, and a press against a flat face settles several axes at once.
// Offline; one thread.

#include <Eigen/Geometry>
#include <functional>
#include <limits>
#include <optional>
#include <vector>

#include "planner/belief/belief_summary.h"
#include "planner/belief/successor.h"
#include "planner/search/guide.h"
#include "planner/search/touch_places.h"
#include "shared/ports/rollout.h"
#include "shared/task/task.h"

namespace tenon::planner {

class TouchTurns {
 public:
  /// @param start its particles are what the touches have to hold for
  /// @param succ with the moves of a plan  @param rollout asked for collisions only
  /// @param stop asked before every push where not empty
  TouchTurns(const Task& task, const Belief& start, const Pose& clear, SuccessorEngine& succ,
             Rollout& rollout, const std::function<bool()>& stop);

  /// Guides, first those that reach the goal's certainty, with the least uncertain on the way. At
  /// every turn each side of each shape is pushed against with the tool's origin over it: where it
  /// is flat, first what is wider than what is uncertain across the push, else where it is round;
  /// and where pressed it holds nowhere, once more as a plain touch, which settles no rotation. Of
  /// the touches that free legs lead to the two go on that leave the least, until the goal's
  /// certainty is reached or no touch adds to it.
  [[nodiscard]] std::vector<Guide> find();

 private:
  /// A belief, and how it came about.
  struct Turn {
    Belief belief;
    std::vector<ContactAttractor> contacts;
    double left = 0.0;
    double passed = 0.0;               ///< the sum of what was left on the way
    Vector6 before = Vector6::Zero();  ///< spread with which the last touch began
  };

  struct Push {
    int axis = 0;
    int sign = 1;
    bool plain = false;  ///< see Primitive
  };

  using Matrix6 = Eigen::Matrix<double, 6, 6>;

  [[nodiscard]] Belief over_goal(const Belief& belief) const;
  [[nodiscard]] Matrix6 covariance(const Belief& belief) const;
  [[nodiscard]] double left_of(const Belief& belief) const;
  [[nodiscard]] bool certain(const Belief& belief) const;
  void sort(std::vector<Turn>& turns) const;
  void further(const Turn& turn, std::vector<Turn>& next);
  /// @return whether one of them is worth it
  bool touch_sides(const Turn& turn, const Shape& shape, const Push& push, std::vector<Turn>& next);
  [[nodiscard]] Vector6 spread_at(const Pose& place, const Turn& turn) const;
  /// The last free place on the way to a side. Empty where the way is not free, or nothing is met.
  [[nodiscard]] std::optional<Pose> met_at(const TouchPlace& side, int axis, int sign);
  bool touch(const Turn& turn, const TouchPlace& side, const Push& push, std::vector<Turn>& next);
  [[nodiscard]] std::vector<Turn> best_of(std::vector<Turn> turns);
  [[nodiscard]] bool in_legs(const Turn& turn);
  [[nodiscard]] bool in_moves(const Turn& turn);
  [[nodiscard]] bool stopped() const { return stop_ && stop_(); }

  const Task& task_;
  Belief start_;
  Pose clear_;
  Eigen::AlignedBox3d part_;
  /// Of a deviation, m or rad; of what is no coordinate anything.
  Vector6 enough_ = Vector6::Constant(std::numeric_limits<double>::infinity());
  SuccessorEngine& succ_;
  Rollout& rollout_;
  const std::function<bool()>& stop_;
};

/// Whether touches in turn leave no more uncertain at the goal than it takes.
[[nodiscard]] bool settles(const Guide& guide, const Task& task);

}  // namespace tenon::planner

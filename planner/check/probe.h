#pragma once
// Asks the rollouts' geometry where a part is free, what it overlaps, and how far it can go. So a
// check knows every kind of shape, and agrees with what will simulate. One thread at a time.

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "shared/ports/rollout.h"
#include "shared/task/task.h"

namespace tenon::planner {

using MakeRollout = std::function<std::unique_ptr<Rollout>(const Task& task)>;

/// A held and an environment's shape that stand in one another. Pieces of a ring or a mesh have the
/// name of the whole, here and below.
struct Overlap {
  std::string held;
  std::string environment;
  double depth_m = 0.0;  ///< the shortest way along an axis of the task frame that parts the two
  int axis = 0;          ///< of that way
  int sign = 1;
};

/// What Probe::way_to_touch() is good to.
inline constexpr double kWayKnownTo_m = 1e-5;

class Probe {
 public:
  Probe(const Task& task, MakeRollout make);

  /// Whether the part, as large as it may be, stands free.
  [[nodiscard]] bool free(const Pose& tool) { return !all_->in_collision(tool); }

  /// The deepest overlap; none where the part stands free.
  [[nodiscard]] std::optional<Overlap> deepest(const Pose& tool);

  /// Which shape of the environment the part meets at a pose: the first that overlaps, or none.
  [[nodiscard]] std::string met_at(const Pose& tool);

  /// How far the tool goes from a free pose along axis * sign until the part touches, m;
  /// none where it goes all of `reach_m`.
  [[nodiscard]] std::optional<double> way_to_touch(const Pose& from, int axis, int sign,
                                                   double reach_m);

  /// No wall of the environment is so thin that the part steps over it.
  [[nodiscard]] double stride_m() const { return stride_m_; }

 private:
  struct Pair {
    const Shape* held;
    const Shape* environment;
    std::unique_ptr<Rollout> rollout;
  };
  void make_pairs();

  const Task task_;
  MakeRollout make_;
  std::unique_ptr<Rollout> all_;
  std::vector<Pair> pairs_;  ///< made when first asked for
  double extent_m_ = 0.0;    ///< farther than that no two shapes can stand in one another
  double stride_m_ = 0.0;
};

/// The pose, moved along one axis of the task frame.
[[nodiscard]] Pose moved(const Pose& pose, int axis, double way_m);

}  // namespace tenon::planner

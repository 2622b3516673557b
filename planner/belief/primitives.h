#pragma once
// The guarded moves that the search may choose from. Every displacement is a value that a plan file
// can hold (32-bit float), so that what is searched is what is written.

#include <optional>
#include <vector>

#include "planner/belief/belief.h"
#include "shared/task/task.h"

namespace tenon::planner {

struct Primitive {
  int label = 0;  ///< 2a: + along axis a, 2a + 1: -; kDirectLabel + i: straight to goal attractor i
  Vector6 displacement = Vector6::Zero();
  bool plain = false;  ///< what it meets is held as it was met, see MoveParameters::aligns
};

inline constexpr int kDirectLabel = 12;

/// Of a step's or a long push's label.
[[nodiscard]] inline int axis_of(const Primitive& push) { return push.label / 2; }
[[nodiscard]] inline int sign_of(const Primitive& push) { return push.label % 2 == 0 ? 1 : -1; }

/// The coordinates that moves go along: those that yield. The others are free at the goal.
[[nodiscard]] CoordinateMask moved_axes(const Task& task);

/// + and - one step along every coordinate that moves go along.
[[nodiscard]] std::vector<Primitive> step_primitives(const Task& task);

/// + and - one long step along every translation of the search, for the attractor search.
[[nodiscard]] std::vector<Primitive> long_primitives(const Task& task);

/// A displacement along the task's axes, in those of a move that begins at a pose
/// (ParameterSet::carried_axes).
[[nodiscard]] Vector6 in_move_axes(const Task& task, const Pose& tool, const Vector6& displacement);

/// From the belief's mean straight to a place, along what moves go along. A lattice cannot land
/// on an arbitrary goal; this can. Empty where the place is beyond direct_reach_m, or already met.
[[nodiscard]] std::optional<Primitive> direct_primitive(const Task& task, const Pose& mean,
                                                        const Pose& place,
                                                        int label = kDirectLabel);

/// The value that comes back after storing it as a 32-bit float.
[[nodiscard]] Vector6 stored(const Vector6& value);

}  // namespace tenon::planner

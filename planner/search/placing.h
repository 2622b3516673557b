#pragma once
// A belief's spread put about another place, and how far the held part reaches. One thread.

#include <Eigen/Geometry>
#include <vector>

#include "planner/belief/belief.h"
#include "shared/ports/rollout.h"
#include "shared/task/task.h"

namespace tenon::planner {

/// Corners of a box, along the axes that the shapes' poses are given in, around all of them.
[[nodiscard]] Eigen::AlignedBox3d around(const std::vector<Shape>& shapes);

/// Every particle as far from a place as it is from the belief's mean, touching nothing; empty
/// where one of them would collide. @param rollout asked for collisions only
[[nodiscard]] Belief spread_about(const Pose& place, const Belief& belief, const Pose& mean,
                                  Rollout& rollout);

/// The straight move that leaves a belief's particles least off a place, in the axes of the move.
/// Where these are carried (Task::motion), each particle is taken there in axes of its own: one
/// that is turned goes as far, but not as far along the task's axes, so that what brings the mean
/// there would leave the others off to one side. Only along what moves go along.
[[nodiscard]] Vector6 aimed(const Pose& place, const Belief& belief, const Task& task);

/// Every particle where that move through free space has it, touching nothing. Unlike
/// spread_about(), what rotations are uncertain by counts as much as the place is away from what
/// they turn about. Nothing is asked for collisions.
[[nodiscard]] Belief moved_to(const Pose& place, const Belief& belief, const Task& task);

/// By how much more than its origin a turned part is off along each axis, at most.
/// @param spread m and rad, by axis  @param part around it, tool frame
[[nodiscard]] Vector3 turned_aside_m(const Vector6& spread, const Eigen::AlignedBox3d& part);

}  // namespace tenon::planner

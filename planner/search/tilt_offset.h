#pragma once
// What a tilt that no coordinate describes makes of a contact on the way to the goal. Pure; any
// thread.

#include "shared/math/pose.h"
#include "shared/task/task.h"

namespace tenon::planner {

/// How far a contact's coordinate may be off at the goal's mouth: the task's tilt (`tilt_rad`)
/// times the way from the contact to there across the push, along what the tilt couples with it.
/// @param axis 0..2 of the push, or a rotation, for which it is none
/// @param contact, mouth the tool's poses
/// @return m; 0 where it is small beside what may be left at the goal
[[nodiscard]] double tilt_offset_m(const Task& task, int axis, const Pose& contact,
                                   const Pose& mouth);

}  // namespace tenon::planner

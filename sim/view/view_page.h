#pragma once
// The page on which a cell is looked at, and a moment as it reads it; shared/drawing/page/README.md
// has the keys. Everything on it stands in the nominal task frame, where the robot believes the
// environment to be. Pure; any thread.

#include <cstddef>
#include <string>

#include "shared/math/pose.h"
#include "shared/task/task.h"
#include "sim/cell/virtual_arm/cell_moment.h"

namespace tenon::sim {

struct ViewedWorld {
  Task task;          ///< as it really is, sizes and all
  std::string start;  ///< a start of it; empty: the first
  std::string cell;   ///< its name
  Pose X_BT;          ///< nominal task frame in the base
  Pose X_BE;          ///< where the environment's really stands
  std::size_t drives = 0;
  std::string run_id;  ///< differs from that of every other run
};

[[nodiscard]] std::string view_page(const ViewedWorld& world);

/// Where the part is, in the nominal task frame.
[[nodiscard]] Vector3 position_m(const CellMoment& moment, const Pose& X_BT);

/// One line. @param dropped moments so far that did not get this far
[[nodiscard]] std::string moment_json(const CellMoment& moment, const Pose& X_BT,
                                      std::size_t dropped);

}  // namespace tenon::sim

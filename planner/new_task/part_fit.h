#pragma once
// How one part goes into another: what two solids and the place of one in the other tell. Pure.

#include <array>
#include <memory>
#include <optional>

#include "shared/geometry/solid.h"
#include "shared/math/pose.h"

namespace tenon::planner {

struct PartFit {
  double overlap_m = 0.0;  ///< as assembled; 0 where they are free of each other
  /// The straight way out, in the frame of the socket's file; absent where there is none.
  std::optional<Vector3> way_out;
  double depth_m = 0.0;  ///< along it until the plug is free to move aside
  double clear_m = 0.0;  ///< along it until the plug is past everything
  /// Whose z is the way out, in the socket's file, see part_frame().
  Eigen::Quaterniond frame = Eigen::Quaterniond::Identity();
  /// What the plug can move aside, both ways together, half-way in: along x and y of the frame.
  std::array<double, 2> play_m{};
  /// How far it may stand turned about each of them as it sits there, either way: askew by its play
  /// over its depth; about the way out as far as it is free half-way in. At most kMostTurn_rad.
  std::array<double, 3> turn_rad{};
  /// Turned about the way out it would not go in.
  bool yaw_matters = false;
};

/// Overlaps up to this are parts that touch, m.
inline constexpr double kTouching_m = 50e-6;

/// A part that is free to turn by more is loose, rad.
inline constexpr double kMostTurn_rad = 0.2;

/// @param X_SP the plug's file in the socket's
[[nodiscard]] PartFit fit_of(const std::shared_ptr<const Solid>& plug,
                             const std::shared_ptr<const Solid>& socket, const Pose& X_SP);

}  // namespace tenon::planner

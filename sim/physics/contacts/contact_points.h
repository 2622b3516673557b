#pragma once
// What becomes of raw contact points before the solver sees them. Private to sim.

#include <ode/ode.h>

#include <cstddef>
#include <vector>

namespace tenon::sim {

/// The most points that one face keeps.
inline constexpr std::size_t kPointsAFace = 9;

/// Where many shapes make up one face (the boxes of a round hole), their points are many and mostly
/// the same: of points on one plane only the outermost in eight directions and the deepest stay.
/// The order stays as it was. Points on a face with no more than kPointsAFace are all kept.
void thin_out(std::vector<dContactGeom>& points);

/// For a part that cannot rotate, one point stands for a face: of points on one plane only the
/// deepest stays. Its force is that of the face, and a solver has a fraction of the work.
void keep_deepest(std::vector<dContactGeom>& points);

/// Of points on surfaces of any form, which may touch in many places at once, at most this many.
inline constexpr std::size_t kPointsMax = 14;
/// Keeps the deepest point of every plane, then the next deepest of each, until there are so many.
void keep_some(std::vector<dContactGeom>& points);

/// The part of its face's stiffness that a point gets: in proportion to its depth, and
/// as if it were alone on the face where the others only graze. So the force of a tilted face does
/// not jump when another of its corners comes into reach, and does not depend on how many points
/// stand for it. Normals at right angles are different faces; the adjoining sides of a round hole
/// count as cos^2 of the angle between them, so that it is about as stiff in every direction.
[[nodiscard]] double share(const std::vector<dContactGeom>& points, std::size_t index);

}  // namespace tenon::sim

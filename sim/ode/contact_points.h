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

/// For every point, among how many the stiffness of the face is shared out that it pushes on: the
/// sum of cos^2 of the angles to all normals on its side. Points of one flat face count 1 each and
/// those of walls at right angles nothing; the adjoining sides of a round hole count in part, so
/// that it is about as stiff in every direction.
[[nodiscard]] std::vector<double> sharers(const std::vector<dContactGeom>& points);

}  // namespace tenon::sim

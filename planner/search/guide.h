#pragma once
// What leads the search towards certainty: contacts in turn, then the goal. Plain data; any thread.

#include <optional>
#include <vector>

#include "shared/math/pose.h"
#include "shared/plan/plan.h"

namespace tenon::planner {

/// A push along one axis after which the particles stand together along it: contact with a face, or
/// the loss of one at its edge. A part that lies flat on a face then stands as the face does, too.
struct ContactAttractor {
  int axis = 0;
  int sign = 1;         ///< of the push along it
  Pose mean;            ///< of the belief after the push
  double spread = 0.0;  ///< along the axis after the push, m or rad
  double uncertainty_m2 = 0.0;
  bool face = true;  ///< all particles touch there; else some of them slid off an edge
  /// Where a push must begin that would miss a small face from elsewhere; the coordinate along the
  /// axis does not count. Empty for a face that may be met anywhere.
  std::optional<Pose> via;
  CoordinateMask after = 0;  ///< what contacts before it must have settled
  bool in_legs = true;       ///< some straight legs lead from the start to there
  CoordinateMask flat = 0;   ///< rotations that the push settles besides
  double tilt_off_m = 0.0;   ///< see tilt_offset.h
  /// Held as it is met, see Primitive, by who follows the guide to the letter: pressed, the part
  /// slides or rolls off. The search's own moves press.
  bool plain = false;
};

/// Where an inadmissible heuristic leads: to contacts in turn, then past goal attractors, of which
/// the last is the goal.
struct Guide {
  std::vector<ContactAttractor> contacts;
  std::vector<Pose> goals;
  /// What the contacts cost is several times what the anchor knows of, and a guide leads only while
  /// it is within w2 of the anchor: so that part of it is scaled down to begin there.
  double contact_scale = 1.0;
};

}  // namespace tenon::planner

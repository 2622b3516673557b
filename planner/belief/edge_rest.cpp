#include "planner/belief/edge_rest.h"

namespace tenon::planner {
namespace {

// A part that is pressed this much farther into a face collides with it.
constexpr double kPressed_m = 0.3e-3;

bool is_among(std::uint8_t axes, int axis) { return (axes >> axis & 1U) != 0; }

}  // namespace

bool rests_at_edge(const Particle& particle, std::uint8_t axes, Rollout& rollout) {
  for (int axis = 0; axis < 3; ++axis) {
    const int environment = particle.signature.sign(axis);
    if (environment == 0 || !is_among(axes, axis)) continue;
    Pose pressed = particle.tool();
    pressed.position_m[axis] -= environment * kPressed_m;
    // A smaller part may stand that far off where the largest would; there is nothing to be said.
    if (!rollout.in_collision(pressed)) continue;
    for (int along = 0; along < 3; ++along) {
      if (along == axis || !is_among(axes, along)) continue;
      for (const double way_m : {-kEdge_m, kEdge_m}) {
        Pose shifted = pressed;
        shifted.position_m[along] += way_m;
        if (!rollout.in_collision(shifted)) return true;
      }
    }
  }
  return false;
}

}  // namespace tenon::planner

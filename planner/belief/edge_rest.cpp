#include "planner/belief/edge_rest.h"

namespace tenon::planner {
namespace {

// A part that is pressed this much farther into a face collides with it; into a steep one, so much.
constexpr double kPressed_m = 0.3e-3;
constexpr double kPressedSteeply_m = 1e-3;

bool is_among(std::uint8_t axes, int axis) { return (axes >> axis & 1U) != 0; }

}  // namespace

bool rests_at_edge(const Particle& particle, std::uint8_t axes, Rollout& rollout) {
  for (int axis = 0; axis < 3; ++axis) {
    const int environment = particle.signature.sign(axis);
    if (environment == 0 || !is_among(axes, axis)) continue;
    const auto pressed_by = [&](double depth_m) {
      Pose pressed = particle.tool();
      pressed.position_m[axis] -= environment * depth_m;
      return pressed;
    };
    const Pose pressed = pressed_by(kPressed_m);
    if (!rollout.in_collision(pressed)) {
      if (rollout.in_collision(pressed_by(kPressedSteeply_m))) continue;
      return true;  // what holds it is thinner than the depth of a collision
    }
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

#pragma once
// Whether a part rests so near an edge that another arm, or another engine, would have it fall off.
// Asks the rollout port for collisions only. Any thread, with a rollout of its own.

#include <cstdint>

#include "shared/ports/rollout.h"

namespace tenon::planner {

/// How near: in other engines parts that rest nearer to an edge slip off while they settle.
inline constexpr double kEdge_m = 0.3e-3;

/// Whether a contact that the particle holds along one of the translations of `axes` (bit a: axis
/// a) would be gone if the part stood kEdge_m farther along another of them, either way, or is so
/// slight that the part may go on past it. The part is taken as large as it may be.
[[nodiscard]] bool rests_at_edge(const Particle& particle, std::uint8_t axes, Rollout& rollout);

}  // namespace tenon::planner

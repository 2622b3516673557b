#pragma once

namespace tenon::sim {

/// Where distances from meshes come from: exact, or from a lattice that is many times as fast
/// (Solid::sampled_place()). Other shapes have formulas, which are both.
enum class MeshDistances { kExact, kSampled };

}  // namespace tenon::sim

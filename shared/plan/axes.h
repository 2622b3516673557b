#pragma once
// Sets of a pose's six axes.

#include <cstdint>

namespace tenon {

/// Bit a (0..5: x y z rx ry rz).
using CoordinateMask = std::uint8_t;
[[nodiscard]] constexpr bool has(CoordinateMask mask, int axis) { return (mask >> axis & 1U) != 0; }

}  // namespace tenon

#pragma once
// Draws as JSON, alike wherever they are written. Private to sim.

#include <nlohmann/json_fwd.hpp>

#include "shared/math/pose.h"
#include "sim/cell/virtual_arm/world_draw.h"

namespace tenon::sim {

/// {"x_m": ..., "rz_rad": ...}
[[nodiscard]] nlohmann::ordered_json by_axis(const Vector6& value);

[[nodiscard]] nlohmann::ordered_json world_json(const WorldDraw& world);

}  // namespace tenon::sim

#pragma once
// Arms without a force sensor whose drives have friction, and what is identified of it over CAN.

#include <cstdint>
#include <string>

#include "executor/identification/identify_friction.h"
#include "shared/cell/cell.h"
#include "sim/cell/virtual_arm/world_draw.h"

namespace tenon::tests {

/// The text of a cell of the tree that takes its force from the joints.
/// @param friction the file that the cell names; empty: nothing identified
[[nodiscard]] std::string torque_cell_text(const std::string& name, const std::string& friction);
/// The same, loaded; nothing identified.
[[nodiscard]] Cell torque_cell(const std::string& name);

/// A world as it should be but for its drives: friction of `low` to `high` of their rated effort.
[[nodiscard]] sim::WorldDraw rough_world(double low, double high, std::uint64_t seed);

/// What --identify-friction finds on the virtual arm of that world, in lockstep.
[[nodiscard]] executor::FrictionIdentification identified(const Cell& cell,
                                                          const sim::WorldDraw& world);

}  // namespace tenon::tests

#pragma once
// What a run is measured by, and what its bus did, as messages. Pure; allocates, not for real time.

#include <cstdint>

#include "shared/cell/cell.h"
#include "shared/plan/plan.h"
#include "shared/ports/can_bus.h"

namespace tenon {
class run_setup_t;
class run_status_t;
}  // namespace tenon

namespace tenon::executor {

/// @param plan null where none runs
[[nodiscard]] tenon::run_setup_t setup_message(const Cell& cell, const Plan* plan);

/// The bus's part of a status. @param before what the last status told  @param since_s since then;
/// without (0 or less) no rates are told
void tell_bus(const CanBusTraffic& now, const CanBusTraffic& before, double since_s,
              std::uint32_t bitrate_bps, tenon::run_status_t& message);

}  // namespace tenon::executor

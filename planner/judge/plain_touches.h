#pragma once
// Which touches of a plan need not press the part flat. Pure; any thread.

#include <optional>
#include <span>

#include "planner/judge/chain.h"
#include "shared/plan/plan.h"

namespace tenon::planner {

/// A plan as drafted, in which the steps after which the part is turned as uncertainly as before do
/// not align (ParameterSet::aligns): what a press does not settle it can only disturb, a round part
/// above all, which rolls on the face that it is pressed against.
/// @param chains of `draft`'s particles, all to its end
/// @return empty where nothing changes: no rotation yields, or every touch settles one
[[nodiscard]] std::optional<Plan> with_plain_touches(const Plan& draft,
                                                     std::span<const Chain> chains);

}  // namespace tenon::planner

#pragma once
// How far each step of a plan may go at approach speed before it slows down for a contact. Pure;
// any thread.

#include <span>
#include <vector>

#include "planner/judge/chain.h"
#include "shared/plan/plan.h"

namespace tenon::planner {

/// The command is down to contact speed this far before the nearest contact that was seen.
inline constexpr double kSlowMargin_m = 0.030;

/// How far each step may go at approach speed: up to a margin before the nearest contact that any
/// of the chains made, all the way where none made one. Contacts of all sorts count, releases too.
/// @param particle_sigmas how many standard deviations out the chains start; infinite: keep nothing
/// in hand for starts beyond them
[[nodiscard]] std::vector<double> slow_from(const Plan& plan, std::span<const Chain> chains,
                                            double particle_sigmas);

/// The plan with these distances, one a step (m), as it comes back from its bytes.
[[nodiscard]] Plan with_slow_from(Plan plan, std::span<const double> distances_m);

/// Whether any step of these distances begins at approach speed.
[[nodiscard]] bool any_fast(std::span<const double> distances_m);

/// Lowers the distances of those steps in which a drawn chain met a contact before the tool was
/// slow: nearer than half the margin.
/// @param plan as the chains went through it  @return whether there was such a step
bool shorten(const Plan& plan, std::span<const Chain> drawn, std::vector<double>& distances_m);

}  // namespace tenon::planner

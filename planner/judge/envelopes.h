#pragma once
// What a plan may expect of each step: the outcomes and displacements that its chains showed.

#include <span>

#include "planner/judge/chain.h"
#include "shared/plan/plan.h"
#include "shared/task/task.h"

namespace tenon::planner {

/// By how much an envelope exceeds what was seen.
struct EnvelopeMargins {
  double position_m = 0.0;
  double angle_rad = 0.0;
};

/// Whether a plan with these coordinates says where its steps end: those with rotations do.
[[nodiscard]] constexpr bool places_are_told(CoordinateMask coordinates) {
  return coordinates >> 3 != 0;
}

/// kSensor_m for encoders and calibration, contact speed times latency for a contact that is
/// noticed late, and F_keep mu_max / K for what friction keeps of a slide; the same for rotations.
[[nodiscard]] EnvelopeMargins envelope_margins(const Plan& plan, const Task& task);

/// `draft` with rules from chains that all ended at the goal: every outcome that a step had leads
/// on, every other fails; a range spans what was seen and the margins. Where a step was both
/// stopped by a contact and not, a contact may come anywhere up to the whole displacement. Plans
/// with rotations check places too: how a part is turned shifts all moves that follow, and what
/// travels allow adds up to far more than what is seen. How far a press turns a part hangs on where
/// exactly the two meet and on what the torque sensor is wrong by, which no chain has: an angle
/// about which a press is seen to turn the part may be larger by as much as the environments of the
/// chains are turned. One that a press is not seen to change shows that the part lay flat.
[[nodiscard]] Plan with_envelopes(const Plan& draft, const Task& task,
                                  std::span<const Chain> chains);

/// Whether none of the chains leaves the plan's envelopes anywhere.
[[nodiscard]] bool stay_within(const Plan& plan, std::span<const Chain> chains);

}  // namespace tenon::planner

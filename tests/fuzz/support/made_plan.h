#pragma once
// For targets that read what is told of a run: the plan that it ran.

#include "shared/plan/plan.h"
#include "tests/support/hand_made.h"

namespace tenon::fuzz {

/// In all six coordinates: where its tool ends is laid onto the goal by turning too.
[[nodiscard]] inline Plan made_plan() {
  Plan plan = executor::touch_and_slide_plan();
  plan.coordinates = 0x3F;
  return plan;
}

}  // namespace tenon::fuzz

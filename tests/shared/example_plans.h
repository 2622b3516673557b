#pragma once
// Plans to encode: the one that FORMAT.md spells out, and realistic ones of any size.

#include <cstddef>
#include <cstdint>
#include <initializer_list>

#include "shared/plan/plan.h"

namespace tenon::tests {

/// The three moves at the end of shared/plan/FORMAT.md.
inline Plan documented_plan() {
  Plan plan;
  plan.task_name = "box_on_table_2d";
  plan.start_name = "1";
  plan.task_hash = 0x32C5A4C03D383653;
  plan.coordinates = 0b000011;
  plan.start.position_m = {-0.30, -0.20, 0.002};
  plan.goal.position_m = {0.25, -0.15, 0.002};
  plan.goal_tolerance_m = 2e-3;
  plan.compliance.compliant_axes = 0b000011;
  plan.latency_max_s = 0.007;
  plan.cost = 8250.5;
  plan.bound = 4.0;
  plan.draws = 200;
  plan.draws_at_goal = 199;
  plan.parameter_sets.emplace_back();

  const auto add = [&plan](double x_m, double y_m, double slow_from_m, Outcome outcome,
                           Successor successor, std::uint16_t signature,
                           std::array<double, 4> x_range_y_range) {
    Step step;
    step.displacement.head<2>() << x_m, y_m;
    step.slow_from_m = slow_from_m;
    OutcomeRule& rule = step.outcomes[static_cast<std::size_t>(outcome)];
    rule.successor = successor;
    rule.envelope.always = rule.envelope.possible = {signature};
    rule.envelope.travelled_min.head<2>() << x_range_y_range[0], x_range_y_range[2];
    rule.envelope.travelled_max.head<2>() << x_range_y_range[1], x_range_y_range[3];
    plan.steps.push_back(step);
  };
  const std::uint16_t x = ContactSignature::bit(0, +1);
  const std::uint16_t xy = x | ContactSignature::bit(1, +1);
  add(-0.25, 0.0, 0.07, Outcome::kContact, 1, x, {-0.2431, -0.0569, -0.0012, 0.0012});
  add(0.0, -0.25, 0.07, Outcome::kContact, 2, xy, {-0.0012, 0.0012, -0.2431, -0.0569});
  add(0.7, 0.2, 0.73, Outcome::kReached, kSuccessorDone, 0, {0.6963, 0.7037, 0.1963, 0.2037});
  return plan;
}

/// `steps` moves along the coordinates, two parameter sets, the given outcomes expected of each.
inline Plan long_plan(CoordinateMask coordinates, std::size_t steps,
                      std::initializer_list<Outcome> outcomes) {
  Plan plan = documented_plan();
  plan.coordinates = coordinates;
  plan.compliance.compliant_axes = coordinates;
  plan.start.orientation = rotation_of({0.1, -0.2, 0.3});
  ParameterSet slow;
  slow.speeds.approach_mps = 0.05;
  slow.trigger_mask = {0x000F};
  plan.parameter_sets.push_back(slow);
  plan.steps.clear();
  for (std::size_t i = 0; i < steps; ++i) {
    Step step;
    step.parameter_set = static_cast<std::uint8_t>(i % 2);
    step.slow_from_m = 0.03 + 0.001 * static_cast<double>(i);
    const bool last = i + 1 == steps;
    for (const Outcome outcome : outcomes) {
      OutcomeRule& rule = step.outcomes[static_cast<std::size_t>(outcome)];
      rule.successor = last ? kSuccessorDone : static_cast<Successor>(i + 1);
      rule.envelope.always = {0x0001};
      rule.envelope.possible = {0x0005};
    }
    for (int axis = 0; axis < 6; ++axis) {
      if (!has(coordinates, axis)) continue;
      step.displacement[axis] = 0.1 * (axis + 1) - 0.017 * static_cast<double>(i);
      for (const Outcome outcome : outcomes) {
        Envelope& envelope = step.outcomes[static_cast<std::size_t>(outcome)].envelope;
        envelope.travelled_min[axis] = step.displacement[axis] - 0.0123;
        envelope.travelled_max[axis] = step.displacement[axis] + 0.0321;
      }
    }
    plan.steps.push_back(step);
  }
  return plan;
}

}  // namespace tenon::tests

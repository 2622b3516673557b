#include "planner/judge/envelopes.h"

#include <algorithm>
#include <array>
#include <vector>

namespace tenon::planner {
namespace {

constexpr double kSensor_m = 1e-3;
constexpr double kSensor_rad = 5e-3;

struct Seen {
  bool any = false;
  Envelope envelope;

  /// @param place from where the plan began
  void add(const GuardedMove::Result& move, const Vector6& place) {
    if (!any) {
      envelope = {move.travelled, move.travelled, place, place, move.signature, move.signature};
      any = true;
      return;
    }
    span(move.travelled, place);
    envelope.always.bits &= move.signature.bits;
    envelope.possible.bits |= move.signature.bits;
  }

  void span(const Vector6& travelled, const Vector6& place) {
    envelope.travelled_min = envelope.travelled_min.cwiseMin(travelled);
    envelope.travelled_max = envelope.travelled_max.cwiseMax(travelled);
    envelope.place_min = envelope.place_min.cwiseMin(place);
    envelope.place_max = envelope.place_max.cwiseMax(place);
  }
};

void widen(Vector6& min, Vector6& max, const Vector6& margins, CoordinateMask coordinates) {
  for (int axis = 0; axis < 6; ++axis) {
    if (!has(coordinates, axis)) {
      min[axis] = max[axis] = 0.0;
      continue;
    }
    min[axis] -= margins[axis];
    max[axis] += margins[axis];
  }
}

/// How far the environments are turned at most, about each axis.
Vector3 turned_rad(std::span<const Chain> chains) {
  Vector3 turned = Vector3::Zero();
  for (const Chain& chain : chains) {
    const Vector6 error = displacement_between(Pose{}, chain.start.environment);
    turned = turned.cwiseMax(error.tail<3>().cwiseAbs());
  }
  return turned;
}

/// About which axes presses have been seen to turn the part; of these the margins are as large as
/// its error. Also of later presses, in a plan's order: what the first one leaves on an arm, whose
/// give and sensor are not the plan's, the next one makes good.
class PressedMargins {
 public:
  PressedMargins(const Vector6& margins, const Vector3& turned_rad)
      : margins_(margins), turned_rad_(turned_rad) {}

  [[nodiscard]] Vector6 of(const Envelope& seen) {
    Vector6 margins = margins_;
    for (int axis = 3; axis < 6; ++axis) {
      const double most = std::max(-seen.travelled_min[axis], seen.travelled_max[axis]);
      if (most > margins_[axis]) turns_[static_cast<std::size_t>(axis)] = true;
      if (turns_[static_cast<std::size_t>(axis)]) margins[axis] += turned_rad_[axis - 3];
    }
    return margins;
  }

 private:
  Vector6 margins_;
  Vector3 turned_rad_;
  std::array<bool, 6> turns_{};
};

using SeenByOutcome = std::array<Seen, kOutcomes.size()>;

// Between the tool that just missed the contact and the one that met it there are others.
void close_gap(SeenByOutcome& seen) {
  const Seen& reached = seen[static_cast<std::size_t>(Outcome::kReached)];
  Seen& contact = seen[static_cast<std::size_t>(Outcome::kContact)];
  if (!reached.any || !contact.any) return;
  const Envelope& far = reached.envelope;
  contact.span(far.travelled_min, far.place_min);
  contact.span(far.travelled_max, far.place_max);
}

}  // namespace

EnvelopeMargins envelope_margins(const Plan& plan, const Task& task) {
  EnvelopeMargins margins{kSensor_m, kSensor_rad};
  for (const ParameterSet& set : plan.parameter_sets) {
    const double friction_m =
        task.friction.high * set.thresholds.force_keep_N / plan.compliance.stiffness_Npm;
    // No torque is kept where none is sensed.
    const bool sensed = ((set.sensed_axes & plan.compliance.compliant_axes) >> 3) != 0;
    const double keep_Nm = sensed ? set.thresholds.torque_keep_Nm : 0.0;
    const double friction_rad = task.friction.high * keep_Nm / plan.compliance.stiffness_Nmpr;
    // A torque that counts for none turns a pressed tool as far as the spring gives, and what
    // sensor and frames are wrong by may hide as much again.
    const double give_rad = 2.0 * set.thresholds.torque_off_Nm / plan.compliance.stiffness_Nmpr;
    margins.position_m = std::max(
        margins.position_m, kSensor_m + set.speeds.contact_mps * plan.latency_max_s + friction_m);
    margins.angle_rad =
        std::max(margins.angle_rad, kSensor_rad + set.speeds.contact_radps * plan.latency_max_s +
                                        give_rad + friction_rad);
  }
  return margins;
}

Plan with_envelopes(const Plan& draft, const Task& task, std::span<const Chain> chains) {
  std::vector<SeenByOutcome> seen(draft.steps.size());
  for (const Chain& chain : chains) {
    for (std::size_t i = 0; i < chain.moves.size(); ++i) {
      const GuardedMove::Result& move = chain.moves[i];
      const Vector6 place = displacement_between(chain.start.pose, move.pose);
      seen[chain.steps[i]][static_cast<std::size_t>(move.outcome)].add(move, place);
    }
  }
  const EnvelopeMargins least = envelope_margins(draft, task);
  Vector6 margins;
  margins << Vector3::Constant(least.position_m), Vector3::Constant(least.angle_rad);
  PressedMargins pressed_margins(margins, turned_rad(chains));
  Plan plan = draft;
  plan.check_envelopes = true;
  plan.check_places = places_are_told(plan.coordinates);
  for (std::size_t step = 0; step < plan.steps.size(); ++step) {
    close_gap(seen[step]);
    const bool aligns = plan.parameter_sets[plan.steps[step].parameter_set].aligns;
    for (std::size_t outcome = 0; outcome < kOutcomes.size(); ++outcome) {
      OutcomeRule& rule = plan.steps[step].outcomes[outcome];
      const Seen& one = seen[step][outcome];
      if (one.any) {
        const bool pressed = aligns && kOutcomes[outcome] == Outcome::kContact;
        Envelope& envelope = rule.envelope = one.envelope;
        widen(envelope.travelled_min, envelope.travelled_max,
              pressed ? pressed_margins.of(envelope) : margins, plan.coordinates);
        widen(envelope.place_min, envelope.place_max, margins,
              plan.check_places ? plan.coordinates : 0);
      } else {
        rule = {};
      }
    }
  }
  return plan;
}

bool stay_within(const Plan& plan, std::span<const Chain> chains) {
  return std::all_of(chains.begin(), chains.end(), [&](const Chain& chain) {
    return first_deviation(plan, chain) == chain.moves.size();
  });
}

}  // namespace tenon::planner

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>

#include "shared/base/bytes.h"
#include "shared/base/crc32c.h"
#include "shared/base/error.h"
#include "shared/plan/codec.h"
#include "shared/plan/format.h"

namespace tenon {
namespace {

using namespace plan_format;

float f32(double value) { return static_cast<float>(value); }

// An envelope only ever grows by being stored.
float f32_down(double value) {
  const float nearest = f32(value);
  return nearest > value ? std::nextafter(nearest, -std::numeric_limits<float>::infinity())
                         : nearest;
}
float f32_up(double value) { return -f32_down(-value); }

void write_pose(ByteWriter& out, const Pose& pose) {
  for (int i = 0; i < 3; ++i) out.write(pose.position_m[i]);
  for (int i = 0; i < 4; ++i) out.write(pose.orientation.coeffs()[i]);
}

void write_text(ByteWriter& out, const std::string& text) {
  out.write(static_cast<std::uint8_t>(text.size()));
  for (const char letter : text) out.write(static_cast<std::uint8_t>(letter));
}

std::uint8_t flags_of(const Plan& plan) {
  const unsigned method = static_cast<unsigned>(plan.method) << kMethodShift;
  return static_cast<std::uint8_t>(method | (plan.check_envelopes ? kFlagCheckEnvelopes : 0U) |
                                   (plan.check_places ? kFlagCheckPlaces : 0U));
}

/// The lowest that can hold the plan, so that a plan has one encoding.
std::uint16_t version_of(const Plan& plan) {
  if (plan.goal_axes.any()) return kVersionOfGoalAxes;
  if (plan.check_places) return kVersionOfPlaces;
  const auto& sets = plan.parameter_sets;
  return std::any_of(sets.begin(), sets.end(), has_rotation) ? kVersionOfRotation : kVersion;
}

void write_header(ByteWriter& out, const Plan& plan, std::size_t length) {
  out.write(kMagic);
  out.write(version_of(plan));
  out.write(flags_of(plan));
  out.write(plan.coordinates);
  out.write(static_cast<std::uint32_t>(length));
  out.write(plan.task_hash);
  write_pose(out, plan.start);
  write_pose(out, plan.goal);
  const Compliance& c = plan.compliance;
  for (const double value : {plan.goal_tolerance_m, c.mass_kg, c.damping_Nspm, c.stiffness_Npm,
                             c.inertia_kgm2, c.damping_Nmspr, c.stiffness_Nmpr}) {
    out.write(f32(value));
  }
  out.write(c.compliant_axes);
  for (const double value :
       {plan.force_limit_N, plan.torque_limit_Nm, plan.contact_stiffness_Npm, plan.latency_max_s}) {
    out.write(f32(value));
  }
  out.write(plan.cost);
  out.write(plan.bound);
  out.write(plan.draws);
  out.write(plan.draws_at_goal);
  write_text(out, plan.task_name);
  write_text(out, plan.start_name);
  out.write(static_cast<std::uint8_t>(plan.parameter_sets.size()));
  out.write(static_cast<std::uint8_t>(plan.steps.size()));
  if (version_of(plan) < kVersionOfGoalAxes) return;
  out.write(plan.goal_axes.free);
  for (int axis = 0; axis < 6; ++axis) {
    if (has(plan.coordinates, axis)) out.write(f32(plan.goal_axes.tolerance[axis]));
  }
}

void write_parameter_set(ByteWriter& out, const ParameterSet& set, std::uint16_t version) {
  const SpeedLimits& v = set.speeds;
  const ContactThresholds& t = set.thresholds;
  for (const double value :
       {v.approach_mps, v.contact_mps, v.acceleration_mps2, v.jerk_mps3, v.approach_radps,
        v.contact_radps, v.acceleration_radps2, v.jerk_radps3, t.force_on_N, t.force_keep_N,
        t.force_off_N, t.torque_on_Nm, t.torque_keep_Nm, t.torque_off_Nm}) {
    out.write(f32(value));
  }
  out.write(t.debounce_us);
  out.write(set.timeout_us);
  out.write(set.trigger_mask.bits);
  if (version < kVersionOfRotation) return;
  out.write(set.sensed_axes);
  out.write(static_cast<std::uint8_t>((set.carried_axes ? kFlagCarriedAxes : 0) |
                                      (set.aligns ? 0 : kFlagPlainTouches)));
}

void write_range(ByteWriter& out, const Vector6& min, const Vector6& max,
                 CoordinateMask coordinates) {
  for (int axis = 0; axis < 6; ++axis) {
    if (!has(coordinates, axis)) continue;
    out.write(f32_down(min[axis]));
    out.write(f32_up(max[axis]));
  }
}

void write_step(ByteWriter& out, const Step& step, const Plan& plan) {
  const CoordinateMask coordinates = plan.coordinates;
  unsigned outcomes = 0;
  for (std::size_t i = 0; i < kOutcomes.size(); ++i) {
    if (step.outcomes[i].successor != kSuccessorFail) outcomes |= 1U << i;
  }
  out.write(step.parameter_set);
  out.write(static_cast<std::uint8_t>(outcomes));
  out.write(f32(step.slow_from_m));
  for (int axis = 0; axis < 6; ++axis) {
    if (has(coordinates, axis)) out.write(f32(step.displacement[axis]));
  }
  for (const OutcomeRule& rule : step.outcomes) {
    if (rule.successor == kSuccessorFail) continue;
    const Envelope& envelope = rule.envelope;
    out.write(rule.successor);
    out.write(envelope.always.bits);
    out.write(envelope.possible.bits);
    write_range(out, envelope.travelled_min, envelope.travelled_max, coordinates);
    if (plan.check_places) {
      write_range(out, envelope.place_min, envelope.place_max, coordinates);
    }
  }
}

std::size_t encoded_size(const Plan& plan) {
  const std::uint16_t version = version_of(plan);
  std::size_t size = kHeaderSize + plan.task_name.size() + plan.start_name.size() +
                     goal_axes_size(plan.coordinates, version) +
                     set_size(version) * plan.parameter_sets.size() + kChecksumSize;
  for (const Step& step : plan.steps) {
    size += step_size(plan.coordinates);
    for (const OutcomeRule& rule : step.outcomes) {
      if (rule.successor != kSuccessorFail)
        size += outcome_size(plan.coordinates, plan.check_places);
    }
  }
  return size;
}

void refuse_unless(bool holds, const std::string& what) {
  if (!holds) throw InputError("plan cannot be encoded: " + what);
}

/// What the file has no room for, so that decoding could not notice it.
void check_representable(const Plan& plan) {
  refuse_unless(plan.task_name.size() <= kNameMax && plan.start_name.size() <= kNameMax,
                "a name is longer than 63 bytes");
  refuse_unless(plan.parameter_sets.size() <= kParameterSetsMax,
                std::to_string(plan.parameter_sets.size()) + " parameter sets, at most 200");
  refuse_unless(plan.steps.size() <= kMaxSteps,
                std::to_string(plan.steps.size()) + " steps, at most 200");
  refuse_unless(plan.check_envelopes || !plan.check_places, "places are checked with envelopes");
  for (int axis = 0; axis < 6; ++axis) {
    const bool given = has(plan.goal_axes.free, axis) || plan.goal_axes.tolerance[axis] != 0.0;
    refuse_unless(has(plan.coordinates, axis) || !given,
                  "its goal has a tolerance of axis " + std::to_string(axis) +
                      ", which is not one of the plan's coordinates");
  }
  for (std::size_t i = 0; i < plan.steps.size(); ++i) {
    const Step& step = plan.steps[i];
    for (int axis = 0; axis < 6; ++axis) {
      if (has(plan.coordinates, axis)) continue;
      bool zero = step.displacement[axis] == 0.0;
      for (const OutcomeRule& rule : step.outcomes) {
        if (rule.successor == kSuccessorFail) continue;
        const Envelope& e = rule.envelope;
        zero = zero && e.travelled_min[axis] == 0.0 && e.travelled_max[axis] == 0.0 &&
               e.place_min[axis] == 0.0 && e.place_max[axis] == 0.0;
      }
      refuse_unless(zero, "step " + std::to_string(i) +
                              " has a displacement or an envelope along " + "axis " +
                              std::to_string(axis) +
                              ", which is not one of the plan's coordinates");
    }
  }
}

}  // namespace

std::vector<std::uint8_t> encode_plan(const Plan& plan) {
  check_representable(plan);
  std::vector<std::uint8_t> bytes(encoded_size(plan));
  ByteWriter out(bytes);
  write_header(out, plan, bytes.size());
  const std::uint16_t version = version_of(plan);
  for (const ParameterSet& set : plan.parameter_sets) write_parameter_set(out, set, version);
  for (const Step& step : plan.steps) write_step(out, step, plan);
  out.write(crc32c(std::span<const std::uint8_t>(bytes).first(out.offset())));
  assert(out.ok() && out.remaining() == 0);

  // The decoder alone knows what a valid plan is.
  const DecodedPlan decoded = decode_plan(bytes);
  refuse_unless(decoded.error == PlanError::kNone, decoded.field + ": " + to_string(decoded.error) +
                                                       " (byte " + std::to_string(decoded.offset) +
                                                       ")");
  return bytes;
}

}  // namespace tenon

#include <algorithm>
#include <cmath>
#include <utility>

#include "shared/base/bytes.h"
#include "shared/base/crc32c.h"
#include "shared/motion/rules.h"
#include "shared/plan/codec.h"
#include "shared/plan/field_reader.h"
#include "shared/plan/format.h"

namespace tenon {
namespace {

using namespace plan_format;

constexpr Limits kPosition_m = {-1e3, 1e3};
constexpr Limits kUnit = {-1.0, 1.0};
constexpr Limits kTravel = {-10.0, 10.0};  // m or rad
constexpr Limits kSlowFrom = {0.0, 10.0};
constexpr Limits kTolerance_m = {0.0, 10.0, true};
constexpr Limits kAxisTolerance = {0.0, 10.0};  // m or rad
constexpr Limits kLatency_s = {0.0, 1.0};
constexpr Limits kInertia = {0.0, 1e4, true};
constexpr Limits kSpring = {0.0, 1e7, true};  // dampers too
constexpr Limits kForce = {0.0, 1e4, true};   // torques too
constexpr Limits kContactStiffness_Npm = {0.0, 1e9, true};
constexpr Limits kCost = {0.0, 1e12};
constexpr Limits kSpeed = {0.0, 10.0, true};
constexpr Limits kAcceleration = {0.0, 1e4, true};
constexpr Limits kJerk = {0.0, 1e7, true};
constexpr std::uint32_t kDebounceMax_us = 1'000'000;
constexpr std::uint32_t kTimeoutMax_us = 600'000'000;
constexpr double kQuaternionSlack = 1e-9;

Pose read_pose(FieldReader& in, const char* position, const char* orientation) {
  Pose pose;
  for (int i = 0; i < 3; ++i) pose.position_m[i] = in.f64(position, kPosition_m);
  for (int i = 0; i < 4; ++i) pose.orientation.coeffs()[i] = in.f64(orientation, kUnit);
  if (!(std::abs(pose.orientation.norm() - 1.0) <= kQuaternionSlack)) {
    in.fail(PlanError::kRange, orientation);
  }
  return pose;
}

Compliance read_compliance(FieldReader& in) {
  Compliance c;
  c.mass_kg = in.f32("mass_kg", kInertia);
  c.damping_Nspm = in.f32("damping_Nspm", kSpring);
  c.stiffness_Npm = in.f32("stiffness_Npm", kSpring);
  c.inertia_kgm2 = in.f32("inertia_kgm2", kInertia);
  c.damping_Nmspr = in.f32("damping_Nmspr", kSpring);
  c.stiffness_Nmpr = in.f32("stiffness_Nmpr", kSpring);
  c.compliant_axes = in.whole<std::uint8_t>("compliant_axes", 0, 0x3F);
  return c;
}

ParameterSet read_parameter_set(FieldReader& in, double force_limit_N, std::uint16_t version) {
  ParameterSet set;
  SpeedLimits& v = set.speeds;
  v.approach_mps = in.f32("approach_mps", kSpeed);
  v.contact_mps = in.f32("contact_mps", kSpeed);
  v.acceleration_mps2 = in.f32("acceleration_mps2", kAcceleration);
  v.jerk_mps3 = in.f32("jerk_mps3", kJerk);
  v.approach_radps = in.f32("approach_radps", kSpeed);
  v.contact_radps = in.f32("contact_radps", kSpeed);
  v.acceleration_radps2 = in.f32("acceleration_radps2", kAcceleration);
  v.jerk_radps3 = in.f32("jerk_radps3", kJerk);
  ContactThresholds& t = set.thresholds;
  t.force_on_N = in.f32("force_on_N", kForce);
  t.force_keep_N = in.f32("force_keep_N", kForce);
  t.force_off_N = in.f32("force_off_N", kForce);
  t.torque_on_Nm = in.f32("torque_on_Nm", kForce);
  t.torque_keep_Nm = in.f32("torque_keep_Nm", kForce);
  t.torque_off_Nm = in.f32("torque_off_Nm", kForce);
  // What of rule 5 holds whatever the friction: the order, and the distance to the force limit.
  const ContactConditions without_friction = {.friction_max = 0.0, .contacts_max = 0};
  if (in.ok() && broken_rule(t, force_limit_N, 0.0, without_friction)) {
    in.fail(PlanError::kRange, "thresholds");
  }
  t.debounce_us = in.whole<std::uint32_t>("debounce_us", 0, kDebounceMax_us);
  set.timeout_us = in.whole<std::uint32_t>("timeout_us", 1, kTimeoutMax_us);
  set.trigger_mask = in.signature("trigger_mask");
  if (version < kVersionOfRotation) return set;
  set.sensed_axes = in.whole<std::uint8_t>("sensed_axes", 0, 0x3F);
  const auto flags = in.whole<std::uint8_t>("axes", 0, kSetFlagsMax);
  set.carried_axes = (flags & kFlagCarriedAxes) != 0;
  set.aligns = (flags & kFlagPlainTouches) == 0;
  return set;
}

void read_range(FieldReader& reader, CoordinateMask coordinates, const char* min_name,
                const char* max_name, Vector6& min, Vector6& max) {
  for (int axis = 0; axis < 6; ++axis) {
    if (!has(coordinates, axis)) continue;
    min[axis] = reader.f32(min_name, kTravel);
    max[axis] = reader.f32(max_name, kTravel);
    if (min[axis] > max[axis]) reader.fail(PlanError::kRange, max_name);
  }
}

OutcomeRule read_outcome(FieldReader& reader, const Plan& plan, std::size_t step,
                         std::size_t steps) {
  OutcomeRule rule;
  rule.successor = reader.raw<std::uint8_t>("successor");
  const bool forward = rule.successor > step && rule.successor < steps;
  if (!forward && rule.successor != kSuccessorDone) {
    reader.fail(PlanError::kSuccessor, "successor");
  }
  Envelope& envelope = rule.envelope;
  envelope.always = reader.signature("always");
  envelope.possible = reader.signature("possible");
  if ((envelope.always.bits & ~envelope.possible.bits) != 0) {
    reader.fail(PlanError::kRange, "possible");
  }
  read_range(reader, plan.coordinates, "travelled_min", "travelled_max", envelope.travelled_min,
             envelope.travelled_max);
  if (plan.check_places) {
    read_range(reader, plan.coordinates, "place_min", "place_max", envelope.place_min,
               envelope.place_max);
  }
  return rule;
}

Step read_step(FieldReader& reader, const Plan& plan, std::size_t index, std::size_t steps) {
  Step step;
  step.parameter_set = reader.raw<std::uint8_t>("parameter_set");
  if (step.parameter_set >= plan.parameter_sets.size()) {
    reader.fail(PlanError::kIndex, "parameter_set");
  }
  const auto outcomes = reader.whole<std::uint8_t>("outcomes", 0, (1U << kOutcomes.size()) - 1);
  step.slow_from_m = reader.f32("slow_from_m", kSlowFrom);
  for (int axis = 0; axis < 6; ++axis) {
    if (has(plan.coordinates, axis)) step.displacement[axis] = reader.f32("displacement", kTravel);
  }
  for (std::size_t outcome = 0; outcome < kOutcomes.size(); ++outcome) {
    if ((outcomes >> outcome & 1U) == 0) continue;
    step.outcomes[outcome] = read_outcome(reader, plan, index, steps);
  }
  return step;
}

/// What the whole of the bytes must satisfy before any field is looked at.
DecodedPlan check_frame(std::span<const std::uint8_t> bytes) {
  const auto refused = [](PlanError error, std::size_t offset, const char* field) {
    return DecodedPlan{std::nullopt, error, offset, field};
  };
  if (bytes.size() < kHeaderSize + kChecksumSize) {
    return refused(PlanError::kTooShort, bytes.size(), "header");
  }
  if (load_le<std::uint32_t>(bytes) != kMagic) return refused(PlanError::kMagic, 0, "magic");
  const auto version = load_le<std::uint16_t>(bytes.subspan(4));
  if (version < kVersion || version > kVersionOfGoalAxes) {
    return refused(PlanError::kVersion, 4, "version");
  }
  if (load_le<std::uint32_t>(bytes.subspan(8)) != bytes.size()) {
    return refused(PlanError::kLength, 8, "length");
  }
  const std::size_t covered = bytes.size() - kChecksumSize;
  if (load_le<std::uint32_t>(bytes.subspan(covered)) != crc32c(bytes.first(covered))) {
    return refused(PlanError::kChecksum, covered, "checksum");
  }
  return {};
}

/// At least one of them differs from what lower versions can say.
GoalAxes read_goal_axes(FieldReader& in, CoordinateMask coordinates) {
  GoalAxes axes;
  axes.free = in.whole<std::uint8_t>("goal_free_axes", 0, coordinates);
  if ((axes.free & ~coordinates) != 0) in.fail(PlanError::kRange, "goal_free_axes");
  for (int axis = 0; axis < 6; ++axis) {
    if (!has(coordinates, axis)) continue;
    axes.tolerance[axis] = in.f32("goal_axis_tolerance", kAxisTolerance);
    if (has(axes.free, axis) && axes.tolerance[axis] != 0.0) {
      in.fail(PlanError::kRange, "goal_axis_tolerance");
    }
  }
  if (in.ok() && !axes.any()) in.fail(PlanError::kVersion, "version");
  return axes;
}

/// Everything up to the side table; gives the two counts.
struct Counts {
  std::size_t parameter_sets = 0;
  std::size_t steps = 0;
};
Counts read_header(FieldReader& in, Plan& plan) {
  (void)in.raw<std::uint32_t>("magic");
  const auto version = in.raw<std::uint16_t>("version");
  const auto flags = in.raw<std::uint8_t>("flags");
  plan.check_places = (flags & kFlagCheckPlaces) != 0;
  plan.check_envelopes = (flags & kFlagCheckEnvelopes) != 0;
  const auto others = static_cast<std::uint8_t>(flags & ~kFlagCheckPlaces);
  const bool by_version =
      version >= kVersionOfGoalAxes || plan.check_places == (version == kVersionOfPlaces);
  if (others > kFlagsMax || !by_version || (plan.check_places && !plan.check_envelopes)) {
    in.fail(PlanError::kRange, "flags");
  }
  plan.method = static_cast<PlanMethod>(others >> kMethodShift);
  plan.coordinates = in.whole<std::uint8_t>("coordinates", 1, 0x3F);
  (void)in.raw<std::uint32_t>("length");
  plan.task_hash = in.raw<std::uint64_t>("task_hash");
  plan.start = read_pose(in, "start_position_m", "start_orientation");
  plan.goal = read_pose(in, "goal_position_m", "goal_orientation");
  plan.goal_tolerance_m = in.f32("goal_tolerance_m", kTolerance_m);
  plan.compliance = read_compliance(in);
  plan.force_limit_N = in.f32("force_limit_N", kForce);
  plan.torque_limit_Nm = in.f32("torque_limit_Nm", kForce);
  plan.contact_stiffness_Npm = in.f32("contact_stiffness_Npm", kContactStiffness_Npm);
  plan.latency_max_s = in.f32("latency_max_s", kLatency_s);
  plan.cost = in.f64("cost", kCost);
  plan.bound = in.f64("bound", kCost);
  if (plan.bound != 0.0 && plan.bound < 1.0) in.fail(PlanError::kRange, "bound");
  plan.draws = in.raw<std::uint32_t>("draws");
  plan.draws_at_goal = in.whole<std::uint32_t>("draws_at_goal", 0, plan.draws);
  plan.task_name = in.text("task_name");
  plan.start_name = in.text("start_name");
  Counts counts;
  counts.parameter_sets =
      in.whole<std::uint8_t>("parameter_set_count", 1, kParameterSetsMax, PlanError::kCount);
  counts.steps = in.whole<std::uint8_t>("step_count", 1, kMaxSteps, PlanError::kCount);
  if (version >= kVersionOfGoalAxes) plan.goal_axes = read_goal_axes(in, plan.coordinates);
  return counts;
}

}  // namespace

const char* to_string(PlanError error) {
  switch (error) {
    case PlanError::kNone:
      return "no error";
    case PlanError::kTooShort:
      return "shorter than a plan's header";
    case PlanError::kMagic:
      return "not a plan file";
    case PlanError::kVersion:
      return "another version of the format (this program reads versions 1 to 4)";
    case PlanError::kLength:
      return "the length in the header is not the file's: cut off or appended to";
    case PlanError::kChecksum:
      return "the checksum does not match: damaged";
    case PlanError::kTruncated:
      return "a record runs past the end";
    case PlanError::kTrailing:
      return "bytes after the last record";
    case PlanError::kCount:
      return "a count outside its range";
    case PlanError::kNotFinite:
      return "not a finite number";
    case PlanError::kRange:
      return "a value outside its range";
    case PlanError::kIndex:
      return "a parameter set that does not exist";
    case PlanError::kSuccessor:
      return "a successor that is neither a later step nor done";
    case PlanError::kText:
      return "a name that is not at most 63 printable ASCII characters";
  }
  return "?";
}

DecodedPlan decode_plan(std::span<const std::uint8_t> bytes) {
  DecodedPlan decoded = check_frame(bytes);
  if (decoded.error != PlanError::kNone) return decoded;

  FieldReader reader(bytes.first(bytes.size() - kChecksumSize));
  Plan plan;
  const Counts counts = read_header(reader, plan);
  // Nothing is reserved for records that the bytes cannot hold.
  const auto version = load_le<std::uint16_t>(bytes.subspan(4));
  const std::size_t least =
      set_size(version) * counts.parameter_sets + step_size(plan.coordinates) * counts.steps;
  if (least > reader.remaining()) reader.fail(PlanError::kTruncated, "step_count");
  if (!reader.ok()) return reader.failure();

  plan.parameter_sets.reserve(counts.parameter_sets);
  for (std::size_t i = 0; i < counts.parameter_sets && reader.ok(); ++i) {
    plan.parameter_sets.push_back(read_parameter_set(reader, plan.force_limit_N, version));
  }
  // A plan has one encoding, the lowest version that holds it.
  if (reader.ok() && version == kVersionOfRotation &&
      std::none_of(plan.parameter_sets.begin(), plan.parameter_sets.end(), has_rotation)) {
    reader.fail(PlanError::kVersion, "version");
  }
  plan.steps.reserve(counts.steps);
  for (std::size_t i = 0; i < counts.steps && reader.ok(); ++i) {
    plan.steps.push_back(read_step(reader, plan, i, counts.steps));
  }
  if (reader.ok() && reader.remaining() != 0) {
    return {std::nullopt, PlanError::kTrailing, bytes.size() - kChecksumSize - reader.remaining(),
            "steps"};
  }
  if (!reader.ok()) return reader.failure();
  decoded.plan = std::move(plan);
  return decoded;
}

}  // namespace tenon

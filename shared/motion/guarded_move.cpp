#include "shared/motion/guarded_move.h"

#include <algorithm>
#include <cmath>

#include "shared/base/time_units.h"
#include "shared/motion/path_limits.h"

namespace tenon {
namespace {

// At rest: slower than this over the whole window that speeds are judged by, which is long enough
// to see 0.2 mm/s through encoder steps of a micrometre.
constexpr double kRestSpeed_mps = 0.2e-3;
constexpr double kRestSpeed_radps = 2e-3;
constexpr std::int64_t kSettlingMax_ns = 500'000'000;
// A tool that is being turned takes longer; who presses it has no end of his own to wait for.
constexpr std::int64_t kAligningMax_ns = 10'000'000'000;
// How fast the setpoint follows a tool that something turns.
constexpr double kCreep_s = 0.05;
constexpr std::int64_t kCreepIn_ns = 200'000'000;  // until nearly all of the force acts
constexpr int kSettlingExtraSamples = 2;
// Blocked: the force limit has been reached and the tool slower than this for that long.
constexpr int kTranslations = 3;  // axes, and after their bits those of rotations
constexpr double kBlockedSpeed_mps = 1e-3;
constexpr double kBlockedSpeed_radps = 1e-2;
constexpr std::int64_t kBlocked_ns = 50'000'000;

double stiffness(const Compliance& compliance, int axis) {
  return axis < 3 ? compliance.stiffness_Npm : compliance.stiffness_Nmpr;
}

double damping(const Compliance& compliance, int axis) {
  return axis < 3 ? compliance.damping_Nspm : compliance.damping_Nmspr;
}

bool yields(const Compliance& compliance, int axis) {
  return (compliance.compliant_axes >> axis & 1U) != 0;
}

Pose pressed(const Pose& pose, ContactSignature signature, const Compliance& compliance,
             double force_N, double torque_Nm) {
  Vector6 push = Vector6::Zero();
  for (int axis = 0; axis < 6; ++axis) {
    if (!yields(compliance, axis)) continue;
    push[axis] =
        -signature.sign(axis) * (axis < 3 ? force_N : torque_Nm) / stiffness(compliance, axis);
  }
  return displaced(pose, push);
}

}  // namespace

GuardedMove::GuardedMove(const MoveParameters& parameters, ContactSignature signature,
                         const std::optional<Pose>& held)
    : parameters_(parameters),
      held_(held),
      rotates_(parameters.compliance.compliant_axes >> 3 != 0),
      aligns_(rotates_ && parameters.aligns),
      detector_(parameters.thresholds,
                parameters.compliance.compliant_axes & parameters.sensed_axes, signature),
      initial_(signature),
      displacement_(parameters.displacement),
      free_tool_(parameters.compliance) {
  for (int axis = 0; axis < 6; ++axis) {
    const int environment = signature.sign(axis);
    if (environment * displacement_[axis] < 0.0) displacement_[axis] = 0.0;
    if (environment * displacement_[axis] > 0.0) {
      leaving_.bits |= ContactSignature::bit(axis, environment);
    }
  }
  length_ = path_length(displacement_);
  if (length_ > 0.0) along_ = displacement_ / length_;
}

Pose GuardedMove::rest_setpoint(const Pose& pose, ContactSignature signature,
                                const MoveParameters& parameters) {
  return pressed(pose, signature, parameters.compliance, parameters.thresholds.force_keep_N,
                 parameters.thresholds.torque_keep_Nm);
}

GuardedMove::Output GuardedMove::update(const Input& input) {
  if (!parameters_.carried_from) {
    advance(input);
    return {setpoint_, phase_};
  }
  if (!axes_) {
    axes_ = input.pose.orientation * parameters_.carried_from->conjugate();
    if (held_) held_ = compose({Vector3::Zero(), axes_->conjugate()}, *held_);
  }
  const bool was_done = result_.has_value();
  advance(in_own_axes(input));
  if (result_ && !was_done) result_->pose = input.pose;
  return {in_task_axes(setpoint_), phase_};
}

GuardedMove::Input GuardedMove::in_own_axes(const Input& input) const {
  const Eigen::Quaterniond back = axes_->conjugate();
  Input own = input;
  own.pose = compose({Vector3::Zero(), back}, input.pose);
  own.wrench << back * input.wrench.head<3>(), back * input.wrench.tail<3>();
  return own;
}

GuardedMove::Setpoint GuardedMove::in_task_axes(const Setpoint& own) const {
  Setpoint setpoint;
  setpoint.pose = compose({Vector3::Zero(), *axes_}, own.pose);
  setpoint.velocity << *axes_ * own.velocity.head<3>(), *axes_ * own.velocity.tail<3>();
  setpoint.acceleration << *axes_ * own.acceleration.head<3>(), *axes_ * own.acceleration.tail<3>();
  return setpoint;
}

void GuardedMove::advance(const Input& input) {
  if (!started_) start(input);
  recent_.add(input.time_ns, input.pose);
  if (input.wrench_fresh) {
    detector_.update(input.time_ns, input.wrench, kept());
    watch_resistance(input.wrench);
    peak_force_N2_ = std::max(peak_force_N2_, input.wrench.head<3>().squaredNorm());
  }
  switch (phase_) {
    case Phase::kMoving:
      move(input);
      break;
    case Phase::kProbing:
      probe(input);
      break;
    case Phase::kSettling:
      settle(input);
      break;
    case Phase::kDone:
      break;
  }
}

void GuardedMove::start(const Input& input) {
  started_ = true;
  first_ = {input.time_ns, input.pose};
  // What the move leaves is not pressed any more, so that it travels what it was told.
  rest_ = rest_setpoint(input.pose, {static_cast<std::uint16_t>(initial_.bits & ~leaving_.bits)},
                        parameters_);
  if (held_ && initial_.bits == 0) rest_ = with_position_of(*held_, rest_);
  if (held_ && rotates_) rest_.orientation = held_->orientation;
  setpoint_.pose = rest_;
  plan_path(input.time_ns, 0.0);
}

void GuardedMove::plan_path(std::int64_t time_ns, double from) {
  const PathLimits limits = path_limits(displacement_, parameters_.speeds);
  MotionProfile::Parameters p;
  p.length = length_ - from;
  p.slow_from = std::max(0.0, parameters_.slow_from_m - from);
  p.fast_speed = limits.approach_speed;
  p.slow_speed = limits.contact_speed;
  p.acceleration = limits.acceleration;
  p.jerk = limits.jerk;
  profile_ = MotionProfile(p);
  profile_start_ns_ = time_ns;
  profile_from_ = from;
}

bool GuardedMove::turns_only() const {
  return displacement_.tail<3>().any() && displacement_.head<3>().norm() <= kNoTravel;
}

double GuardedMove::path_at(const Pose& pose) const {
  const Vector6 off = displacement_between(rest_, pose);
  return turns_only() ? along_.tail<3>().dot(off.tail<3>()) : along_.head<3>().dot(off.head<3>());
}

void GuardedMove::move(const Input& input) {
  const ContactSignature now = detector_.signature();
  const auto gained = static_cast<std::uint16_t>(now.bits & ~initial_.bits);
  const auto lost = static_cast<std::uint16_t>(initial_.bits & ~now.bits);
  if (watched({gained}).bits != 0) return enter_settling(input, Outcome::kContact);
  if (watched({lost}).bits != 0) return enter_settling(input, Outcome::kRelease);
  if (watched(detector_.candidates()).bits != 0) return enter_probing(input);
  if (input.time_ns - first_.time_ns >= std::int64_t{1000} * parameters_.timeout_us) {
    return enter_settling(input, Outcome::kTimeout);
  }

  const double elapsed_s = kNanosecond_s * static_cast<double>(input.time_ns - profile_start_ns_);
  const double path = profile_from_ + profile_.at(elapsed_s).position;
  std::uint8_t limited = 0;
  setpoint_.pose = clamped(displaced(rest_, along_ * path), input.pose, limited);
  // The means since the last update, not the profile's own: a plant that takes steps of this length
  // follows them to the pose, and not beside it by half a step of its speed.
  if (const double step = recent_.step_s(); step > 0.0) {
    const Vector6 velocity = along_ * ((path - path_) / step);
    setpoint_.acceleration = (velocity - path_velocity_) / step;
    setpoint_.velocity = path_velocity_ = velocity;
    ease(input.pose, static_cast<std::uint8_t>(resisted_ | limited));
  }
  path_ = path;

  if (limited == 0 || !recent_.slower_than(kBlockedSpeed_mps, kBlockedSpeed_radps)) {
    pressed_since_ns_ = -1;
  } else if (pressed_since_ns_ < 0) {
    pressed_since_ns_ = input.time_ns;
  }
  if (pressed_since_ns_ >= 0 && input.time_ns - pressed_since_ns_ >= kBlocked_ns) {
    return enter_settling(input, Outcome::kBlocked);
  }
  if (elapsed_s >= profile_.duration_s() && limited == 0) enter_settling(input, Outcome::kReached);
}

void GuardedMove::enter_probing(const Input& input) {
  phase_ = Phase::kProbing;
  free_tool_.reset({setpoint_.pose, setpoint_.velocity});
  // The command stops at once; along the candidate axes it presses, elsewhere it stays.
  const ContactSignature candidates = watched(detector_.candidates());
  const Pose push = pressed(input.pose, candidates, parameters_.compliance,
                            kProbeOverOn * parameters_.thresholds.force_on_N,
                            kProbeOverOn * parameters_.thresholds.torque_on_Nm);
  Vector6 correction = displacement_between(setpoint_.pose, push);
  for (int axis = 0; axis < 6; ++axis) {
    if (candidates.sign(axis) == 0) correction[axis] = 0.0;
  }
  setpoint_.pose = displaced(setpoint_.pose, correction);
  path_velocity_.setZero();
  setpoint_.velocity.setZero();
  setpoint_.acceleration.setZero();
}

void GuardedMove::probe(const Input& input) {
  const ContactSignature now = detector_.signature();
  if (watched({static_cast<std::uint16_t>(now.bits & ~initial_.bits)}).bits != 0) {
    return enter_settling(input, Outcome::kContact);
  }
  if (input.time_ns - first_.time_ns >= std::int64_t{1000} * parameters_.timeout_us) {
    return enter_settling(input, Outcome::kTimeout);
  }
  free_tool_.update(setpoint_, Vector6::Zero(), recent_.step_s());
  // What presses has come to rest on less than a contact takes, friction for one: no more comes.
  const bool faded = watched(detector_.fading()) == watched(detector_.candidates());
  if (faded && recent_.slower_than(kRestSpeed_mps, kRestSpeed_radps)) detector_.drop_fading();
  if (input.wrench_fresh && watched(detector_.candidates()).bits == 0) resume(input);
}

// A push that did not last. The stop and the press have brought a free tool off the command, and
// the compliance would take D / K to close that difference: so the command goes on from where the
// tool runs out to.
void GuardedMove::resume(const Input& input) {
  phase_ = Phase::kMoving;
  resisted_ = 0;
  path_ = std::clamp(path_at(free_tool_.run_out()), path_, length_);
  plan_path(input.time_ns, path_);
  setpoint_.pose = displaced(rest_, along_ * path_);
}

void GuardedMove::enter_settling(const Input& input, Outcome outcome) {
  phase_ = Phase::kSettling;
  outcome_ = outcome;
  decided_ns_ = settling_since_ns_ = input.time_ns;
  settling_samples_ = 0;
  pressing_ = detector_.signature();
  aligning_ = aligns_ && outcome == Outcome::kContact;
  setpoint_.pose = resting(input.pose, pressing_);
  setpoint_.velocity.setZero();
  setpoint_.acceleration.setZero();
}

Pose GuardedMove::resting(const Pose& pose, ContactSignature signature) const {
  Pose rest = rest_setpoint(pose, signature, parameters_);
  // A move that only turns may be stopped by a force; one that also travels is stopped on its way,
  // as if it did not turn.
  const bool turning = turns_only() && outcome_ != Outcome::kReached;
  const bool turned = signature.bits >> 2 * kTranslations != 0;
  if (rotates_ && !turning && !turned) rest.orientation = setpoint_.pose.orientation;
  const bool free = signature.bits == 0 && outcome_ == Outcome::kReached;
  return free ? with_position_of(setpoint_.pose, rest) : rest;
}

Pose GuardedMove::with_position_of(const Pose& held, Pose pose) const {
  const double give_m = parameters_.thresholds.force_off_N / parameters_.compliance.stiffness_Npm;
  for (int axis = 0; axis < kTranslations; ++axis) {
    const double position_m = held.position_m[axis];
    const bool none = std::abs(position_m - pose.position_m[axis]) < give_m;
    if (none && yields(parameters_.compliance, axis)) pose.position_m[axis] = position_m;
  }
  return pose;
}

void GuardedMove::settle(const Input& input) {
  if (input.wrench_fresh) ++settling_samples_;
  if (detector_.signature() != pressing_) {
    pressing_ = detector_.signature();
    setpoint_.pose = resting(input.pose, pressing_);
  }
  if (aligns_ && pressing_.bits != 0) creep(input.pose);
  const std::int64_t since_ns = input.time_ns - settling_since_ns_;
  const bool sampled =
      settling_samples_ > kSettlingExtraSamples &&
      since_ns >= std::max(RecentPoses::kWindow_ns,
                           std::int64_t{1000} * parameters_.thresholds.debounce_us);
  const bool at_rest = recent_.slower_than(kRestSpeed_mps, kRestSpeed_radps);
  const bool pressed_long = !aligning_ || since_ns >= kCreepIn_ns;
  const bool sure = sampled && pressed_long && at_rest && detector_.weak().bits == 0;
  if (aligns_ && since_ns >= kSettlingMax_ns) detector_.drop_weak();
  if (!sure && since_ns < (aligns_ ? kAligningMax_ns : kSettlingMax_ns)) return;
  if (!aligning_) return finish(input);
  // With less force the spring would turn the tool back from what has turned it.
  aligning_ = false;
  setpoint_.pose.orientation = rest_setpoint(input.pose, pressing_, parameters_).orientation;
  settling_since_ns_ = input.time_ns;
  settling_samples_ = 0;
}

void GuardedMove::finish(const Input& input) {
  phase_ = Phase::kDone;
  detector_.drop_weak();
  setpoint_.pose = resting(input.pose, detector_.signature());
  Result result;
  result.outcome = outcome_;
  result.signature = detector_.signature();
  result.pose = input.pose;
  result.travelled = displacement_between(first_.pose, input.pose);
  result.decided_ns = decided_ns_ - first_.time_ns;
  result.duration_ns = input.time_ns - first_.time_ns;
  result.peak_force_N = std::sqrt(peak_force_N2_);
  result_ = result;
}

void GuardedMove::creep(const Pose& pose) {
  const ContactThresholds& t = parameters_.thresholds;
  const bool sure = aligning_ && detector_.weak().bits == 0;
  const double force_N = sure ? kProbeOverOn * t.force_on_N : t.force_keep_N;
  const Pose follow = pressed(pose, pressing_, parameters_.compliance, force_N, t.torque_keep_Nm);
  const double give_rad = t.torque_off_Nm / parameters_.compliance.stiffness_Nmpr;
  Vector6 way = displacement_between(setpoint_.pose, follow);
  for (int axis = 0; axis < 6; ++axis) {
    const bool held = pressing_.sign(axis) != 0;
    if (!yields(parameters_.compliance, axis) || (axis < 3 && !held)) way[axis] = 0.0;
    if (axis < 3 || held) continue;
    way[axis] -= std::clamp(way[axis], -give_rad, give_rad);
    if (pressing_.count() == 1 && pressing_.sign(axis - 3) != 0) way[axis] = 0.0;
  }
  const double step = recent_.step_s();
  setpoint_.pose = displaced(setpoint_.pose, step / (step + kCreep_s) * way);
}

Pose GuardedMove::clamped(const Pose& setpoint, const Pose& pose, std::uint8_t& limited) const {
  Vector6 pull = displacement_between(pose, setpoint);
  limited = 0;
  for (int axis = 0; axis < 6; ++axis) {
    if (!yields(parameters_.compliance, axis)) continue;
    const double most = (axis < 3 ? parameters_.force_limit_N : parameters_.torque_limit_Nm) /
                        stiffness(parameters_.compliance, axis);
    if (std::abs(pull[axis]) <= most) continue;
    limited = static_cast<std::uint8_t>(limited | 1U << axis);
    pull[axis] = std::copysign(most, pull[axis]);
  }
  return limited != 0 ? displaced(pose, pull) : setpoint;
}

void GuardedMove::watch_resistance(const Vector6& wrench) {
  const ContactThresholds& t = parameters_.thresholds;
  for (int axis = 0; axis < 6; ++axis) {
    if (!yields(parameters_.compliance, axis) || along_[axis] == 0.0) continue;
    const auto bit = static_cast<std::uint8_t>(1U << axis);
    const double against = along_[axis] < 0.0 ? wrench[axis] : -wrench[axis];
    const double on = axis < 3 ? t.force_on_N : t.torque_on_Nm;
    const double off = axis < 3 ? t.force_off_N : t.torque_off_Nm;
    if (against > on) resisted_ = static_cast<std::uint8_t>(resisted_ | bit);
    if (against < off) resisted_ = static_cast<std::uint8_t>(resisted_ & ~bit);
  }
}

// The tool is held back there, so that the damper would pull with all of D xs' beside the spring.
// It adds no more than brings both to the press of a probe; from there on the spring pulls alone,
// up to its limit.
void GuardedMove::ease(const Pose& pose, std::uint8_t axes) {
  if (axes == 0) return;
  const ContactThresholds& t = parameters_.thresholds;
  const Vector6 lead = displacement_between(pose, setpoint_.pose);
  for (int axis = 0; axis < 6; ++axis) {
    if ((axes >> axis & 1U) == 0) continue;
    const double press = kProbeOverOn * (axis < 3 ? t.force_on_N : t.torque_on_Nm);
    const double spring = stiffness(parameters_.compliance, axis) * lead[axis];
    const double pull = along_[axis] < 0.0 ? -spring : spring;
    const double speed_most = std::max(0.0, press - pull) / damping(parameters_.compliance, axis);
    setpoint_.velocity[axis] = std::clamp(setpoint_.velocity[axis], -speed_most, speed_most);
    setpoint_.acceleration[axis] = 0.0;
  }
}

ContactSignature GuardedMove::kept() const {
  if (phase_ == Phase::kMoving) return {};
  return {static_cast<std::uint16_t>(kAllContacts.bits & ~leaving_.bits)};
}

ContactSignature GuardedMove::watched(ContactSignature bits) const {
  return {static_cast<std::uint16_t>(bits.bits & parameters_.trigger_mask.bits & ~leaving_.bits)};
}

}  // namespace tenon

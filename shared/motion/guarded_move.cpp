#include "shared/motion/guarded_move.h"

#include <algorithm>
#include <cassert>
#include <cmath>

namespace tenon {
namespace {

// At rest: slower than this over the whole window. A window this long sees 0.2 mm/s through encoder
// steps of a micrometre.
constexpr double kRestSpeed_mps = 0.2e-3;
constexpr double kRestSpeed_radps = 2e-3;
constexpr std::int64_t kRestWindow_ns = 20'000'000;
constexpr std::int64_t kSettlingMax_ns = 500'000'000;
constexpr int kSettlingExtraSamples = 2;
// Blocked: the force limit has been reached and the tool slower than this for that long.
constexpr double kBlockedSpeed_mps = 1e-3;
constexpr double kBlockedSpeed_radps = 1e-2;
constexpr std::int64_t kBlocked_ns = 50'000'000;
// Shorter displacements (m or rad) are no motion.
constexpr double kNoMotion = 1e-9;

constexpr double kNanosecond_s = 1e-9;

double stiffness(const Compliance& compliance, int axis) {
  return axis < 3 ? compliance.stiffness_Npm : compliance.stiffness_Nmpr;
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

GuardedMove::GuardedMove(const MoveParameters& parameters, ContactSignature signature)
    : parameters_(parameters),
      detector_(parameters.thresholds, parameters.compliance.compliant_axes, signature),
      initial_(signature),
      displacement_(parameters.displacement) {
  for (int axis = 0; axis < 6; ++axis) {
    const int environment = signature.sign(axis);
    if (environment * displacement_[axis] < 0.0) displacement_[axis] = 0.0;
    if (environment * displacement_[axis] > 0.0) {
      leaving_.bits |= ContactSignature::bit(axis, environment);
    }
  }
  const double translation_m = displacement_.head<3>().norm();
  const double rotation_rad = displacement_.tail<3>().norm();
  length_ =
      translation_m > kNoMotion ? translation_m : (rotation_rad > kNoMotion ? rotation_rad : 0.0);
}

Pose GuardedMove::rest_setpoint(const Pose& pose, ContactSignature signature,
                                const MoveParameters& parameters) {
  return pressed(pose, signature, parameters.compliance, parameters.thresholds.force_keep_N,
                 parameters.thresholds.torque_keep_Nm);
}

GuardedMove::Output GuardedMove::update(const Input& input) {
  if (!started_) start(input);
  remember(input);
  if (input.wrench_fresh) {
    detector_.update(input.time_ns, input.wrench);
    peak_force_N_ = std::max(peak_force_N_, input.wrench.head<3>().norm());
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
  return {setpoint_, phase_};
}

void GuardedMove::start(const Input& input) {
  started_ = true;
  first_ = {input.time_ns, input.pose};
  // What the move leaves is not pressed any more, so that it travels what it was told.
  rest_ = rest_setpoint(input.pose, {static_cast<std::uint16_t>(initial_.bits & ~leaving_.bits)},
                        parameters_);
  setpoint_.pose = rest_;
  plan_path(input.time_ns, 0.0);
}

void GuardedMove::plan_path(std::int64_t time_ns, double from) {
  const SpeedLimits& v = parameters_.speeds;
  const double translation_m = displacement_.head<3>().norm();
  const double rotation_rad = displacement_.tail<3>().norm();
  MotionProfile::Parameters p;
  p.length = length_ - from;
  p.slow_from = std::max(0.0, parameters_.slow_from_m - from);
  p.fast_speed = v.approach_mps;
  p.slow_speed = v.contact_mps;
  p.acceleration = v.acceleration_mps2;
  p.jerk = v.jerk_mps3;
  if (rotation_rad > kNoMotion) {
    // Every limit in path units; the tighter of translation and rotation holds.
    const double path_per_rad = length_ / rotation_rad;
    const bool turn_only = translation_m <= kNoMotion;
    const auto limit = [&](double linear, double angular) {
      return turn_only ? angular : std::min(linear, angular * path_per_rad);
    };
    p.fast_speed = limit(v.approach_mps, v.approach_radps);
    p.slow_speed = limit(v.contact_mps, v.contact_radps);
    p.acceleration = limit(v.acceleration_mps2, v.acceleration_radps2);
    p.jerk = limit(v.jerk_mps3, v.jerk_radps3);
  }
  profile_ = MotionProfile(p);
  profile_start_ns_ = time_ns;
  profile_from_ = from;
}

double GuardedMove::path_at(const Pose& pose) const {
  if (length_ <= 0.0) return 0.0;
  const Vector6 off = displacement_between(rest_, pose);
  const bool turn_only = displacement_.head<3>().norm() <= kNoMotion;
  return (turn_only ? displacement_.tail<3>().dot(off.tail<3>())
                    : displacement_.head<3>().dot(off.head<3>())) /
         length_;
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
  const MotionProfile::Sample sample = profile_.at(elapsed_s);
  path_ = profile_from_ + sample.position;
  const Vector6 along = length_ > 0.0 ? Vector6(displacement_ / length_) : Vector6(Vector6::Zero());
  bool limited = false;
  setpoint_.pose = clamped(displaced(rest_, along * path_), input.pose, limited);
  setpoint_.velocity = along * sample.velocity;
  setpoint_.acceleration = along * sample.acceleration;

  if (!limited || !slower_than(kBlockedSpeed_mps, kBlockedSpeed_radps)) {
    pressed_since_ns_ = -1;
  } else if (pressed_since_ns_ < 0) {
    pressed_since_ns_ = input.time_ns;
  }
  if (pressed_since_ns_ >= 0 && input.time_ns - pressed_since_ns_ >= kBlocked_ns) {
    return enter_settling(input, Outcome::kBlocked);
  }
  if (elapsed_s >= profile_.duration_s() && !limited) enter_settling(input, Outcome::kReached);
}

void GuardedMove::enter_probing(const Input& input) {
  phase_ = Phase::kProbing;
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
  if (input.wrench_fresh && watched(detector_.candidates()).bits == 0) {
    phase_ = Phase::kMoving;
    // Where the tool ran on while the command stood, the command goes on from there: the compliance
    // would take D / K to close the difference. A tool that is held back keeps its spring loaded.
    path_ = std::clamp(path_at(input.pose), path_, length_);
    plan_path(input.time_ns, path_);
    setpoint_.pose = displaced(rest_, length_ > 0.0 ? Vector6(displacement_ * (path_ / length_))
                                                    : Vector6(Vector6::Zero()));
  }
}

void GuardedMove::enter_settling(const Input& input, Outcome outcome) {
  phase_ = Phase::kSettling;
  outcome_ = outcome;
  settling_since_ns_ = input.time_ns;
  settling_samples_ = 0;
  pressing_ = detector_.signature();
  setpoint_.pose = rest_setpoint(input.pose, pressing_, parameters_);
  setpoint_.velocity.setZero();
  setpoint_.acceleration.setZero();
}

void GuardedMove::settle(const Input& input) {
  if (input.wrench_fresh) ++settling_samples_;
  if (detector_.signature() != pressing_) {
    pressing_ = detector_.signature();
    setpoint_.pose = rest_setpoint(input.pose, pressing_, parameters_);
  }
  const std::int64_t since_ns = input.time_ns - settling_since_ns_;
  const bool sampled =
      settling_samples_ > kSettlingExtraSamples &&
      since_ns >= std::max(kRestWindow_ns, std::int64_t{1000} * parameters_.thresholds.debounce_us);
  const bool at_rest = slower_than(kRestSpeed_mps, kRestSpeed_radps);
  if (!(sampled && at_rest) && since_ns < kSettlingMax_ns) return;

  phase_ = Phase::kDone;
  setpoint_.pose = rest_setpoint(input.pose, detector_.signature(), parameters_);
  Result result;
  result.outcome = outcome_;
  result.signature = detector_.signature();
  result.pose = input.pose;
  result.travelled = displacement_between(first_.pose, input.pose);
  result.decided_ns = settling_since_ns_ - first_.time_ns;
  result.duration_ns = input.time_ns - first_.time_ns;
  result.peak_force_N = peak_force_N_;
  result_ = result;
}

Pose GuardedMove::clamped(const Pose& setpoint, const Pose& pose, bool& active) const {
  Vector6 pull = displacement_between(pose, setpoint);
  active = false;
  for (int axis = 0; axis < 6; ++axis) {
    if (!yields(parameters_.compliance, axis)) continue;
    const double most = (axis < 3 ? parameters_.force_limit_N : parameters_.torque_limit_Nm) /
                        stiffness(parameters_.compliance, axis);
    if (std::abs(pull[axis]) <= most) continue;
    active = true;
    pull[axis] = std::copysign(most, pull[axis]);
  }
  return active ? displaced(pose, pull) : setpoint;
}

ContactSignature GuardedMove::watched(ContactSignature bits) const {
  return {static_cast<std::uint16_t>(bits.bits & parameters_.trigger_mask.bits & ~leaving_.bits)};
}

void GuardedMove::remember(const Input& input) {
  memory_[remembered_ % kMemory] = {input.time_ns, input.pose};
  ++remembered_;
}

bool GuardedMove::slower_than(double speed_mps, double speed_radps) const {
  const Moment& now = memory_[(remembered_ - 1) % kMemory];
  const std::size_t kept = std::min(remembered_, kMemory);
  for (std::size_t back = 1; back < kept; ++back) {
    const Moment& then = memory_[(remembered_ - 1 - back) % kMemory];
    const std::int64_t window_ns = now.time_ns - then.time_ns;
    if (window_ns < kRestWindow_ns && back + 1 < kMemory) continue;
    const double window_s = kNanosecond_s * static_cast<double>(window_ns);
    const Vector6 moved = displacement_between(then.pose, now.pose);
    return moved.head<3>().norm() < speed_mps * window_s &&
           moved.tail<3>().norm() < speed_radps * window_s;
  }
  return false;
}

}  // namespace tenon

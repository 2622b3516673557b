#include "shared/motion/contact_detector.h"

namespace tenon {
namespace {

// Noise about the on-threshold does not end a candidacy; what is no contact falls far below.
constexpr double kStillCandidate = 0.9;  // of the on-threshold

}  // namespace

ContactDetector::ContactDetector(const ContactThresholds& thresholds, std::uint8_t watched_axes,
                                 ContactSignature initial)
    : thresholds_(thresholds), watched_axes_(watched_axes), signature_(initial) {}

void ContactDetector::update(std::int64_t time_ns, const Vector6& wrench, ContactSignature kept) {
  const std::int64_t debounce_ns = std::int64_t{1000} * thresholds_.debounce_us;
  const ContactSignature before = candidates_;
  candidates_ = {};
  weak_ = {};
  const double force_max_N = wrench.head<3>().cwiseAbs().maxCoeff();
  const double torque_max_Nm = wrench.tail<3>().cwiseAbs().maxCoeff();
  // In free flight, as nearly always.
  if (signature_.bits == 0 && force_max_N <= kStillCandidate * thresholds_.force_on_N &&
      torque_max_Nm <= kStillCandidate * thresholds_.torque_on_Nm) {
    pending_ = {};
    return;
  }
  for (int axis = 0; axis < 6; ++axis) {
    if ((watched_axes_ >> axis & 1U) == 0) continue;
    const double on = axis < 3 ? thresholds_.force_on_N : thresholds_.torque_on_Nm;
    const double off = axis < 3 ? thresholds_.force_off_N : thresholds_.torque_off_Nm;
    for (const int sign : {+1, -1}) {
      const std::uint16_t bit = ContactSignature::bit(axis, sign);
      const double push = sign * wrench[axis];
      const bool held = (signature_.bits & bit) != 0;
      // Friction is weaker than the push that causes it: only the largest component is a new
      // contact.
      const bool largest = push >= (axis < 3 ? force_max_N : torque_max_Nm);
      const bool disagrees = held ? push < off : push > on && largest;
      const bool was_candidate = (before.bits & bit) != 0;
      const double candidate_above = was_candidate ? kStillCandidate * on : on;
      if (!held && largest && push > candidate_above) candidates_.bits |= bit;
      auto& since_ns = since_ns_[static_cast<std::size_t>(2 * axis + (sign > 0 ? 0 : 1))];
      if (!disagrees) {
        pending_.bits &= static_cast<std::uint16_t>(~bit);
      } else if ((pending_.bits & bit) == 0) {
        pending_.bits |= bit;
        since_ns = time_ns;
      } else if (time_ns - since_ns < debounce_ns) {
        continue;
      } else if (held && (kept.bits & bit) != 0) {
        weak_.bits |= bit;
      } else {
        signature_.bits ^= bit;
        pending_.bits &= static_cast<std::uint16_t>(~bit);
        candidates_.bits &= static_cast<std::uint16_t>(~bit);
      }
    }
  }
}

void ContactDetector::drop_weak() {
  signature_.bits &= static_cast<std::uint16_t>(~weak_.bits);
  pending_.bits &= static_cast<std::uint16_t>(~weak_.bits);
  weak_ = {};
}

}  // namespace tenon

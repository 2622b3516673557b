#include "shared/motion/contact_detector.h"

namespace tenon {

ContactDetector::ContactDetector(const ContactThresholds& thresholds, std::uint8_t watched_axes,
                                 ContactSignature initial)
    : thresholds_(thresholds), watched_axes_(watched_axes), signature_(initial) {}

void ContactDetector::update(std::int64_t time_ns, const Vector6& wrench) {
  const std::int64_t debounce_ns = std::int64_t{1000} * thresholds_.debounce_us;
  candidates_ = {};
  const double force_max_N = wrench.head<3>().cwiseAbs().maxCoeff();
  const double torque_max_Nm = wrench.tail<3>().cwiseAbs().maxCoeff();
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
      if (!held && disagrees) candidates_.bits |= bit;
      auto& since_ns = since_ns_[static_cast<std::size_t>(2 * axis + (sign > 0 ? 0 : 1))];
      if (!disagrees) {
        pending_.bits &= static_cast<std::uint16_t>(~bit);
      } else if ((pending_.bits & bit) == 0) {
        pending_.bits |= bit;
        since_ns = time_ns;
      } else if (time_ns - since_ns >= debounce_ns) {
        signature_.bits ^= bit;
        pending_.bits &= static_cast<std::uint16_t>(~bit);
        candidates_.bits &= static_cast<std::uint16_t>(~bit);
      }
    }
  }
}

}  // namespace tenon

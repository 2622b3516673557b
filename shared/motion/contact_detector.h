#pragma once
// Turns wrench samples into a contact signature: hysteresis and debounce for every bit.

#include <array>
#include <cstdint>

#include "shared/math/pose.h"
#include "shared/motion/contact_signature.h"
#include "shared/motion/move_parameters.h"

namespace tenon {

/// Real-time: no allocation, a few comparisons a sample. The wrench is the external one: what the
/// environment does to the tool, in the task frame's axes at the tool tip.
///
/// A bit is gained while its component is above the on-threshold and the largest of the three
/// forces (or torques): an impact's friction, up to the coefficient of friction times the push,
/// would otherwise pass for a second contact. A bit is lost while its component is below the
/// off-threshold, unless it is kept: a contact that is being made bends the arm, and what it holds
/// already is pushed off for a while.
class ContactDetector {
 public:
  ContactDetector(const ContactThresholds& thresholds, std::uint8_t watched_axes,
                  ContactSignature initial);

  /// One fresh sample. @param time_ns when it was measured, increasing
  /// @param kept bits that are not lost, however weak they get
  void update(std::int64_t time_ns, const Vector6& wrench, ContactSignature kept = {});

  [[nodiscard]] ContactSignature signature() const { return signature_; }
  /// Bits that are not set and whose last fresh sample was above the on-threshold, or not much
  /// below it since then.
  [[nodiscard]] ContactSignature candidates() const { return candidates_; }
  /// Of the candidates those that the last fresh sample had no more above the on-threshold.
  [[nodiscard]] ContactSignature fading() const {
    return {static_cast<std::uint16_t>(candidates_.bits & ~pending_.bits)};
  }
  /// They have to come above it again.
  void drop_fading() { candidates_.bits &= pending_.bits; }
  /// Bits that were kept, and would have been lost by the last fresh sample.
  [[nodiscard]] ContactSignature weak() const { return weak_; }
  /// Loses them.
  void drop_weak();

 private:
  ContactThresholds thresholds_;
  std::uint8_t watched_axes_;
  ContactSignature signature_;
  ContactSignature candidates_;
  ContactSignature weak_;
  /// Bits that have disagreed with the signature since since_ns_.
  ContactSignature pending_;
  std::array<std::int64_t, ContactSignature::kBits> since_ns_{};
};

}  // namespace tenon

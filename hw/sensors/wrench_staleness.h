#pragma once
// How long a sensor may bring no new wrench, or none but old ones, whatever brings it: counted in
// the samples that it owes, so that one slower than the cycle has as many tries as any. Only a node
// that numbers its samples itself tells that they are old. Real-time, no clock; one thread.

#include <cmath>
#include <cstdint>

#include "hw/sensors/sample_lag.h"
#include "shared/cell/robot.h"
#include "shared/ports/arm.h"

namespace tenon::hw {

class WrenchStaleness {
 public:
  /// In a row; one more is a fault.
  static constexpr int kMissingSamples = 5;

  explicit WrenchStaleness(const ForceTorqueSensor& sensor)
      : cycles_per_sample_(static_cast<std::uint32_t>(sensor.cycles_per_sample)),
        owes_(!sensor.absent()),
        numbers_(sensor.protocol == SensorProtocol::kNode),
        lag_(sensor.cycles_per_sample) {}

  /// The most cycles in a row without a new wrench.
  [[nodiscard]] static std::uint32_t cycles_max(const ForceTorqueSensor& sensor) {
    return static_cast<std::uint32_t>(kMissingSamples * sensor.cycles_per_sample);
  }

  void reset() noexcept {
    cycles_ = untimely_cycles_ = 0;
    lag_.reset();
  }
  /// A cycle has closed. @param sync_heard its SYNC left, and somebody answered
  void update(const ArmFeedback& feedback, bool sync_heard) noexcept {
    const bool fresh = feedback.wrench_fresh;
    cycles_ = fresh || !owes_ ? 0 : cycles_ + 1;
    if (numbers_ && sync_heard) lag_.sync_heard();
    if (numbers_ && fresh) lag_.take(feedback.wrench_counter);
    untimely_cycles_ = (fresh && !lag_.late()) || !owes_ ? 0 : untimely_cycles_ + 1;
  }

  /// In a row without a new wrench.
  [[nodiscard]] std::uint32_t cycles() const noexcept { return cycles_; }
  /// The last cycle ought to have brought one, and did not.
  [[nodiscard]] bool missing() const noexcept {
    return cycles_ > 0 && cycles_ % cycles_per_sample_ == 0;
  }
  /// None that is new, or none that is not too old.
  [[nodiscard]] bool stale() const noexcept {
    return untimely_cycles_ > kMissingSamples * cycles_per_sample_;
  }
  /// The newest is too old by so many samples, half of one rounded up; 0: it is not.
  [[nodiscard]] std::uint32_t samples_behind() const noexcept {
    return lag_.late() ? static_cast<std::uint32_t>(std::lround(lag_.behind_samples())) : 0;
  }

 private:
  std::uint32_t cycles_per_sample_;
  bool owes_;     ///< there is a sensor
  bool numbers_;  ///< by itself
  SampleLag lag_;
  std::uint32_t cycles_ = 0;
  std::uint32_t untimely_cycles_ = 0;  ///< in a row without a new wrench that is not too old
};

}  // namespace tenon::hw

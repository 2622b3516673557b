#pragma once
// How long a sensor may bring no new wrench, whatever brings it: counted in the samples that it
// owes, so that one slower than the cycle has as many tries as any. Real-time, no clock; one
// thread.

#include <cstdint>

#include "shared/cell/robot.h"

namespace tenon::hw {

class WrenchStaleness {
 public:
  /// In a row; one more is a fault.
  static constexpr int kMissingSamples = 5;

  explicit WrenchStaleness(const ForceTorqueSensor& sensor)
      : cycles_per_sample_(static_cast<std::uint32_t>(sensor.cycles_per_sample)),
        owes_(!sensor.absent()) {}

  /// The most cycles in a row without a new wrench.
  [[nodiscard]] static std::uint32_t cycles_max(const ForceTorqueSensor& sensor) {
    return static_cast<std::uint32_t>(kMissingSamples * sensor.cycles_per_sample);
  }

  void reset() noexcept { cycles_ = 0; }
  /// A cycle has closed. @param fresh with a new wrench
  void update(bool fresh) noexcept { cycles_ = fresh || !owes_ ? 0 : cycles_ + 1; }

  /// In a row without a new wrench.
  [[nodiscard]] std::uint32_t cycles() const noexcept { return cycles_; }
  /// The last cycle ought to have brought one, and did not.
  [[nodiscard]] bool missing() const noexcept {
    return cycles_ > 0 && cycles_ % cycles_per_sample_ == 0;
  }
  [[nodiscard]] bool stale() const noexcept {
    return cycles_ > kMissingSamples * cycles_per_sample_;
  }

 private:
  std::uint32_t cycles_per_sample_;
  bool owes_;  ///< there is a sensor
  std::uint32_t cycles_ = 0;
};

}  // namespace tenon::hw

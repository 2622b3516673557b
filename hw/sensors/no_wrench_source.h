#pragma once
// An arm without a force/torque sensor: no frame is its, and nothing is waited for.

#include "shared/ports/wrench_source.h"

namespace tenon::hw {

class NoWrenchSource : public WrenchSource {
 public:
  [[nodiscard]] Taken take(const CanFrame& /*frame*/, std::int64_t /*time_ns*/,
                           WrenchHalf& /*half*/) noexcept override {
    return Taken::kForeign;
  }
  [[nodiscard]] std::optional<Vector3> force_N(const WrenchHalf& /*half*/) const noexcept override {
    return std::nullopt;
  }
  [[nodiscard]] Vector6 wrench(const std::array<std::int16_t, 6>& /*raw*/) const noexcept override {
    return Vector6::Zero();
  }
};

}  // namespace tenon::hw

#pragma once
// A CANopen force/torque node that answers every SYNC with two frames:
//
//   force:  | 0-1 fx | 2-3 fy | 4-5 fz | 6-7 counter |     i16 and u16, little-endian
//   torque: | 0-1 tx | 2-3 ty | 4-5 tz | 6-7 counter |
//
// Needs no request: SYNC asks it. Real-time, no clock; one thread.

#include <cstdint>

#include "shared/cell/robot.h"
#include "shared/ports/wrench_source.h"

namespace tenon::hw {

class CanopenWrenchSource final : public WrenchSource {
 public:
  /// 11-bit identifiers of its two frames.
  struct CobIds {
    std::uint32_t force = 0;
    std::uint32_t torque = 0;
  };

  CanopenWrenchSource(const ForceTorqueSensor& sensor, const CobIds& ids)
      : ids_(ids),
        force_per_count_N_(sensor.force_per_count_N),
        torque_per_count_Nm_(sensor.torque_per_count_Nm) {}

  [[nodiscard]] Taken take(const CanFrame& frame, std::int64_t time_ns,
                           WrenchHalf& half) noexcept override;
  [[nodiscard]] std::optional<Vector3> force_N(const WrenchHalf& half) const noexcept override;
  [[nodiscard]] Vector6 wrench(const std::array<std::int16_t, 6>& raw) const noexcept override;

 private:
  const CobIds ids_;
  const double force_per_count_N_;
  const double torque_per_count_Nm_;
};

}  // namespace tenon::hw

#pragma once
// A Robotous RFT sensor, which streams samples by its own clock, each in two frames:
//
//   first:  | 0 0Bh | 1-2 fx | 3-4 fy | 5-6 fz | 7 tx, high byte |     i16, big-endian
//   second: | 0 tx, low byte | 1-2 ty | 3-4 tz | 5 overload | 6-7 |
//
// It numbers no samples: hw/sensors/sample_count.h does. Real-time, no clock; one thread.

#include <cstdint>

#include "hw/sensors/sample_count.h"
#include "shared/cell/robot.h"
#include "shared/ports/wrench_source.h"

namespace tenon::hw {

class RobotousRftSource final : public WrenchSource {
 public:
  explicit RobotousRftSource(const ForceTorqueSensor& sensor);

  void reset() noexcept override { count_.close(); }
  [[nodiscard]] Taken take(const CanFrame& frame, std::int64_t time_ns,
                           WrenchHalf& half) noexcept override;
  [[nodiscard]] std::optional<Vector3> force_N(const WrenchHalf& half) const noexcept override;
  [[nodiscard]] Vector6 wrench(const std::array<std::int16_t, 6>& raw) const noexcept override;

 private:
  [[nodiscard]] Taken take_first(const CanFrame& frame, std::int64_t time_ns,
                                 WrenchHalf& half) noexcept;

  const std::array<std::uint32_t, 2> ids_;
  const double force_per_count_N_;
  const double torque_per_count_Nm_;
  SampleCount count_;
  std::uint8_t tx_high_ = 0;  ///< of the last first frame
};

}  // namespace tenon::hw

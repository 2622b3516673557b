#pragma once
// An ATI NETCANOEM board, which is polled: each cycle in which a sample is due it is sent an empty
// frame, and answers by two frames of strain gauges:
//
//   first,  base << 4:      | 0-1 status | 2-3 g0 | 4-5 g2 | 6-7 g4 |     u16 and i16, big-endian
//   second, base << 4 | 1:  | 0-1 g1 | 2-3 g3 | 4-5 g5 |
//
// No half tells a force: it takes all gauges and the sensor's own calibration, which its start
// (hw/sensors/ati_netcanoem_start.h) has read. It numbers no samples: hw/sensors/sample_count.h
// does, and what was asked before is not joined with what is asked now. Real-time, no clock; one
// thread.

#include <cstdint>
#include <optional>

#include "hw/sensors/sample_count.h"
#include "shared/cell/robot.h"
#include "shared/ports/wrench_source.h"

namespace tenon::hw {

class AtiNetcanoemSource final : public WrenchSource {
 public:
  using Matrix = Eigen::Matrix<double, 6, 6>;

  explicit AtiNetcanoemSource(const ForceTorqueSensor& sensor);

  /// From now on. @param wrench_per_gauge N and Nm of gauges 0 to 5
  void calibrate(const Matrix& wrench_per_gauge) noexcept { matrix_ = wrench_per_gauge; }

  void reset() noexcept override;
  [[nodiscard]] std::optional<CanFrame> begin_cycle() noexcept override;
  [[nodiscard]] Taken take(const CanFrame& frame, std::int64_t time_ns,
                           WrenchHalf& half) noexcept override;
  [[nodiscard]] std::optional<Vector3> force_N(const WrenchHalf& /*half*/) const noexcept override {
    return std::nullopt;
  }
  /// @param raw gauges 0 2 4 1 3 5, as its halves bring them
  [[nodiscard]] Vector6 wrench(const std::array<std::int16_t, 6>& raw) const noexcept override;

 private:
  const std::array<std::uint32_t, 2> ids_;
  const int cycles_per_sample_;
  int cycles_until_request_ = 0;
  SampleCount count_;
  Matrix matrix_ = Matrix::Zero();
};

}  // namespace tenon::hw

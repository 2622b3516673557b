#pragma once
// The start of an ATI NETCANOEM board: its calibration matrix is read row by row, then counts a
// unit and units, then a whole sample, whose status must be good. What the board says of itself is
// judged: a matrix that is none, counts of 0, units that nobody knows, and a calibration that does
// not come to the sensor's range are refused. Its bias and its choice of a calibration are left
// alone.

#include <array>
#include <cstdint>

#include "hw/sensors/ati_netcanoem_source.h"
#include "hw/sensors/sensor_start.h"
#include "shared/cell/robot.h"

namespace tenon::hw {

class AtiNetcanoemStart final : public SensorStart {
 public:
  /// @param source is calibrated in the end; must outlive it
  AtiNetcanoemStart(const ForceTorqueSensor& sensor, AtiNetcanoemSource& source)
      : SensorStart(sensor.bus()),
        request_id_(sensor.request_id),
        ranges_{sensor.force_range_N, sensor.torque_range_Nm},
        source_(source) {}

 private:
  using Matrix = AtiNetcanoemSource::Matrix;
  static constexpr std::size_t kRows = 6;
  static constexpr std::size_t kCounts = 6;
  static constexpr std::size_t kUnits = 7;
  static constexpr std::size_t kGauges = 8;

  [[nodiscard]] std::size_t questions() const override { return kGauges + 1; }
  [[nodiscard]] Question question(std::size_t which) const override;
  void begin(std::size_t which) override;
  [[nodiscard]] Heard hear(std::size_t which, const CanFrame& frame, ArmFault& fault) override;

  [[nodiscard]] Heard hear_row(std::size_t row, std::uint32_t part, const CanFrame& frame);
  [[nodiscard]] Heard hear_counts(const CanFrame& frame, ArmFault& fault);
  [[nodiscard]] Heard hear_units(const CanFrame& frame, ArmFault& fault);
  /// With all gauges at their ends every axis must come to its range: what reads less than the
  /// sensor's file says is another sensor's, or in another unit. @param calibration N, Nm a count
  [[nodiscard]] bool spans_ranges(const Matrix& calibration, ArmFault& fault) const;

  const std::uint32_t request_id_;
  const std::array<double, 2> ranges_;  ///< N, Nm
  AtiNetcanoemSource& source_;
  Matrix matrix_ = Matrix::Zero();  ///< as the board has it
  unsigned parts_ = 0;              ///< of the present answer that have come, a bit each
  std::array<double, 2> counts_{};  ///< a unit of force, of torque
};

}  // namespace tenon::hw

#pragma once
// An ATI NETCANOEM board and the gauges of its sensor: it answers requests for gauges (0), rows of
// its calibration matrix (2), counts a unit (7) and units (8). Its gauges are what its own matrix
// makes the wrench of. No node: no NMT, no SDO, no heartbeat. One thread.
//
// Torn force: in turns a sample lacks its second frame and the next its first, as where the bus
// lost them. Stale force: it does not answer. Saturated force: its gauges are at their ends.

#include <array>
#include <cstdint>
#include <vector>

#include "shared/cell/robot.h"
#include "sim/cell/devices/virtual_sensor.h"
#include "sim/cell/devices/wrench_sampler.h"

namespace tenon::sim {

class NetcanoemSensor final : public VirtualSensor {
 public:
  using Matrix = Eigen::Matrix<double, 6, 6>;

  NetcanoemSensor(const ForceTorqueSensor& sensor, std::uint64_t seed,
                  const SensorImperfections& imperfections);

  /// Counts of each axis by gauge, what answers to operation 2.
  [[nodiscard]] const Matrix& matrix() const { return matrix_; }

  void power_on(std::int64_t now_ns) override;
  void receive(const CanFrame& frame, std::int64_t now_ns) override;
  void take(std::vector<CanFrame>& frames) override;
  void advance(std::int64_t now_ns) override { sampler_.advance(now_ns); }
  [[nodiscard]] bool is_asked_by(const CanFrame& frame) const override;
  void measured(const Vector6& wrench, std::int64_t step_ns) override {
    sampler_.measured(wrench, step_ns);
  }
  void inject(const Fault& fault) override;

 private:
  void answer(std::uint32_t operation, std::uint8_t length,
              const std::array<std::uint8_t, 8>& bytes);
  void answer_gauges();
  void answer_row(std::size_t row);
  void answer_counts();

  ForceTorqueSensor sensor_;
  WrenchSampler sampler_;
  Matrix matrix_;
  Matrix gauges_of_counts_;
  std::vector<CanFrame> outgoing_;
  bool tore_first_ = false;  ///< of the last torn sample
};

}  // namespace tenon::sim

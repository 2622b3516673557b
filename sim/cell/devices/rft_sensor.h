#pragma once
// A Robotous RFT sensor on CAN. It answers its commands (start 0Bh, stop 0Ch, rate 0Fh) and streams
// by its own clock, two frames a sample, that of its power-on being its phase. No node: no NMT, no
// SDO, no heartbeat. One thread.
//
// Torn force: in turns a sample lacks its second frame and the next its first, as where the bus
// lost them. Stale force: it sends nothing.

#include <array>
#include <cstdint>
#include <vector>

#include "shared/cell/robot.h"
#include "sim/cell/devices/virtual_sensor.h"
#include "sim/cell/devices/wrench_sampler.h"

namespace tenon::sim {

class RftSensor final : public VirtualSensor {
 public:
  RftSensor(const ForceTorqueSensor& sensor, std::uint64_t seed,
            const SensorImperfections& imperfections)
      : sensor_(sensor), sampler_(sensor, seed, imperfections) {}

  void power_on(std::int64_t now_ns) override;
  void receive(const CanFrame& frame, std::int64_t now_ns) override;
  void take(std::vector<CanFrame>& frames) override;
  void advance(std::int64_t now_ns) override { sampler_.advance(now_ns); }
  [[nodiscard]] bool is_asked_by(const CanFrame& /*frame*/) const override { return false; }
  [[nodiscard]] bool is_due(std::int64_t now_ns) const override {
    return streams_ && now_ns >= next_ns_;
  }
  void stream(std::int64_t now_ns) override;
  void measured(const Vector6& wrench, std::int64_t step_ns) override {
    sampler_.measured(wrench, step_ns);
  }
  void inject(const Fault& fault) override;

 private:
  using Response = std::array<std::uint8_t, 16>;
  /// @param frames bit 0: D1 to D8, bit 1: D9 to D16
  void send(const Response& response, unsigned frames);
  void set_rate(std::uint8_t code);

  ForceTorqueSensor sensor_;
  WrenchSampler sampler_;
  std::vector<CanFrame> outgoing_;
  int rate_hz_ = 200;
  bool streams_ = false;
  bool tore_first_ = false;  ///< of the last torn sample
  std::int64_t next_ns_ = 0;
};

}  // namespace tenon::sim

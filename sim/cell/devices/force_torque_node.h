#pragma once
// A force/torque sensor as a CANopen node. With each SYNC a sample is taken and sent in two PDOs
// that carry the same sample counter. Objects 6401h:1..6, 2001h, 2002h; 2003h tares. One thread.

#include <cstdint>
#include <string>
#include <vector>

#include "shared/cell/robot.h"
#include "shared/math/pose.h"
#include "sim/cell/canopen/slave_node.h"
#include "sim/cell/devices/virtual_sensor.h"
#include "sim/cell/devices/wrench_sampler.h"

namespace tenon::sim {

class ForceTorqueNode final : public VirtualSensor, private NodeApplication {
 public:
  /// 2002h.
  static constexpr std::uint16_t kStatusGood = 0;
  static constexpr std::uint16_t kStatusSaturated = 1;

  using Imperfections = SensorImperfections;

  ForceTorqueNode(const ForceTorqueSensor& sensor, std::uint64_t seed,
                  const Imperfections& imperfections,
                  const std::string& name = "tenon virtual force/torque sensor");
  ForceTorqueNode(const ForceTorqueSensor& sensor, std::uint64_t seed)
      : ForceTorqueNode(sensor, seed, Imperfections{}) {}

  [[nodiscard]] SlaveNode& node() { return node_; }
  [[nodiscard]] const SlaveNode& node() const { return node_; }

  void power_on(std::int64_t now_ns) override { node_.power_on(now_ns); }
  void receive(const CanFrame& frame, std::int64_t now_ns) override {
    node_.receive(frame, now_ns);
  }
  void take(std::vector<CanFrame>& frames) override { node_.take(frames); }
  void advance(std::int64_t now_ns) override;
  [[nodiscard]] bool is_asked_by(const CanFrame& frame) const override;
  void measured(const Vector6& wrench, std::int64_t step_ns) override {
    sampler_.measured(wrench, step_ns);
  }
  /// Node reset, silent node and emergency are drawn once.
  void inject(const Fault& fault) override;

 private:
  void on_reset(std::int64_t now_ns) override;
  void on_sample() override;
  void on_sync() override {}
  void on_connection_lost() override {}

  void add_objects();

  SlaveNode node_;
  WrenchSampler sampler_;
  std::int64_t now_ns_ = 0;
  std::uint16_t counter_ = 0;
};

}  // namespace tenon::sim

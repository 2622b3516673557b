#pragma once
// A force/torque sensor as a CANopen node: with each SYNC it takes a sample of the wrench, with
// noise, quantisation and saturation, and sends it in two PDOs that carry the same sample counter.
// Objects 6401h:1..6, 2001h, 2002h. The noise is the same for the same seed, on every platform. One
// thread.

#include <cstdint>
#include <string>

#include "shared/cell/robot.h"
#include "shared/math/pose.h"
#include "sim/canopen/slave_node.h"
#include "sim/devices/normal_source.h"

namespace tenon::sim {

class ForceTorqueNode final : private NodeApplication {
 public:
  /// 2002h.
  static constexpr std::uint16_t kStatusGood = 0;
  static constexpr std::uint16_t kStatusSaturated = 1;

  ForceTorqueNode(const ForceTorqueSensor& sensor, std::uint64_t seed,
                  const std::string& name = "tenon virtual force/torque sensor");

  [[nodiscard]] SlaveNode& node() { return node_; }
  [[nodiscard]] const SlaveNode& node() const { return node_; }

  void advance(std::int64_t now_ns) { node_.advance(now_ns); }
  /// The true wrench at the sensor, in its axes, that the next SYNC samples.
  void measured(const Vector6& wrench) { wrench_ = wrench; }

 private:
  void on_reset(std::int64_t now_ns) override;
  void on_sample() override;
  void on_sync() override {}
  void on_connection_lost() override {}

  ForceTorqueSensor sensor_;
  SlaveNode node_;
  NormalSource noise_;
  Vector6 wrench_ = Vector6::Zero();
  std::uint16_t counter_ = 0;
};

}  // namespace tenon::sim

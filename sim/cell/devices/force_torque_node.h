#pragma once
// A force/torque sensor as a CANopen node. The wrench passes a filter of first order, drifts, and
// with each SYNC a sample of it is taken with noise, quantisation and saturation, and sent in two
// PDOs that carry the same sample counter. Objects 6401h:1..6, 2001h, 2002h; 2003h tares. Noise and
// drift are the same for the same seed, on every platform. One thread.

#include <cstdint>
#include <string>

#include "shared/base/random.h"
#include "shared/cell/robot.h"
#include "shared/math/pose.h"
#include "sim/cell/canopen/slave_node.h"
#include "sim/cell/devices/active_faults.h"

namespace tenon::sim {

class ForceTorqueNode final : private NodeApplication {
 public:
  /// 2002h.
  static constexpr std::uint16_t kStatusGood = 0;
  static constexpr std::uint16_t kStatusSaturated = 1;

  /// What a data sheet does not promise to be zero.
  struct Imperfections {
    double filter_s = 0.0;             ///< time constant
    Vector6 bias = Vector6::Zero();    ///< at power-on, N and Nm
    double force_drift_N_sqrts = 0.0;  ///< of the bias's random walk: standard deviation after 1 s
    double torque_drift_Nm_sqrts = 0.0;
  };

  ForceTorqueNode(const ForceTorqueSensor& sensor, std::uint64_t seed,
                  const Imperfections& imperfections,
                  const std::string& name = "tenon virtual force/torque sensor");
  ForceTorqueNode(const ForceTorqueSensor& sensor, std::uint64_t seed)
      : ForceTorqueNode(sensor, seed, Imperfections{}) {}

  [[nodiscard]] SlaveNode& node() { return node_; }
  [[nodiscard]] const SlaveNode& node() const { return node_; }

  /// Timers, and the drift.
  void advance(std::int64_t now_ns);
  /// The true wrench at the sensor, in its axes, over the last `step_ns`. Without a filter the next
  /// SYNC samples it as it is.
  void measured(const Vector6& wrench, std::int64_t step_ns);

  /// Begins a fault now, that is at the time of the last advance(). Node reset, silent node and
  /// emergency are drawn once; stale, torn, saturated and frozen force strike each sample by their
  /// probability; drifting and forged force last. Others are not a sensor's, and ignored.
  void inject(const Fault& fault);

 private:
  void on_reset(std::int64_t now_ns) override;
  void on_sample() override;
  void on_sync() override {}
  void on_connection_lost() override {}

  void add_objects();
  void drift(std::int64_t step_ns);
  void sample_axis(int axis, bool saturated);
  /// What faults add along x.
  [[nodiscard]] double forged_N() const;

  ForceTorqueSensor sensor_;
  Imperfections imperfections_;
  SlaveNode node_;
  Random noise_;
  Random drift_;
  ActiveFaults faults_;
  Vector6 filtered_ = Vector6::Zero();
  Vector6 bias_ = Vector6::Zero();
  Vector6 tare_ = Vector6::Zero();
  std::int64_t now_ns_ = 0;
  std::int64_t drifting_since_ns_ = 0;
  std::uint16_t counter_ = 0;
  std::uint16_t status_ = kStatusGood;
};

}  // namespace tenon::sim

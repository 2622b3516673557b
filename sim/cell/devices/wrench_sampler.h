#pragma once
// What is inside a virtual force/torque sensor, whatever it speaks: the wrench passes a filter of
// first order, drifts, and a sample of it has noise, quantisation and saturation, and what injected
// faults make of it. Noise and drift are the same for the same seed, on every platform. One thread.

#include <array>
#include <cstdint>

#include "shared/base/random.h"
#include "shared/cell/robot.h"
#include "shared/math/pose.h"
#include "sim/cell/devices/active_faults.h"

namespace tenon::sim {

/// What a data sheet does not promise to be zero.
struct SensorImperfections {
  double filter_s = 0.0;             ///< time constant
  Vector6 bias = Vector6::Zero();    ///< at power-on, N and Nm
  double force_drift_N_sqrts = 0.0;  ///< of the bias's random walk: standard deviation after 1 s
  double torque_drift_Nm_sqrts = 0.0;
};

class WrenchSampler {
 public:
  struct Sample {
    Vector6 wrench = Vector6::Zero();      ///< within the ranges, N and Nm
    std::array<std::int16_t, 6> counts{};  ///< the same, rounded
    std::uint8_t saturated = 0;            ///< bit i: axis i is at its range
    bool forced = false;                   ///< a fault has put all there
    bool overrange = false;                ///< a fault makes the sensor tell that it is overloaded
  };

  WrenchSampler(const ForceTorqueSensor& sensor, std::uint64_t seed,
                const SensorImperfections& imperfections);

  void power_on(std::int64_t now_ns);
  /// Tells the time; ends faults that are over.
  void advance(std::int64_t now_ns);
  /// The true wrench at the sensor, in its axes, over the last `step_ns`. Without a filter the next
  /// sample is of it as it is.
  void measured(const Vector6& wrench, std::int64_t step_ns);
  /// A new one, or the last again where it is frozen.
  const Sample& sample();
  /// From now on what it measures now is its zero, or no more.
  void tare(bool on);

  /// Stale, torn, saturated, frozen and overrange force strike each sample by their probability;
  /// drifting and forged force, wrong units and a wrong matrix last.
  void inject(const Fault& fault);
  /// Draws: what is not the wrench's own is its face's to carry out.
  [[nodiscard]] bool strikes(FaultKind kind) { return faults_.strikes(kind); }
  [[nodiscard]] bool has(FaultKind kind) const { return faults_.find(kind) != nullptr; }

 private:
  /// Since the last sample: a random walk has no need of steps between.
  void drift();
  void sample_axis(int axis, bool saturated);
  /// Before noise: filter, bias and tare, and what a wrong calibration makes of them.
  [[nodiscard]] double reading(int axis) const;
  /// What faults add along x.
  [[nodiscard]] double forged_N() const;

  ForceTorqueSensor sensor_;
  SensorImperfections imperfections_;
  Random noise_;
  Random drift_;
  ActiveFaults faults_;
  Sample sample_;
  Vector6 filtered_ = Vector6::Zero();
  Vector6 bias_ = Vector6::Zero();
  Vector6 tare_ = Vector6::Zero();
  std::int64_t now_ns_ = 0;
  std::int64_t drifted_ns_ = 0;  ///< bias_ is of then
  std::int64_t drifting_since_ns_ = 0;
};

}  // namespace tenon::sim

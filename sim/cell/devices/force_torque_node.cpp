#include "sim/cell/devices/force_torque_node.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

namespace tenon::sim {
namespace {

constexpr std::uint32_t kMeasuringDevice = 0x00000194;  // 1000h: CiA 404
constexpr std::uint32_t kSensorProductCode = 0x0404;
constexpr std::uint16_t kTare = 0x2003;
constexpr std::int64_t kCountMax = 32767;

constexpr std::uint32_t mapping(std::uint16_t index, std::uint8_t sub) {
  return static_cast<std::uint32_t>(index) << 16 | static_cast<std::uint32_t>(sub) << 8 | 16U;
}

std::vector<PdoDefaults> pdos(std::uint8_t node) {
  using canopen::kForceInputs;
  const std::uint32_t counter = mapping(canopen::kSampleCounter, 0);
  return {
      {canopen::kTpdo1 + node,
       1,
       {mapping(kForceInputs, 1), mapping(kForceInputs, 2), mapping(kForceInputs, 3), counter}},
      {canopen::kTpdo2 + node,
       1,
       {mapping(kForceInputs, 4), mapping(kForceInputs, 5), mapping(kForceInputs, 6), counter}}};
}

}  // namespace

ForceTorqueNode::ForceTorqueNode(const ForceTorqueSensor& sensor, std::uint64_t seed,
                                 const Imperfections& imperfections, const std::string& name)
    : sensor_(sensor),
      imperfections_(imperfections),
      node_({.node = sensor.node,
             .device_type = kMeasuringDevice,
             .product_code = kSensorProductCode,
             .name = name,
             .receive_pdos = {},
             .transmit_pdos = pdos(sensor.node)},
            *this),
      noise_(stream_seed(seed, "sensor_noise")),
      drift_(stream_seed(seed, "sensor_drift")),
      bias_(imperfections.bias) {
  add_objects();
}

void ForceTorqueNode::add_objects() {
  using enum DataType;
  static constexpr std::array kNames = {"Force x",  "Force y",  "Force z",
                                        "Torque x", "Torque y", "Torque z"};
  ObjectDictionary& dictionary = node_.dictionary();
  dictionary.describe(canopen::kForceInputs, {"Wrench", Structure::kArray});
  dictionary.add(object_id(canopen::kForceInputs),
                 {.name = "Highest sub-index supported", .value = 6});
  for (std::uint8_t sub = 1; sub <= 6; ++sub) {
    dictionary.add(object_id(canopen::kForceInputs, sub),
                   {.name = kNames[sub - 1U], .type = kI16, .mappable = Mappable::kTransmit});
  }
  dictionary.add(object_id(canopen::kSampleCounter),
                 {.name = "Sample counter", .type = kU16, .mappable = Mappable::kTransmit});
  dictionary.add(object_id(canopen::kSensorStatus),
                 {.name = "Sensor status", .type = kU16, .mappable = Mappable::kTransmit});
  // 1 makes what it measures now its zero, 0 takes that back.
  dictionary.add(object_id(kTare), {.name = "Tare",
                                    .type = kU8,
                                    .access = Access::kWriteOnly,
                                    .high = 1,
                                    .is_command = true,
                                    .on_write = [this](std::int64_t value) {
                                      tare_ = Vector6::Zero();
                                      if (value == 1) tare_ = filtered_ + bias_;
                                      return 0U;
                                    }});
}

void ForceTorqueNode::on_reset(std::int64_t now_ns) {
  now_ns_ = now_ns;
  counter_ = 0;
  tare_ = Vector6::Zero();
}

void ForceTorqueNode::advance(std::int64_t now_ns) {
  drift(now_ns - now_ns_);
  now_ns_ = now_ns;
  faults_.advance(now_ns);
  node_.set_silent(faults_.find(FaultKind::kSilentNode) != nullptr);
  node_.advance(now_ns);
}

void ForceTorqueNode::drift(std::int64_t step_ns) {
  const double sqrt_s = std::sqrt(std::max(0.0, static_cast<double>(step_ns) * 1e-9));
  if (imperfections_.force_drift_N_sqrts > 0.0) {
    for (int i = 0; i < 3; ++i)
      bias_[i] += imperfections_.force_drift_N_sqrts * sqrt_s * drift_.normal();
  }
  if (imperfections_.torque_drift_Nm_sqrts > 0.0) {
    for (int i = 3; i < 6; ++i)
      bias_[i] += imperfections_.torque_drift_Nm_sqrts * sqrt_s * drift_.normal();
  }
}

void ForceTorqueNode::measured(const Vector6& wrench, std::int64_t step_ns) {
  // Exact where the wrench is constant over the step.
  const double part =
      imperfections_.filter_s > 0.0
          ? -std::expm1(-1e-9 * static_cast<double>(step_ns) / imperfections_.filter_s)
          : 1.0;
  filtered_ += part * (wrench - filtered_);
}

void ForceTorqueNode::on_sample() {
  if (faults_.strikes(FaultKind::kStaleForce)) return;
  if (faults_.strikes(FaultKind::kTornForce)) node_.repeat_transmit_pdo(1);
  const bool saturated = faults_.strikes(FaultKind::kSaturatedForce);
  if (!faults_.strikes(FaultKind::kFrozenForce)) {
    status_ = kStatusGood;
    for (int axis = 0; axis < 6; ++axis) sample_axis(axis, saturated);
  }
  ++counter_;
  node_.dictionary().set(object_id(canopen::kSampleCounter), counter_);
  node_.dictionary().set(object_id(canopen::kSensorStatus), status_);
}

void ForceTorqueNode::sample_axis(int axis, bool saturated) {
  const bool force = axis < 3;
  const double range = force ? sensor_.force_range_N : sensor_.torque_range_Nm;
  const double sigma = force ? sensor_.force_noise_N : sensor_.torque_noise_Nm;
  const double per_count = force ? sensor_.force_per_count_N : sensor_.torque_per_count_Nm;
  const double value = filtered_[axis] + bias_[axis] - tare_[axis] + sigma * noise_.normal() +
                       (axis == 0 ? forged_N() : 0.0);
  if (saturated || !(std::abs(value) < range)) status_ = kStatusSaturated;
  const double limited = saturated ? range : std::clamp(value, -range, range);
  const std::int64_t counts = std::llround(limited / per_count);
  node_.dictionary().set(object_id(canopen::kForceInputs, static_cast<std::uint8_t>(axis + 1)),
                         std::clamp(counts, -kCountMax, kCountMax));
}

double ForceTorqueNode::forged_N() const {
  const Fault* forged = faults_.find(FaultKind::kForgedForce);
  const Fault* drifting = faults_.find(FaultKind::kDriftingForce);
  double force_N = forged == nullptr ? 0.0 : forged->value;
  if (drifting != nullptr) {
    force_N += drifting->value * 1e-9 * static_cast<double>(now_ns_ - drifting_since_ns_);
  }
  return force_N;
}

void ForceTorqueNode::inject(const Fault& fault) {
  const FaultTarget target = target_of(fault.kind);
  if (fault.kind == FaultKind::kDriftingForce) drifting_since_ns_ = now_ns_;
  if (target == FaultTarget::kSensor) return faults_.begin(fault, now_ns_);
  if (target != FaultTarget::kNode || !happens(fault)) return;
  if (fault.kind == FaultKind::kNodeReset) return node_.power_on(now_ns_);
  if (fault.kind == FaultKind::kEmergency) return node_.raise_error(emergency_code(fault));
  node_.set_silent(true);
  faults_.begin(fault, now_ns_);
}

}  // namespace tenon::sim

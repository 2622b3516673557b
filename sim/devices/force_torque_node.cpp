#include "sim/devices/force_torque_node.h"

#include <algorithm>
#include <cmath>

namespace tenon::sim {
namespace {

constexpr std::uint32_t kMeasuringDevice = 0x00000194;  // 1000h: CiA 404
constexpr std::uint32_t kProductCode = 0x0404;
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
                                 const std::string& name)
    : sensor_(sensor),
      node_({.node = sensor.node,
             .device_type = kMeasuringDevice,
             .product_code = kProductCode,
             .name = name,
             .receive_pdos = {},
             .transmit_pdos = pdos(sensor.node)},
            *this),
      noise_(seed) {
  ObjectDictionary& dictionary = node_.dictionary();
  dictionary.add(object_id(canopen::kForceInputs), {.type = DataType::kU8, .value = 6});
  for (std::uint8_t sub = 1; sub <= 6; ++sub) {
    dictionary.add(object_id(canopen::kForceInputs, sub),
                   {.type = DataType::kI16, .mappable = Mappable::kTransmit});
  }
  dictionary.add(object_id(canopen::kSampleCounter),
                 {.type = DataType::kU16, .mappable = Mappable::kTransmit});
  dictionary.add(object_id(canopen::kSensorStatus),
                 {.type = DataType::kU16, .mappable = Mappable::kTransmit});
}

void ForceTorqueNode::on_reset(std::int64_t /*now_ns*/) { counter_ = 0; }

void ForceTorqueNode::on_sample() {
  std::uint16_t status = kStatusGood;
  for (int axis = 0; axis < 6; ++axis) {
    const bool force = axis < 3;
    const double range = force ? sensor_.force_range_N : sensor_.torque_range_Nm;
    const double sigma = force ? sensor_.force_noise_N : sensor_.torque_noise_Nm;
    const double per_count = force ? sensor_.force_per_count_N : sensor_.torque_per_count_Nm;
    const double value = wrench_[axis] + sigma * noise_.next();
    if (!(std::abs(value) < range)) status = kStatusSaturated;
    const std::int64_t counts = std::llround(std::clamp(value, -range, range) / per_count);
    node_.dictionary().set(object_id(canopen::kForceInputs, static_cast<std::uint8_t>(axis + 1)),
                           std::clamp(counts, -kCountMax, kCountMax));
  }
  ++counter_;
  node_.dictionary().set(object_id(canopen::kSampleCounter), counter_);
  node_.dictionary().set(object_id(canopen::kSensorStatus), status);
}

}  // namespace tenon::sim

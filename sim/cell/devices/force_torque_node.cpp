#include "sim/cell/devices/force_torque_node.h"

#include <array>
#include <vector>

namespace tenon::sim {
namespace {

constexpr std::uint32_t kMeasuringDevice = 0x00000194;  // 1000h: CiA 404
constexpr std::uint32_t kSensorProductCode = 0x0404;
constexpr std::uint16_t kTare = 0x2003;
constexpr std::uint16_t kOverload = 0xFF01;  // of the device's own (CiA 301, 7.2.7.1)

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
    : node_({.node = sensor.node,
             .device_type = kMeasuringDevice,
             .product_code = kSensorProductCode,
             .name = name,
             .receive_pdos = {},
             .transmit_pdos = pdos(sensor.node)},
            *this),
      sampler_(sensor, seed, imperfections) {
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
                                      sampler_.tare(value == 1);
                                      return 0U;
                                    }});
}

void ForceTorqueNode::on_reset(std::int64_t now_ns) {
  now_ns_ = now_ns;
  counter_ = 0;
  sampler_.power_on(now_ns);
}

void ForceTorqueNode::advance(std::int64_t now_ns) {
  now_ns_ = now_ns;
  sampler_.advance(now_ns);
  node_.set_silent(sampler_.has(FaultKind::kSilentNode));
  node_.advance(now_ns);
}

bool ForceTorqueNode::is_asked_by(const CanFrame& frame) const {
  return frame.id == canopen::kSync && !frame.extended;
}

void ForceTorqueNode::on_sample() {
  if (sampler_.strikes(FaultKind::kStaleForce)) return;
  if (sampler_.strikes(FaultKind::kTornForce)) node_.repeat_transmit_pdo(1);
  const WrenchSampler::Sample& sample = sampler_.sample();
  for (std::uint8_t axis = 0; axis < 6; ++axis) {
    node_.dictionary().set(object_id(canopen::kForceInputs, static_cast<std::uint8_t>(axis + 1)),
                           sample.counts[axis]);
  }
  ++counter_;
  node_.dictionary().set(object_id(canopen::kSampleCounter), counter_);
  node_.dictionary().set(
      object_id(canopen::kSensorStatus),
      sample.saturated != 0 || sample.overrange ? kStatusSaturated : kStatusGood);
  sample.overrange ? node_.raise_error(kOverload) : node_.clear_error(kOverload);
}

void ForceTorqueNode::inject(const Fault& fault) {
  const FaultTarget target = target_of(fault.kind);
  if (target == FaultTarget::kSensor) return sampler_.inject(fault);
  if (target != FaultTarget::kNode || !happens(fault)) return;
  if (fault.kind == FaultKind::kNodeReset) return node_.power_on(now_ns_);
  if (fault.kind == FaultKind::kEmergency) return node_.raise_error(emergency_code(fault));
  node_.set_silent(true);
  sampler_.inject(fault);
}

}  // namespace tenon::sim

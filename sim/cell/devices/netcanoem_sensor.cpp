#include "sim/cell/devices/netcanoem_sensor.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstddef>

#include "shared/sensors/ati_netcanoem.h"

namespace tenon::sim {
namespace {

constexpr double kGaugeMax = 32767.0;
/// The gauge that an overload drives to its end.
constexpr std::size_t kOverloaded = 3;
/// What a range makes of the gauges, so that there is room beyond it.
constexpr double kGaugeAtRange = 16000.0;
constexpr std::uint32_t kCountsPerNewton = 1'000'000;
constexpr std::uint32_t kCountsPerNewtonMetre = 1'000'000;

using Bytes = std::array<std::uint8_t, 8>;

void put(Bytes& bytes, std::size_t at, std::uint32_t value, std::size_t size) {
  for (std::size_t i = 0; i < size; ++i) {
    bytes[at + i] = static_cast<std::uint8_t>(value >> 8U * (size - 1 - i));
  }
}

/// Every gauge feels every axis, as in a real sensor; the first ones the first axes most. Rounded
/// to the floats that go over the bus.
NetcanoemSensor::Matrix matrix_of(const ForceTorqueSensor& sensor) {
  NetcanoemSensor::Matrix matrix;
  for (Eigen::Index axis = 0; axis < 6; ++axis) {
    const double range = axis < 3 ? sensor.force_range_N * kCountsPerNewton
                                  : sensor.torque_range_Nm * kCountsPerNewtonMetre;
    for (Eigen::Index gauge = 0; gauge < 6; ++gauge) {
      const auto apart = static_cast<double>((gauge - axis + 6) % 6);
      const double weight = apart == 0.0 ? 1.0 : 0.12 - 0.04 * apart;
      matrix(axis, gauge) = static_cast<float>(range / kGaugeAtRange * weight);
    }
  }
  return matrix;
}

}  // namespace

NetcanoemSensor::NetcanoemSensor(const ForceTorqueSensor& sensor, std::uint64_t seed,
                                 const SensorImperfections& imperfections)
    : sensor_(sensor),
      sampler_(sensor, seed, imperfections),
      matrix_(matrix_of(sensor)),
      gauges_of_counts_(matrix_.inverse()) {}

void NetcanoemSensor::power_on(std::int64_t now_ns) {
  sampler_.power_on(now_ns);
  outgoing_.clear();
}

bool NetcanoemSensor::is_asked_by(const CanFrame& frame) const {
  return frame.id == (sensor_.request_id | ati::kReadGauges) && frame.length == 0 &&
         !frame.extended && !frame.remote;
}

void NetcanoemSensor::receive(const CanFrame& frame, std::int64_t /*now_ns*/) {
  if (is_asked_by(frame)) return answer_gauges();
  if (frame.extended || frame.remote) return;
  if (frame.id == (sensor_.request_id | ati::kReadMatrixRow) && frame.length == 1) {
    if (frame.data[0] < 6) answer_row(frame.data[0]);
  } else if (frame.id == (sensor_.request_id | ati::kReadCounts) && frame.length == 0) {
    answer_counts();
  } else if (frame.id == (sensor_.request_id | ati::kReadUnits) && frame.length == 0) {
    answer(ati::kReadUnits, 2, {ati::kNewton, ati::kNewtonMetre});
  }
}

void NetcanoemSensor::answer_gauges() {
  if (sampler_.strikes(FaultKind::kStaleForce)) return;
  const bool torn = sampler_.strikes(FaultKind::kTornForce);
  const WrenchSampler::Sample& sample = sampler_.sample();
  Vector6 counts = sample.wrench;
  counts.head<3>() *= kCountsPerNewton;
  counts.tail<3>() *= kCountsPerNewtonMetre;
  const Vector6 gauges = gauges_of_counts_ * counts;
  std::array<std::uint16_t, 6> raw{};
  for (std::size_t i = 0; i < 6; ++i) {
    const double gauge = gauges[static_cast<Eigen::Index>(i)];
    const double held = sample.forced ? kGaugeMax : std::clamp(gauge, -kGaugeMax, kGaugeMax);
    raw[i] = static_cast<std::uint16_t>(static_cast<std::int16_t>(std::lround(held)));
  }
  // An overload is a gauge at its end, whatever the matrix makes of it.
  if (sample.overrange) raw[kOverloaded] = static_cast<std::uint16_t>(kGaugeMax);
  Bytes first{};
  Bytes second{};
  for (std::size_t i = 0; i < 3; ++i) {
    put(first, 2 + 2 * i, raw[2 * i], 2);
    put(second, 2 * i, raw[2 * i + 1], 2);
  }
  if (torn) tore_first_ = !tore_first_;
  if (!torn || tore_first_) answer(ati::kReadGauges, 8, first);
  if (!torn || !tore_first_) answer(ati::kGaugesSecond, 6, second);
}

void NetcanoemSensor::answer_row(std::size_t row) {
  for (std::uint32_t part = 0; part < 3; ++part) {
    Bytes bytes{};
    for (std::size_t i = 0; i < 2; ++i) {
      const double value =
          matrix_(static_cast<Eigen::Index>(row), static_cast<Eigen::Index>(2 * part + i));
      put(bytes, 4 * i, std::bit_cast<std::uint32_t>(static_cast<float>(value)), 4);
    }
    answer(ati::kReadMatrixRow + part, 8, bytes);
  }
}

void NetcanoemSensor::answer_counts() {
  Bytes bytes{};
  put(bytes, 0, kCountsPerNewton, 4);
  put(bytes, 4, kCountsPerNewtonMetre, 4);
  answer(ati::kReadCounts, 8, bytes);
}

void NetcanoemSensor::answer(std::uint32_t operation, std::uint8_t length, const Bytes& bytes) {
  outgoing_.push_back({sensor_.request_id | operation, false, false, length, bytes});
}

void NetcanoemSensor::take(std::vector<CanFrame>& frames) {
  frames.insert(frames.end(), outgoing_.begin(), outgoing_.end());
  outgoing_.clear();
}

void NetcanoemSensor::inject(const Fault& fault) {
  if (target_of(fault.kind) == FaultTarget::kSensor) sampler_.inject(fault);
}

}  // namespace tenon::sim

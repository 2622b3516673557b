#include "sim/cell/devices/rft_sensor.h"

#include <algorithm>
#include <array>
#include <cstddef>

#include "shared/base/time_units.h"
#include "shared/sensors/robotous_rft.h"

namespace tenon::sim {
namespace {

constexpr unsigned kFirst = 1;
constexpr unsigned kSecond = 2;
constexpr std::uint8_t kOverloadAlongZ = 0b000100;
constexpr std::uint8_t kWrongParameter = 3;  // of the sensor's own: error codes are not known

}  // namespace

void RftSensor::power_on(std::int64_t now_ns) {
  sampler_.power_on(now_ns);
  rate_hz_ = rft::kRates_hz[0];
  streams_ = false;
  outgoing_.clear();
  // Two clocks never start together.
  next_ns_ = now_ns + 1'300'000;
}

void RftSensor::receive(const CanFrame& frame, std::int64_t now_ns) {
  const bool ours = frame.id == sensor_.request_id && !frame.extended && !frame.remote;
  if (!ours || frame.length != 8) return;
  switch (frame.data[0]) {
    case rft::kStart:
      streams_ = true;
      while (next_ns_ <= now_ns) next_ns_ += kNanosecondsPerSecond / rate_hz_;
      return;
    case rft::kStop:
      streams_ = false;
      return;
    case rft::kSetRate:
      return set_rate(frame.data[1]);
    default:
      return;
  }
}

void RftSensor::set_rate(std::uint8_t code) {
  const bool good = code < rft::kRates_hz.size();
  if (good) rate_hz_ = rft::kRates_hz[code];
  Response response{};
  response[0] = rft::kSetRate;
  response[1] = good ? rft::kGood : std::uint8_t{0};
  response[2] = good ? std::uint8_t{0} : kWrongParameter;
  send(response, kFirst | kSecond);
}

void RftSensor::stream(std::int64_t now_ns) {
  while (next_ns_ <= now_ns) next_ns_ += kNanosecondsPerSecond / rate_hz_;
  if (sampler_.strikes(FaultKind::kStaleForce)) return;
  const bool torn = sampler_.strikes(FaultKind::kTornForce);
  const WrenchSampler::Sample& sample = sampler_.sample();
  Response response{};
  response[0] = rft::kStart;
  for (std::size_t axis = 0; axis < 6; ++axis) {
    const auto count = static_cast<std::uint16_t>(sample.counts[axis]);
    response[1 + 2 * axis] = static_cast<std::uint8_t>(count >> 8U);
    response[2 + 2 * axis] = static_cast<std::uint8_t>(count & 0xFFU);
  }
  response[13] = sample.overrange ? kOverloadAlongZ : sample.saturated;
  if (!torn) return send(response, kFirst | kSecond);
  tore_first_ = !tore_first_;
  send(response, tore_first_ ? kFirst : kSecond);
}

void RftSensor::send(const Response& response, unsigned frames) {
  for (std::size_t half = 0; half < 2; ++half) {
    if ((frames >> half & 1U) == 0) continue;
    CanFrame frame;
    frame.id = sensor_.sample_ids[half];
    frame.length = 8;
    std::copy_n(response.begin() + static_cast<std::ptrdiff_t>(8 * half), 8, frame.data.begin());
    outgoing_.push_back(frame);
  }
}

void RftSensor::take(std::vector<CanFrame>& frames) {
  frames.insert(frames.end(), outgoing_.begin(), outgoing_.end());
  outgoing_.clear();
}

void RftSensor::inject(const Fault& fault) {
  if (target_of(fault.kind) == FaultTarget::kSensor) sampler_.inject(fault);
}

}  // namespace tenon::sim

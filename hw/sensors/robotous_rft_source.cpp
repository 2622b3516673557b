#include "hw/sensors/robotous_rft_source.h"

#include <cstddef>
#include <span>

#include "shared/base/bytes.h"
#include "shared/base/time_units.h"
#include "shared/sensors/robotous_rft.h"

namespace tenon::hw {

// Both frames of a sample come back to back; those of two samples lie a period apart.
RobotousRftSource::RobotousRftSource(const ForceTorqueSensor& sensor)
    : ids_(sensor.sample_ids),
      force_per_count_N_(sensor.force_per_count_N),
      torque_per_count_Nm_(sensor.torque_per_count_Nm),
      count_(kNanosecondsPerSecond / (2 * sensor.rate_hz)) {}

WrenchSource::Taken RobotousRftSource::take(const CanFrame& frame, std::int64_t time_ns,
                                            WrenchHalf& half) noexcept {
  const bool first = frame.id == ids_[0];
  if (frame.extended || frame.remote || (!first && frame.id != ids_[1])) return Taken::kForeign;
  if (frame.length != 8) {
    count_.close();
    return Taken::kMalformed;
  }
  if (first) return take_first(frame, time_ns, half);
  const std::span<const std::uint8_t> bytes(frame.data);
  half.place = 1;
  half.raw = {load_be<std::int16_t>(std::array{tx_high_, bytes[0]}),
              load_be<std::int16_t>(bytes.subspan(1)), load_be<std::int16_t>(bytes.subspan(3))};
  half.status = bytes[5];
  half.counter = count_.second(time_ns);
  return Taken::kHalf;
}

WrenchSource::Taken RobotousRftSource::take_first(const CanFrame& frame, std::int64_t time_ns,
                                                  WrenchHalf& half) noexcept {
  // Its answer to a command has these identifiers too, and its second frame is nobody's half.
  if (frame.data[0] != rft::kStart) {
    count_.close();
    return Taken::kForeign;
  }
  const std::span<const std::uint8_t> bytes(frame.data);
  half.place = 0;
  for (std::size_t i = 0; i < half.raw.size(); ++i) {
    half.raw[i] = load_be<std::int16_t>(bytes.subspan(1 + 2 * i));
  }
  half.status = 0;
  half.counter = count_.first(time_ns);
  tx_high_ = bytes[7];
  return Taken::kHalf;
}

std::optional<Vector3> RobotousRftSource::force_N(const WrenchHalf& half) const noexcept {
  if (half.place != 0) return std::nullopt;
  return force_per_count_N_ * Vector3(half.raw[0], half.raw[1], half.raw[2]);
}

Vector6 RobotousRftSource::wrench(const std::array<std::int16_t, 6>& raw) const noexcept {
  Vector6 wrench;
  wrench << force_per_count_N_ * Vector3(raw[0], raw[1], raw[2]),
      torque_per_count_Nm_ * Vector3(raw[3], raw[4], raw[5]);
  return wrench;
}

}  // namespace tenon::hw

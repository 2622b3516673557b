#include "hw/sensors/canopen_wrench_source.h"

#include <cstddef>
#include <span>

#include "shared/base/bytes.h"

namespace tenon::hw {

WrenchSource::Taken CanopenWrenchSource::take(const CanFrame& frame, std::int64_t /*time_ns*/,
                                              WrenchHalf& half) noexcept {
  const bool force = frame.id == ids_.force;
  if (frame.extended || frame.remote || (!force && frame.id != ids_.torque)) {
    return Taken::kForeign;
  }
  if (frame.length != 8) {
    return Taken::kMalformed;
  }
  const std::span<const std::uint8_t> bytes(frame.data);
  half.place = force ? 0 : 1;
  for (std::size_t i = 0; i < half.raw.size(); ++i) {
    half.raw[i] = load_le<std::int16_t>(bytes.subspan(2 * i));
  }
  half.counter = load_le<std::uint16_t>(bytes.subspan(6));
  half.status = 0;  // told by EMCY
  return Taken::kHalf;
}

std::optional<Vector3> CanopenWrenchSource::force_N(const WrenchHalf& half) const noexcept {
  if (half.place != 0) return std::nullopt;
  return force_per_count_N_ * Vector3(half.raw[0], half.raw[1], half.raw[2]);
}

Vector6 CanopenWrenchSource::wrench(const std::array<std::int16_t, 6>& raw) const noexcept {
  Vector6 wrench;
  wrench << force_per_count_N_ * Vector3(raw[0], raw[1], raw[2]),
      torque_per_count_Nm_ * Vector3(raw[3], raw[4], raw[5]);
  return wrench;
}

}  // namespace tenon::hw

#include "hw/sensors/ati_netcanoem_source.h"

#include <cstddef>
#include <limits>
#include <span>

#include "shared/base/bytes.h"

namespace tenon::hw {
namespace {

constexpr std::uint8_t kFirstBytes = 8;
constexpr std::uint8_t kSecondBytes = 6;

}  // namespace

// The next request closes a sample: no time does.
AtiNetcanoemSource::AtiNetcanoemSource(const ForceTorqueSensor& sensor)
    : ids_(sensor.sample_ids),
      cycles_per_sample_(sensor.cycles_per_sample),
      count_(std::numeric_limits<std::int64_t>::max()) {}

void AtiNetcanoemSource::reset() noexcept {
  count_.close();
  cycles_until_request_ = 0;
}

std::optional<CanFrame> AtiNetcanoemSource::begin_cycle() noexcept {
  if (cycles_until_request_ > 0) {
    --cycles_until_request_;
    return std::nullopt;
  }
  cycles_until_request_ = cycles_per_sample_ - 1;
  count_.close();
  CanFrame request;
  request.id = ids_[0];
  return request;
}

WrenchSource::Taken AtiNetcanoemSource::take(const CanFrame& frame, std::int64_t time_ns,
                                             WrenchHalf& half) noexcept {
  const bool first = frame.id == ids_[0];
  if (frame.extended || frame.remote || (!first && frame.id != ids_[1])) return Taken::kForeign;
  // Somebody else's request.
  if (first && frame.length == 0) return Taken::kForeign;
  if (frame.length != (first ? kFirstBytes : kSecondBytes)) {
    count_.close();
    return Taken::kMalformed;
  }
  const std::span<const std::uint8_t> bytes(frame.data);
  const std::size_t begin = first ? 2 : 0;
  half.place = first ? 0 : 1;
  for (std::size_t i = 0; i < half.raw.size(); ++i) {
    half.raw[i] = load_be<std::int16_t>(bytes.subspan(begin + 2 * i));
  }
  half.status = first ? load_be<std::uint16_t>(bytes) : std::uint16_t{0};
  half.counter = first ? count_.first(time_ns) : count_.second(time_ns);
  return Taken::kHalf;
}

Vector6 AtiNetcanoemSource::wrench(const std::array<std::int16_t, 6>& raw) const noexcept {
  Vector6 gauges;
  gauges << raw[0], raw[3], raw[1], raw[4], raw[2], raw[5];
  return matrix_ * gauges;
}

}  // namespace tenon::hw

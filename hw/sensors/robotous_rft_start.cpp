#include "hw/sensors/robotous_rft_start.h"

#include <algorithm>

#include "shared/base/time_units.h"
#include "shared/sensors/robotous_rft.h"

namespace tenon::hw {
namespace {

/// What was on its way when it was told to stop is over by then.
constexpr std::int64_t kSettle_ns = 20'000'000;

CanFrame command(const ForceTorqueSensor& sensor, std::uint8_t what, std::uint8_t parameter) {
  CanFrame frame;
  frame.id = sensor.request_id;
  frame.length = 8;
  frame.data[0] = what;
  frame.data[1] = parameter;
  return frame;
}

}  // namespace

SensorStart::Question RobotousRftStart::question(std::size_t which) const {
  switch (which) {
    case 0:
      return {command(sensor_, rft::kStop, 0), rft::kStop, false, kSettle_ns};
    case 1:
      return {command(sensor_, rft::kSetRate, rft::rate_code(sensor_.rate_hz).value_or(0)),
              rft::kSetRate};
    default:
      // A slow one takes its time.
      return {command(sensor_, rft::kStart, 0), rft::kStart, true,
              std::max(kAnswer_ns, 2 * kNanosecondsPerSecond / sensor_.rate_hz)};
  }
}

SensorStart::Heard RobotousRftStart::hear(std::size_t which, const CanFrame& frame,
                                          ArmFault& fault) {
  if (frame.extended || frame.remote || frame.length != 8) return Heard::kNothing;
  const bool first = frame.id == sensor_.sample_ids[0];
  if (which == 2 && half_ && frame.id == sensor_.sample_ids[1]) return Heard::kAnswer;
  if (first) half_ = frame.data[0] == rft::kStart;
  if (!first || which == 2) return Heard::kNothing;
  if (frame.data[0] != rft::kSetRate) return Heard::kNothing;
  if (frame.data[1] == rft::kGood) return Heard::kAnswer;
  fault.refused = true;
  fault.code = frame.data[2];
  return Heard::kWrong;
}

}  // namespace tenon::hw

#pragma once
// A force/torque sensor as its frames give it: what it is asked, what its frames carry, what its
// raw values mean. Whether a wrench is whole, new and within its range is not decided here but in
// one place for all sensors (hw/sensors/wrench_intake.h).

#include <array>
#include <cstdint>
#include <optional>

#include "shared/math/pose.h"
#include "shared/ports/can_bus.h"

namespace tenon {

/// What one frame carries of a sample: three of its six raw values.
struct WrenchHalf {
  std::uint8_t place = 0;  ///< 0: raw values 0 to 2, 1: raw values 3 to 5
  std::array<std::int16_t, 3> raw{};
  std::uint16_t counter = 0;  ///< the same in both halves of a sample
  std::uint16_t status = 0;   ///< what the sensor says of its health, in its own terms; 0: well
};

/// Real-time: no allocation, no throw, no clock. One thread.
class WrenchSource {
 public:
  enum class Taken : std::uint8_t {
    kForeign = 0,    ///< not a frame of this sensor
    kMalformed = 1,  ///< of this sensor, but not of the length that it sends; dropped
    kHalf = 2,
  };

  WrenchSource() = default;
  WrenchSource(const WrenchSource&) = delete;
  WrenchSource& operator=(const WrenchSource&) = delete;
  virtual ~WrenchSource() = default;

  /// Forgets all that was heard.
  virtual void reset() noexcept {}
  /// A cycle begins. @return what the sensor is to be sent, if more than that makes it take a
  /// sample and one is due
  [[nodiscard]] virtual std::optional<CanFrame> begin_cycle() noexcept { return std::nullopt; }
  /// Reads a frame of the bus. @param time_ns when it came  @param half written where the answer is
  /// kHalf
  [[nodiscard]] virtual Taken take(const CanFrame& frame, std::int64_t time_ns,
                                   WrenchHalf& half) noexcept = 0;
  /// The force that a half alone tells, sensor axes, N; none where it takes both halves.
  [[nodiscard]] virtual std::optional<Vector3> force_N(const WrenchHalf& half) const noexcept = 0;
  /// Six raw values as a wrench: sensor axes, N and Nm.
  [[nodiscard]] virtual Vector6 wrench(const std::array<std::int16_t, 6>& raw) const noexcept = 0;
};

}  // namespace tenon

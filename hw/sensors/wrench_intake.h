#pragma once
// Judges what a force/torque sensor sends, whichever it is: halves become samples, torn and
// repeated ones are none, and a value at the end of its range is named. Real-time, no clock; one
// thread. The source must outlive it.

#include <cstdint>
#include <optional>
#include <span>

#include "hw/sensors/wrench_pairing.h"
#include "shared/cell/robot.h"
#include "shared/ports/wrench_source.h"

namespace tenon::hw {

class WrenchIntake {
 public:
  struct Sample {
    Vector6 wrench = Vector6::Zero();  ///< sensor axes, N and Nm, raw
    std::uint16_t counter = 0;
  };
  struct Saturated {
    std::uint8_t place = 0;  ///< 0 to 5: fx fy fz tx ty tz of the wrench, or of the raw values
    std::int16_t raw = 0;    ///< the raw value in that place
    /// N or Nm of that axis, beyond its range; unset: the raw value is at the end of its 16 bits.
    /// What a calibration makes of six raw values, no single one of them tells.
    std::optional<double> reading;
  };

  WrenchIntake(WrenchSource& source, const ForceTorqueSensor& sensor)
      : source_(source), sensor_(sensor) {}

  /// Forgets all that was heard.
  void reset() noexcept;
  /// From now on halves are of another cycle. @return what the sensor is to be sent right after
  /// SYNC
  [[nodiscard]] std::optional<CanFrame> begin_cycle() noexcept {
    halves_seen_ = 0;
    ++cycles_since_sample_;
    std::optional<CanFrame> request = source_.begin_cycle();
    asked_ = request.has_value();
    if (request) request->bus = sensor_.bus();
    return request;
  }
  /// Reads a frame of the bus. What it brought stands in the calls below until the next one.
  /// @param time_ns when it came
  [[nodiscard]] WrenchSource::Taken take(const CanFrame& frame, std::int64_t time_ns) noexcept;

  /// The force of the last frame, sensor axes, N, where it tells one by itself.
  [[nodiscard]] const std::optional<Vector3>& force_N() const noexcept { return force_N_; }
  /// The whole new sample that the last frame completed.
  [[nodiscard]] const std::optional<Sample>& sample() const noexcept { return sample_; }
  /// The first axis of that force or sample beyond its range, else the first raw value at its end.
  [[nodiscard]] const std::optional<Saturated>& saturated() const noexcept { return saturated_; }
  /// What the sensor says of its health, if it says that it is not well.
  [[nodiscard]] const std::optional<std::uint16_t>& unwell() const noexcept { return unwell_; }
  /// Nothing more is to be waited for in this cycle: both halves came, of one sample or not, none
  /// is due yet, or none is ever due in a cycle.
  [[nodiscard]] bool answered() const noexcept {
    return halves_seen_ == 3 || sensor_.streams() || sensor_.absent() ||
           (!asked_ && cycles_since_sample_ < sensor_.cycles_per_sample);
  }
  /// What comes outside a cycle has missed one.
  [[nodiscard]] bool can_be_late() const noexcept { return !sensor_.streams(); }
  /// Halves that were dropped since reset().
  [[nodiscard]] std::uint64_t torn() const noexcept { return pairing_.torn(); }

 private:
  void take_sample(const WrenchPairing::Sample& paired) noexcept;
  /// @param readings N, then Nm  @param raw as many values
  void look_for_ends(std::span<const double> readings, std::span<const std::int16_t> raw) noexcept;

  WrenchSource& source_;
  const ForceTorqueSensor sensor_;
  WrenchPairing pairing_;
  std::optional<Vector3> force_N_;
  std::optional<Sample> sample_;
  std::optional<Saturated> saturated_;
  std::optional<std::uint16_t> unwell_;
  std::uint8_t halves_seen_ = 0;  ///< bit 0: the first, bit 1: the second
  bool asked_ = false;            ///< in this cycle, by a request
  int cycles_since_sample_ = 0;   ///< begun since the last new one, or reset()
};

}  // namespace tenon::hw

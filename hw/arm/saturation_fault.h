#pragma once
// A wrench at the end of its range, as the arm's fault carries it: the raw value in the sensor's
// own object, or, where the wrench of all six values is beyond its range, that axis' reading.
//
// Plain data, real-time.

#include <bit>
#include <cstdint>
#include <optional>

#include "hw/canopen/object_setting.h"
#include "hw/sensors/wrench_intake.h"
#include "shared/canopen/constants.h"
#include "shared/ports/arm.h"

namespace tenon::hw {

/// A reading is of no object of the node's.
inline constexpr std::uint16_t kNoObject = 0;

[[nodiscard]] inline ArmFault saturation_fault(std::uint8_t node,
                                               const WrenchIntake::Saturated& saturated) {
  const auto sub = static_cast<std::uint8_t>(saturated.place + 1);
  if (!saturated.reading) {
    return {ArmFaultKind::kSensorInvalid, node,
            canopen::object_of(tenon::canopen::kForceInputs, sub),
            static_cast<std::uint16_t>(saturated.raw)};
  }
  return {ArmFaultKind::kSensorInvalid, node, canopen::object_of(kNoObject, sub),
          std::bit_cast<std::uint32_t>(static_cast<float>(*saturated.reading))};
}

/// The sensor says itself that it is not well.
[[nodiscard]] inline ArmFault unwell_fault(std::uint8_t node, std::uint16_t status) {
  return {ArmFaultKind::kSensorInvalid, node, canopen::object_of(tenon::canopen::kSensorStatus),
          status};
}

/// The reading that such a fault tells; unset: it tells of something else.
[[nodiscard]] inline std::optional<double> saturated_reading(const ArmFault& fault) {
  if (fault.object >> 8 != kNoObject || fault.object == 0) return std::nullopt;
  return double{std::bit_cast<float>(fault.code)};
}

}  // namespace tenon::hw

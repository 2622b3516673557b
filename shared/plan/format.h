#pragma once
// The numbers of FORMAT.md that encoder and decoder share. Private to this folder.

#include <bit>
#include <cstddef>
#include <cstdint>

#include "shared/plan/plan.h"

namespace tenon::plan_format {

inline constexpr std::uint32_t kMagic = 0x1A504E54;  // "TNP" and an end-of-file character
inline constexpr std::uint16_t kVersion = 1;
inline constexpr std::uint16_t kVersionOfRotation = 2;  // sets say which axes, and whose
inline constexpr std::uint16_t kVersionOfPlaces = 3;    // and envelopes where the tool ends
inline constexpr std::uint16_t kVersionOfGoalAxes = 4;  // and the goal's axes differ
inline constexpr std::uint8_t kFlagCarriedAxes = 0x01;
inline constexpr std::uint8_t kFlagPlainTouches = 0x02;
inline constexpr std::uint8_t kSetFlagsMax = kFlagCarriedAxes | kFlagPlainTouches;
inline constexpr std::uint8_t kFlagCheckEnvelopes = 0x01;
inline constexpr std::uint8_t kFlagCheckPlaces = 0x08;
inline constexpr unsigned kMethodShift = 1;  // of the two bits of the flags that hold the method
inline constexpr std::uint8_t kFlagsMax =
    static_cast<std::uint8_t>(kPlanMethods.back()) << kMethodShift | kFlagCheckEnvelopes;
inline constexpr std::size_t kHeaderSize = 205;  // without the two names' text
inline std::size_t set_size(std::uint16_t version) {
  return version >= kVersionOfRotation ? 68 : 66;
}
inline bool has_rotation(const ParameterSet& set) {
  return set.sensed_axes != 0x3F || set.carried_axes || !set.aligns;
}
inline constexpr std::size_t kChecksumSize = 4;
inline constexpr std::size_t kNameMax = 63;
inline constexpr std::size_t kParameterSetsMax = 200;

inline std::size_t axes_in(CoordinateMask coordinates) {
  return static_cast<std::size_t>(std::popcount(coordinates));
}
inline std::size_t step_size(CoordinateMask coordinates) { return 6 + 4 * axes_in(coordinates); }
inline std::size_t outcome_size(CoordinateMask coordinates, bool places) {
  return 5 + (places ? 16 : 8) * axes_in(coordinates);
}
/// What follows the header's counts.
inline std::size_t goal_axes_size(CoordinateMask coordinates, std::uint16_t version) {
  return version >= kVersionOfGoalAxes ? 1 + 4 * axes_in(coordinates) : 0;
}

}  // namespace tenon::plan_format

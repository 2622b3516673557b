#pragma once
// Wire constants of ATI's NETCANOEM boards (also sold as Schunk FTCL). Numbers alone: the master's
// codec lives in hw, the sensor's in sim, written apart.
//
// An identifier is base << 4 | operation, of requests and of answers alike. Big-endian:
//
//   operation  request     answers
//   0          empty       0: status u16, gauges 0 2 4 (i16), 8 bytes; 1: gauges 1 3 5, 6 bytes
//   2          row u8      2, 3, 4: two f32 of that row of the calibration matrix each, 8 bytes
//   7          empty       7: counts a unit of force, of torque (u32), 8 bytes
//   8          empty       8: unit of force, of torque (u8), 2 bytes
//
//   wrench = matrix * gauges / counts, in these units
//
// All of it was read in several drivers by others than the maker, which agree, but for the codes of
// units, which are those of the maker's manuals for its other sensors. Unverified in the maker's
// manual for this board: these codes, the bits of the status, and whether a firmware before 3.7
// gives the two counts in the other order.

#include <array>
#include <cstdint>

namespace tenon::ati {

inline constexpr std::uint32_t kBaseMax = 0x7F;
inline constexpr std::uint32_t kOperations = 16;

inline constexpr std::uint8_t kReadGauges = 0;
inline constexpr std::uint8_t kGaugesSecond = 1;
inline constexpr std::uint8_t kReadMatrixRow = 2;  ///< answered by this and the two after it
inline constexpr std::uint8_t kReadCounts = 7;
inline constexpr std::uint8_t kReadUnits = 8;

/// The place in the list is the code; 0 is none. N a unit.
inline constexpr std::array<double, 7> kForceUnits_N = {
    0.0, 4.4482216152605, 1.0, 4448.2216152605, 1000.0, 9.80665, 0.00980665};
/// lbf in, lbf ft, N m, N mm, kgf cm, kN m. Nm a unit.
inline constexpr std::array<double, 7> kTorqueUnits_Nm = {
    0.0, 0.1129848290276167, 1.3558179483314004, 1.0, 0.001, 0.0980665, 1000.0};
inline constexpr std::uint8_t kNewton = 2;
inline constexpr std::uint8_t kNewtonMetre = 3;

// Of the status; all others are not known.
inline constexpr std::uint16_t kWatchdogReset = 1U << 0U;
inline constexpr std::uint16_t kExcitationHigh = 1U << 1U;
inline constexpr std::uint16_t kExcitationLow = 1U << 2U;
inline constexpr std::uint16_t kGroundOff = 1U << 3U;
inline constexpr std::uint16_t kSupplyHigh = 1U << 4U;
inline constexpr std::uint16_t kSupplyLow = 1U << 5U;
inline constexpr std::uint16_t kBadCalibration = 1U << 6U;
inline constexpr std::uint16_t kMemoryFailure = 1U << 7U;
inline constexpr std::uint16_t kBadConfiguration = 1U << 8U;
inline constexpr std::uint16_t kTooHot = 1U << 11U;
inline constexpr std::uint16_t kTooCold = 1U << 12U;
inline constexpr std::uint16_t kBusError = 1U << 14U;
inline constexpr std::uint16_t kAnyError = 1U << 15U;

}  // namespace tenon::ati

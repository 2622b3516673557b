#pragma once
// Wire constants of Robotous RFT sensors on CAN. Numbers alone: the master's codec lives in hw, the
// sensor's in sim, written apart.
//
//   command  on one identifier, 8 bytes: D1 what, D2 its parameter, the rest 0
//   response 16 bytes, D1 to D8 on a second identifier and D9 to D16 on a third:
//     to kSetRate    D1 kSetRate, D2 kGood or else, D3 why not
//     while it streams, D1 kStart, D2-D13 Fx Fy Fz Tx Ty Tz (i16, big-endian), D14 overload
//   kStop is not answered.
//
// Numbers of commands and rates are those of the maker's own sample programs, layouts those of
// other people's drivers, which agree. Unverified in the maker's manual: D14's bits (taken as one
// an axis, the first of the six is bit 0), and that a response's D2 is 1 where all is well.

#include <array>
#include <cstdint>
#include <optional>

namespace tenon::rft {

inline constexpr std::uint8_t kStart = 0x0B;
inline constexpr std::uint8_t kStop = 0x0C;
inline constexpr std::uint8_t kSetRate = 0x0F;
inline constexpr std::uint8_t kGood = 1;

/// Samples a second; the place in the list is the parameter of kSetRate. 0 is its default, 200.
inline constexpr std::array<int, 9> kRates_hz = {200, 10, 20, 50, 100, 200, 300, 500, 1000};

/// Never 0, which says less.
[[nodiscard]] constexpr std::optional<std::uint8_t> rate_code(int rate_hz) {
  for (std::size_t code = 1; code < kRates_hz.size(); ++code) {
    if (kRates_hz[code] == rate_hz) return static_cast<std::uint8_t>(code);
  }
  return std::nullopt;
}

}  // namespace tenon::rft

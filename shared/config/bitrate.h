#pragma once
// The bit rates of CiA 301, as a file gives them.

#include <array>
#include <cstdint>

#include "shared/config/yaml_value.h"

namespace tenon::config {

/// @throws InputError for any other
inline std::uint32_t read_bitrate_bps(const Value& value) {
  constexpr std::array<std::uint32_t, 7> kBitrates_bps = {20'000,  50'000,  125'000,  250'000,
                                                          500'000, 800'000, 1'000'000};
  return kBitrates_bps[value.choice(
      {"20000", "50000", "125000", "250000", "500000", "800000", "1000000"})];
}

}  // namespace tenon::config

#pragma once
// Emergency objects (CiA 301, 7.2.7). Pure functions, real-time; emergency_text() names the codes.
//
//   COB-ID 080h + node, 8 bytes
//   | bytes | type | meaning                              |
//   |  0-1  | u16  | error code, 0000 where it is over     |
//   |  2    | u8   | error register (1001h)               |
//   |  3-7  |      | manufacturer's own                   |

#include <algorithm>
#include <array>
#include <cstdint>
#include <optional>

#include "shared/base/bytes.h"
#include "shared/canopen/constants.h"
#include "shared/ports/can_bus.h"

namespace tenon::hw::canopen {

struct Emergency {
  std::uint8_t node = 0;
  std::uint16_t code = 0;
  std::uint8_t error_register = 0;
  std::array<std::uint8_t, 5> vendor{};

  friend bool operator==(const Emergency&, const Emergency&) = default;
};

/// Empty where the frame is no EMCY.
[[nodiscard]] constexpr std::optional<Emergency> decode_emergency(const CanFrame& frame) {
  const std::uint32_t base = tenon::canopen::kEmergency;
  if (frame.extended || frame.remote || frame.length != 8 || frame.id <= base ||
      frame.id > base + 127) {
    return std::nullopt;
  }
  Emergency emergency;
  emergency.node = static_cast<std::uint8_t>(frame.id - base);
  emergency.code = load_le<std::uint16_t>(frame.data);
  emergency.error_register = frame.data[2];
  std::copy(frame.data.begin() + 3, frame.data.end(), emergency.vendor.begin());
  return emergency;
}

/// Whether the device goes on in spite of it: the error is over, or a frame was lost and the
/// supervision of the frames themselves decides.
[[nodiscard]] constexpr bool is_warning(const Emergency& emergency) {
  return emergency.code == tenon::canopen::kEmergencyReset ||
         emergency.code == tenon::canopen::kEmergencyOverrun ||
         emergency.code == tenon::canopen::kEmergencyErrorPassive;
}

/// "following error" for 8611h; nullptr where neither CiA 301 nor CiA 402 gives the code a meaning.
[[nodiscard]] const char* emergency_text(std::uint32_t code);

}  // namespace tenon::hw::canopen

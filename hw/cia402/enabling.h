#pragma once
// The next controlword towards what is asked of a drive (CiA 402-2, state machine). Pure: one step
// a cycle, any number of repetitions is harmless.
//
//   | state \ asked for     | enabled          | disabled   | quick stop |
//   | not ready, unknown    | 00               | 00         | 00         |
//   | switch on disabled    | 06 shutdown      | 00         | 00         |
//   | ready to switch on    | 07 switch on     | 00         | 00         |
//   | switched on           | 0F enable        | 06         | 00         |
//   | operation enabled     | 0F (1F in mode 7)| 07 disable | 02         |
//   | quick stop active     | 0F               | 00         | 02 holds   |
//   | fault reaction active | 00               | 00         | 00         |
//   | fault                 | 80, 00, 80, ...  | 00         | 00         |
//
// A fault is reset by the rising edge of bit 7 only, so the bit has to fall before it rises again.

#include <cstdint>

#include "hw/cia402/drive_state.h"
#include "shared/canopen/constants.h"
#include "shared/ports/arm.h"

namespace tenon::hw::cia402 {

/// @param previous the controlword sent last  @param interpolated mode 7: bit 4 lets it move
[[nodiscard]] std::uint16_t next_controlword(DriveState state, ArmRequest request,
                                             std::uint16_t previous, bool interpolated);

/// Whether a drive is where the request ends, so that nothing is left to be commanded.
[[nodiscard]] bool has_followed(DriveState state, ArmRequest request);

}  // namespace tenon::hw::cia402

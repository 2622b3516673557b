#pragma once
// A joint that moved though its drive is off and its brake on, and what came of holding it by its
// drive. Plain data.

#include <cstdint>

namespace tenon::executor {

struct BrakeSlip {
  int joint = -1;      ///< -1: none has
  double moved = 0.0;  ///< m or rad since its drive went off
  double bound = 0.0;  ///< that a brake lets it
};

/// Where the cell wants an arm held under power whose brake does not hold.
enum class Hold : std::uint8_t {
  kNone = 0,     ///< nothing was to be held, or power is not back yet
  kHeld = 1,     ///< under power, until told to stop
  kLost = 2,     ///< it was, and the power went by itself
  kRefused = 3,  ///< power never came back
};

}  // namespace tenon::executor

#pragma once
// A joint that moved though its drive is off and its brake on. Plain data.

namespace tenon::executor {

struct BrakeSlip {
  int joint = -1;      ///< -1: none has
  double moved = 0.0;  ///< m or rad since its drive went off
  double bound = 0.0;  ///< that a brake lets it
};

}  // namespace tenon::executor

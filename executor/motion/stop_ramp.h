#pragma once
// How a velocity dies away: its share u(t) from 1 to 0 with bounded slope and curvature. First
// u'' = -jerk down to the steepest slope, then u'' = 0, then u'' = +jerk, so that u = u' = 0 at the
// end. Real-time: built in constant time, no allocation.

#include <array>

namespace tenon::executor {

/// Slower than this is rest, m/s or rad/s.
inline constexpr double kRest = 1e-9;

class StopRamp {
 public:
  struct Sample {
    double covered_s = 0.0;  ///< integral of the share: times the velocity, the way
    double share = 1.0;      ///< of the velocity that is left
    double slope = 0.0;      ///< 1/s
  };

  StopRamp() = default;
  /// @param slope at the start, 1/s  @param slope_max > 0, 1/s  @param jerk > 0, 1/s^2. Where the
  /// start brakes harder than slope_max already, its braking is ended with the jerk that comes out
  /// at rest.
  StopRamp(double slope, double slope_max, double jerk);

  /// @param time_s since the stop began; from duration_s() on it rests
  [[nodiscard]] Sample at(double time_s) const;
  [[nodiscard]] double duration_s() const { return duration_s_; }

 private:
  struct Segment {
    double duration_s = 0.0;
    double jerk = 0.0;
  };
  double slope_ = 0.0;
  std::array<Segment, 3> segments_{};
  double duration_s_ = 0.0;
};

}  // namespace tenon::executor

#pragma once
// A jerk-limited path parameter with two speeds, from rest to rest.

#include <array>
#include <cstddef>

namespace tenon {

/// s(t) from 0 to `length`, at rest at both ends, |s'| at most the fast speed up to `slow_from` and
/// the slow speed from there on, |s''| and |s'''| bounded throughout. Real-time: no allocation;
/// built in bounded time (a bisection of 60 steps where the length is too short for full speed).
class MotionProfile {
 public:
  struct Parameters {
    double length = 0.0;        ///< >= 0, m or rad
    double slow_from = 0.0;     ///< >= 0; the slow speed is reached no later than here
    double fast_speed = 0.0;    ///< > 0, taken as the slow one where it is below it
    double slow_speed = 0.0;    ///< > 0
    double acceleration = 0.0;  ///< > 0
    double jerk = 0.0;          ///< > 0
  };
  struct Sample {
    double position = 0.0;
    double velocity = 0.0;
    double acceleration = 0.0;
  };

  MotionProfile() = default;
  explicit MotionProfile(const Parameters& parameters);

  /// @param time_s since the start; before 0 gives the start, after duration_s() the end.
  [[nodiscard]] Sample at(double time_s) const;
  [[nodiscard]] double duration_s() const { return duration_s_; }

 private:
  struct Segment {
    double start_s = 0.0;
    Sample start;
    double jerk = 0.0;
  };
  void append(double time_s, double jerk);
  void append_ramp(double from_speed, double to_speed, double acceleration, double jerk);

  std::array<Segment, 12> segments_{};  // three ramps of three, two cruises
  std::size_t count_ = 0;
  double duration_s_ = 0.0;
  Sample end_;
};

}  // namespace tenon

#include "executor/motion/stop_ramp.h"

#include <algorithm>
#include <cmath>

namespace tenon::executor {

StopRamp::StopRamp(double slope, double slope_max, double jerk) : slope_(slope) {
  double peak = std::min(slope_max, std::sqrt(jerk + 0.5 * slope * slope));
  if (peak < -slope) {
    peak = -slope;
    jerk = std::max(jerk, 0.5 * peak * peak);
  }
  const double down_s = (slope + peak) / jerk;
  const double up_s = peak / jerk;
  const double ramps = (slope * slope - 2.0 * peak * peak) / (2.0 * jerk);
  const double hold_s = std::max(0.0, (1.0 + ramps) / peak);
  segments_ = {{{down_s, -jerk}, {hold_s, 0.0}, {up_s, jerk}}};
  duration_s_ = down_s + hold_s + up_s;
}

StopRamp::Sample StopRamp::at(double time_s) const {
  Sample sample;
  sample.slope = slope_;
  double left_s = std::clamp(time_s, 0.0, duration_s_);
  for (const Segment& segment : segments_) {
    const double t = std::min(left_s, segment.duration_s);
    sample.covered_s += t * (sample.share + t * (0.5 * sample.slope + t * segment.jerk / 6.0));
    sample.share += t * (sample.slope + 0.5 * t * segment.jerk);
    sample.slope += t * segment.jerk;
    left_s -= t;
  }
  if (time_s >= duration_s_) sample.share = sample.slope = 0.0;
  return sample;
}

}  // namespace tenon::executor

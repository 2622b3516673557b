#include "shared/motion/motion_profile.h"

#include <algorithm>
#include <cassert>
#include <cmath>

namespace tenon {
namespace {

// A speed ramp that starts and ends with zero acceleration: jerk up, hold, jerk down.
struct Ramp {
  double jerk_time_s = 0.0;
  double hold_time_s = 0.0;
  [[nodiscard]] double time_s() const { return 2.0 * jerk_time_s + hold_time_s; }
};

Ramp ramp_between(double from_speed, double to_speed, double acceleration, double jerk) {
  const double change = std::abs(to_speed - from_speed);
  if (change * jerk >= acceleration * acceleration) {
    return {acceleration / jerk, change / acceleration - acceleration / jerk};
  }
  return {std::sqrt(change / jerk), 0.0};
}

// The ramp is symmetric about its middle, so its mean speed is that of its ends.
double ramp_length(double from_speed, double to_speed, double acceleration, double jerk) {
  return 0.5 * (from_speed + to_speed) *
         ramp_between(from_speed, to_speed, acceleration, jerk).time_s();
}

// Largest speed in [low, high] for which fits(speed) holds; fits(low) must hold.
template <typename Fits>
double largest_speed(double low, double high, Fits fits) {
  if (fits(high)) return high;
  for (int i = 0; i < 60; ++i) {
    const double middle = 0.5 * (low + high);
    (fits(middle) ? low : high) = middle;
  }
  return low;
}

}  // namespace

MotionProfile::MotionProfile(const Parameters& p) {
  assert(p.length >= 0.0 && p.slow_speed > 0.0 && p.acceleration > 0.0 && p.jerk > 0.0);
  end_.position = p.length;
  if (p.length <= 0.0) return;
  const auto ramp = [&](double a, double b) { return ramp_length(a, b, p.acceleration, p.jerk); };

  const double slow = largest_speed(
      0.0, p.slow_speed, [&](double v) { return ramp(0.0, v) + ramp(v, 0.0) <= p.length; });
  // The fast part: up to speed and down to `slow`, within slow_from and clear of the last ramp.
  const double room = std::min(p.slow_from, p.length - ramp(slow, 0.0));
  const double fast = largest_speed(slow, std::max(slow, p.fast_speed),
                                    [&](double v) { return ramp(0.0, v) + ramp(v, slow) <= room; });
  const bool two_speeds = fast > slow && ramp(0.0, fast) + ramp(fast, slow) <= room;

  const double top = two_speeds ? fast : slow;
  append_ramp(0.0, top, p.acceleration, p.jerk);
  if (two_speeds) {
    append((room - ramp(0.0, fast) - ramp(fast, slow)) / fast, 0.0);
    append_ramp(fast, slow, p.acceleration, p.jerk);
  }
  const double covered = two_speeds ? room : ramp(0.0, slow);
  append(std::max(0.0, p.length - covered - ramp(slow, 0.0)) / slow, 0.0);
  append_ramp(slow, 0.0, p.acceleration, p.jerk);
}

void MotionProfile::append(double time_s, double jerk) {
  assert(count_ < segments_.size());
  Segment& segment = segments_[count_];
  segment.start_s = duration_s_;
  segment.jerk = jerk;
  if (count_ > 0) {
    const Segment& before = segments_[count_ - 1];
    const double t = duration_s_ - before.start_s;
    segment.start.acceleration = before.start.acceleration + before.jerk * t;
    segment.start.velocity =
        before.start.velocity + t * (before.start.acceleration + 0.5 * t * before.jerk);
    segment.start.position =
        before.start.position +
        t * (before.start.velocity + t * (0.5 * before.start.acceleration + t * before.jerk / 6.0));
  }
  ++count_;
  duration_s_ += time_s;
}

void MotionProfile::append_ramp(double from_speed, double to_speed, double acceleration,
                                double jerk) {
  const Ramp ramp = ramp_between(from_speed, to_speed, acceleration, jerk);
  const double sign = to_speed >= from_speed ? 1.0 : -1.0;
  append(ramp.jerk_time_s, sign * jerk);
  append(ramp.hold_time_s, 0.0);
  append(ramp.jerk_time_s, -sign * jerk);
}

MotionProfile::Sample MotionProfile::at(double time_s) const {
  if (time_s <= 0.0 && duration_s_ > 0.0) return {};
  if (time_s >= duration_s_) return end_;
  std::size_t i = 0;
  while (i + 1 < count_ && segments_[i + 1].start_s <= time_s) ++i;
  const Segment& segment = segments_[i];
  const double t = time_s - segment.start_s;
  const Sample& s = segment.start;
  return {s.position + t * (s.velocity + t * (0.5 * s.acceleration + t * segment.jerk / 6.0)),
          s.velocity + t * (s.acceleration + 0.5 * t * segment.jerk),
          s.acceleration + t * segment.jerk};
}

}  // namespace tenon

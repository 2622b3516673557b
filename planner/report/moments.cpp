#include "planner/report/moments.h"

#include <cmath>
#include <limits>
#include <tuple>

namespace tenon::planner {

Moments::Moments(std::size_t samples, std::size_t moments_max) : samples_(samples) {
  if (samples <= moments_max) {
    for (std::size_t i = 0; i < samples; ++i) moments_.push_back(i);
    return;
  }
  // More samples than moments: at least two of them in every bucket.
  const std::size_t buckets = moments_max / 2;
  for (std::size_t i = 0; i < buckets; ++i) {
    moments_.push_back(i * samples / buckets);
    moments_.push_back((i + 1) * samples / buckets - 1);
  }
}

std::vector<double> Moments::at(const Value& value) const {
  std::vector<double> values;
  values.reserve(size());
  for (const std::size_t sample : moments_) values.push_back(value(sample));
  return values;
}

std::vector<double> Moments::peaks(const Value& value) const {
  if (size() == samples_) return at(value);
  std::vector<double> values;
  values.reserve(size());
  for (std::size_t i = 0; i + 1 < size(); i += 2) {
    double earlier = std::numeric_limits<double>::quiet_NaN();
    double later = earlier;
    bool rising = true;  // the largest came after the smallest
    for (std::size_t sample = moments_[i]; sample <= moments_[i + 1]; ++sample) {
      const double now = value(sample);
      if (std::isnan(now)) continue;
      if (std::isnan(earlier)) earlier = later = now;
      const double least = rising ? earlier : later;
      const double most = rising ? later : earlier;
      if (now < least) {
        std::tie(earlier, later, rising) = std::tuple(most, now, false);
      } else if (now > most) {
        std::tie(earlier, later, rising) = std::tuple(least, now, true);
      }
    }
    values.push_back(earlier);
    values.push_back(later);
  }
  return values;
}

}  // namespace tenon::planner

#include "shared/base/wilson.h"

#include <cmath>

namespace tenon {

Interval wilson_interval(std::size_t successes, std::size_t count) {
  if (count == 0) return {0.0, 1.0};
  constexpr double kZ = 1.959963984540054;  // of 95 %, both sides
  const auto n = static_cast<double>(count);
  const double p = static_cast<double>(successes) / n;
  const double shrink = 1.0 + kZ * kZ / n;
  const double centre = (p + kZ * kZ / (2.0 * n)) / shrink;
  const double half = kZ * std::sqrt(p * (1.0 - p) / n + kZ * kZ / (4.0 * n * n)) / shrink;
  return {successes == 0 ? 0.0 : centre - half, successes == count ? 1.0 : centre + half};
}

}  // namespace tenon

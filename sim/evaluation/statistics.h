#pragma once
// The few statistics that an evaluation reports. Pure.

#include <cstddef>
#include <vector>

#include "shared/base/wilson.h"

namespace tenon::sim {

/// The probability that a normal draw in `dimensions` falls within a Mahalanobis distance.
[[nodiscard]] double mass_within(double distance, int dimensions);

struct Moments {
  double mean = 0.0;
  double deviation = 0.0;  ///< standard, of the sample (n - 1); 0 for fewer than two
};
[[nodiscard]] Moments moments(const std::vector<double>& values);

/// The smallest value that at least this part of all do not exceed (nearest rank); 0 for none.
/// @param part (0, 1]
[[nodiscard]] double quantile(std::vector<double> values, double part);

}  // namespace tenon::sim

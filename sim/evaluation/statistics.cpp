#include "sim/evaluation/statistics.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>

namespace tenon::sim {

double mass_within(double distance, int dimensions) {
  // The chi distribution, from one dimension or two upwards by twos:
  // P(k + 2) = P(k) - (d^2 / 2)^(k / 2) exp(-d^2 / 2) / gamma(k / 2 + 1)
  const double half_square = 0.5 * distance * distance;
  const bool odd = dimensions % 2 == 1;
  double mass = odd ? std::erf(distance / std::numbers::sqrt2) : -std::expm1(-half_square);
  for (int k = odd ? 1 : 2; k < dimensions; k += 2) {
    mass -= std::pow(half_square, 0.5 * k) * std::exp(-half_square) / std::tgamma(0.5 * k + 1.0);
  }
  return mass;
}

Moments moments(const std::vector<double>& values) {
  if (values.empty()) return {};
  const auto n = static_cast<double>(values.size());
  const double mean = std::accumulate(values.begin(), values.end(), 0.0) / n;
  if (values.size() < 2) return {mean, 0.0};
  double squares = 0.0;
  for (const double value : values) squares += (value - mean) * (value - mean);
  return {mean, std::sqrt(squares / (n - 1.0))};
}

double quantile(std::vector<double> values, double part) {
  if (values.empty()) return 0.0;
  // A rank that rounding lifted just above a whole number is that number.
  const double rank = std::ceil(part * static_cast<double>(values.size()) - 1e-9);
  const auto index = static_cast<std::ptrdiff_t>(std::max(rank, 1.0)) - 1;
  std::nth_element(values.begin(), values.begin() + index, values.end());
  return values[static_cast<std::size_t>(index)];
}

}  // namespace tenon::sim

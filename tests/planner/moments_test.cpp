// What is left of a long series: no peak is lost, and what is left stands where it was.

#include "planner/report/moments.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <vector>

namespace tenon::planner {
namespace {

constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();

std::vector<double> peaks_of(const std::vector<double>& values, std::size_t moments_max) {
  return Moments(values.size(), moments_max).peaks([&](std::size_t i) { return values[i]; });
}

TEST(Moments, KeepEverySampleOfAShortSeries) {
  const std::vector<double> values = {3.0, -1.0, 4.0, 1.0};
  EXPECT_EQ(peaks_of(values, 4), values);
  EXPECT_EQ(Moments(4, 4).samples(), (std::vector<std::size_t>{0, 1, 2, 3}));
  EXPECT_EQ(Moments(0, 4).size(), 0U);
}

// Each bucket against the plain search for its smallest and its largest.
TEST(Moments, KeepTheSmallestAndTheLargestOfEveryBucketInTheirOrder) {
  std::mt19937 random(5);
  std::normal_distribution<double> noise(0.0, 1.0);
  for (const std::size_t count : {11U, 100U, 1001U, 30'000U}) {
    std::vector<double> values(count);
    for (double& value : values) value = noise(random);
    const Moments moments(count, 10);
    ASSERT_EQ(moments.size(), 10U);
    const std::vector<double> peaks = peaks_of(values, 10);
    std::size_t next = 0;
    for (std::size_t i = 0; i < moments.size(); i += 2) {
      const std::size_t first = moments.samples()[i];
      const std::size_t last = moments.samples()[i + 1];
      ASSERT_EQ(first, next) << "no sample is between buckets";
      next = last + 1;
      const auto begin = values.begin() + static_cast<std::ptrdiff_t>(first);
      const auto end = values.begin() + static_cast<std::ptrdiff_t>(next);
      const auto least = std::min_element(begin, end);
      const auto most = std::max_element(begin, end);
      EXPECT_EQ(peaks[i], least < most ? *least : *most);
      EXPECT_EQ(peaks[i + 1], least < most ? *most : *least);
    }
    EXPECT_EQ(next, count);
  }
}

TEST(Moments, KeepAPeakOfOneSampleWhereverItIs) {
  for (std::size_t at = 0; at < 997; ++at) {
    std::vector<double> values(997, 0.5);
    values[at] = 20.0;
    const std::vector<double> peaks = peaks_of(values, 24);
    ASSERT_EQ(std::count(peaks.begin(), peaks.end(), 20.0), 1) << at;
  }
}

TEST(Moments, AreUnknownOnlyWhereNothingIsKnown) {
  std::vector<double> values(100, kUnknown);
  values[3] = 7.0;
  const std::vector<double> peaks = peaks_of(values, 20);
  EXPECT_EQ(peaks[0], 7.0);
  EXPECT_EQ(peaks[1], 7.0);
  EXPECT_EQ(std::count_if(peaks.begin(), peaks.end(), [](double v) { return std::isnan(v); }), 18);
}

}  // namespace
}  // namespace tenon::planner

#include <gtest/gtest.h>

#include "sim/evaluation/statistics.h"

namespace tenon::sim {
namespace {

void expect_interval(std::size_t successes, std::size_t count, double low, double high) {
  const Interval interval = wilson_interval(successes, count);
  EXPECT_NEAR(interval.low, low, 5e-5) << successes << " of " << count;
  EXPECT_NEAR(interval.high, high, 5e-5) << successes << " of " << count;
}

TEST(EvaluationStatistics, WilsonsIntervalIsThePublishedOne) {
  // R. G. Newcombe, "Two-sided confidence intervals for the single proportion", Statistics in
  // Medicine 17 (1998), table I, method 3.
  expect_interval(81, 263, 0.2553, 0.3662);
  expect_interval(15, 148, 0.0624, 0.1605);
  expect_interval(0, 20, 0.0, 0.1611);
  expect_interval(1, 29, 0.0061, 0.1718);
}

TEST(EvaluationStatistics, WilsonsIntervalOfAllOrNoneHasAClosedForm) {
  // n / (n + z^2) with z = 1.959963984540054; none is its mirror image.
  EXPECT_NEAR(wilson_interval(1000, 1000).low, 0.9961732415, 1e-9);
  EXPECT_EQ(wilson_interval(1000, 1000).high, 1.0);
  EXPECT_EQ(wilson_interval(0, 1000).low, 0.0);
  EXPECT_NEAR(wilson_interval(0, 1000).high, 1.0 - 0.9961732415, 1e-9);
  EXPECT_EQ(wilson_interval(0, 0).low, 0.0);
  EXPECT_EQ(wilson_interval(0, 0).high, 1.0);
}

TEST(EvaluationStatistics, MassWithinADistanceIsTheChiDistributions) {
  // 1: erf; 2, 4, 6: 1 - exp(-d^2 / 2) times a partial sum of its series; 3, 5: tables of chi
  // squared at d^2.
  EXPECT_NEAR(mass_within(2.0, 1), 0.9544997, 1e-7);
  EXPECT_NEAR(mass_within(2.0, 2), 0.8646647, 1e-7);
  EXPECT_NEAR(mass_within(3.0, 2), 0.9888910, 1e-7);
  EXPECT_NEAR(mass_within(2.0, 3), 0.7385359, 1e-7);
  EXPECT_NEAR(mass_within(3.0, 3), 0.9707091, 1e-7);
  EXPECT_NEAR(mass_within(3.0, 4), 0.9389005, 1e-7);
  EXPECT_NEAR(mass_within(2.0, 5), 0.4505840, 1e-7);
  EXPECT_NEAR(mass_within(3.0, 6), 0.8264219, 1e-7);
}

TEST(EvaluationStatistics, MomentsAreThoseOfASample) {
  // Squares of 2 4 4 4 5 5 7 9 about their mean of 5 sum to 32.
  const Moments m = moments({2, 4, 4, 4, 5, 5, 7, 9});
  EXPECT_DOUBLE_EQ(m.mean, 5.0);
  EXPECT_NEAR(m.deviation, 2.138089935, 1e-9);  // sqrt(32 / 7)
  EXPECT_EQ(moments({3.0}).mean, 3.0);
  EXPECT_EQ(moments({3.0}).deviation, 0.0);
  EXPECT_EQ(moments({}).mean, 0.0);
}

TEST(EvaluationStatistics, AQuantileIsOneOfTheValues) {
  std::vector<double> hundred;
  for (int i = 100; i >= 1; --i) hundred.push_back(i);
  EXPECT_EQ(quantile(hundred, 0.5), 50.0);
  EXPECT_EQ(quantile(hundred, 0.95), 95.0);
  EXPECT_EQ(quantile(hundred, 0.99), 99.0);
  EXPECT_EQ(quantile(hundred, 1.0), 100.0);
  EXPECT_EQ(quantile({3.0, 1.0, 2.0}, 0.5), 2.0);
  EXPECT_EQ(quantile({3.0, 1.0, 2.0}, 0.01), 1.0);
  EXPECT_EQ(quantile({}, 0.5), 0.0);
}

}  // namespace
}  // namespace tenon::sim
